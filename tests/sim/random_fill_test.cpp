// Blocks in vector registers against the same blocks drawn one at a time by Random123.
#include <vector>

#include "sim/random_stream.h"
#include "tests/catch.h"
#include "tests/sim/each_target.h"

using namespace framesim;

TEST_CASE("blocks drawn together are the blocks drawn alone, whatever the registers", "[random]") {
  int targets = 0;
  test::for_each_target([&](const char* target) {
    CAPTURE(target);
    ++targets;
    for (const std::uint64_t seed : {std::uint64_t{0}, std::uint64_t{1}, ~std::uint64_t{0}}) {
      const RandomStream stream(seed, "fill");
      for (const std::uint64_t frame :
           {std::uint64_t{0}, std::uint64_t{7}, std::uint64_t{1} << 40, ~std::uint64_t{0}}) {
        for (const std::uint32_t first : {0u, 5u, 0xfffffff0u}) {  // the last: indices wrap
          for (const std::size_t count : {std::size_t{0}, std::size_t{1}, std::size_t{15}, std::size_t{16},
                                          std::size_t{17}, std::size_t{33}, std::size_t{128}}) {
            CAPTURE(seed, frame, first, count);
            std::vector<std::uint32_t> low(RandomStream::padded_words(count) + 1, 77), high = low;
            stream.fill(frame, first, 3, count, low.data(), high.data());
            for (std::size_t b = 0; b < count; ++b) {
              const auto block = stream.block(frame, first + static_cast<std::uint32_t>(b), 3);
              REQUIRE(low[2 * b] == block[0]);
              REQUIRE(low[2 * b + 1] == block[1]);
              REQUIRE(high[2 * b] == block[2]);
              REQUIRE(high[2 * b + 1] == block[3]);
            }
            REQUIRE(low.back() == 77);  // behind the promised room
            REQUIRE(high.back() == 77);
          }
        }
      }
    }
  });
  CHECK(targets >= 1);
}

TEST_CASE("the bits of a stream are the first half of its block", "[random]") {
  const RandomStream stream(5, "halves");
  for (std::uint32_t i = 0; i < 100; ++i) {
    const auto block = stream.block(9, i, 2);
    REQUIRE(stream.bits(9, i, 2) == (block[0] | std::uint64_t{block[1]} << 32));
  }
}
