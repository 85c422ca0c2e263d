#include "sim/effects/residency.h"

#include <algorithm>
#include <vector>

#include "sim/check.h"
#include "tests/catch.h"
#include "tests/sim/random_pipeline.h"

using namespace framesim;
using framesim::test::SplitMix;

namespace {

Residency memory_of(std::int64_t bytes, std::uint32_t keys = 8) {
  Residency memory;
  memory.reset(keys, bytes);
  return memory;
}

// Keys that are resident, ascending.
std::vector<std::uint32_t> contents(const Residency& memory, std::uint32_t keys = 8) {
  std::vector<std::uint32_t> resident;
  for (std::uint32_t key = 0; key < keys; ++key) {
    if (memory.resident(key)) resident.push_back(key);
  }
  return resident;
}
using Keys = std::vector<std::uint32_t>;

// The same rules on a plain list, oldest first, searched from end to end.
struct SimpleMemory {
  struct Entry {
    std::uint32_t key;
    std::int64_t bytes;
  };
  std::int64_t capacity = 0;
  std::vector<Entry> entries;

  std::int64_t used() const {
    std::int64_t sum = 0;
    for (const Entry& entry : entries) sum += entry.bytes;
    return sum;
  }
  std::int64_t use(std::uint32_t key, std::int64_t bytes) {
    const auto found = std::find_if(entries.begin(), entries.end(), [&](const Entry& e) { return e.key == key; });
    const bool hit = found != entries.end() && found->bytes == bytes;
    if (found != entries.end()) entries.erase(found);
    if (bytes == 0 || bytes > capacity) return bytes;
    while (used() + bytes > capacity) entries.erase(entries.begin());
    entries.push_back({key, bytes});
    return hit ? 0 : bytes;
  }
};

}  // namespace

// 30 bytes hold three resources of 10. 0, 1, 2 fill it; the use of 0 makes 1 the oldest, which 3 displaces; then 2 goes
// for 1.
TEST_CASE("a use refreshes, a miss evicts the least recently used") {
  Residency memory = memory_of(30);
  for (const std::uint32_t key : {0u, 1u, 2u}) CHECK(memory.use(key, 10) == 10);
  CHECK(memory.use(0, 10) == 0);
  CHECK(memory.use(3, 10) == 10);
  CHECK(contents(memory) == Keys{0, 2, 3});
  CHECK(memory.use(1, 10) == 10);
  CHECK(contents(memory) == Keys{0, 1, 3});
  CHECK(memory.used_bytes() == 30);
}

// 5 + 10 + 15 = 30 of 32 bytes. A resource of 14 needs 12 more than the 2 that are free: 5 is not enough, 5 + 10 are.
TEST_CASE("as many are evicted as it takes, oldest first, and no more") {
  Residency memory = memory_of(32);
  memory.use(0, 5);
  memory.use(1, 10);
  memory.use(2, 15);
  CHECK(memory.use(3, 14) == 14);
  CHECK(contents(memory) == Keys{2, 3});
  CHECK(memory.used_bytes() == 29);
}

TEST_CASE("what is larger than the memory passes through at each use and displaces nothing") {
  Residency memory = memory_of(30);
  memory.use(0, 30);
  for (int i = 0; i < 3; ++i) CHECK(memory.use(1, 31) == 31);
  CHECK(contents(memory) == Keys{0});
  CHECK(memory.use(0, 30) == 0);
  Residency none = memory_of(0);
  CHECK(none.use(0, 1) == 1);
  CHECK(none.use(0, 1) == 1);
}

// 0 grows from 10 to 20 beside 1 (10 of 30): it fits. At 25 it does not, and 1 goes. At 31 it has no place any more
// itself.
TEST_CASE("a resource of another size is another content") {
  Residency memory = memory_of(30);
  memory.use(0, 10);
  memory.use(1, 10);
  CHECK(memory.use(0, 20) == 20);
  CHECK(memory.use(0, 20) == 0);
  CHECK(contents(memory) == Keys{0, 1});
  CHECK(memory.use(0, 25) == 25);
  CHECK(contents(memory) == Keys{0});
  CHECK(memory.use(0, 31) == 31);
  CHECK(contents(memory).empty());
  CHECK(memory.used_bytes() == 0);
}

TEST_CASE("what has no bytes needs no memory") {
  Residency memory = memory_of(0);
  CHECK(memory.use(0, 0) == 0);
  CHECK(memory.load(1, 0));
  CHECK(contents(memory).empty());
  Residency some = memory_of(10);
  some.use(0, 10);
  CHECK(some.use(0, 0) == 0);  // it has shrunk to nothing
  CHECK(some.used_bytes() == 0);
}

TEST_CASE("loading fills free places only") {
  Residency memory = memory_of(30);
  CHECK(memory.load(0, 20));
  CHECK_FALSE(memory.load(1, 11));
  CHECK(memory.load(2, 10));
  CHECK(contents(memory) == Keys{0, 2});
  CHECK(memory.use(3, 5) == 5);  // 0 was loaded first and is the oldest
  CHECK(contents(memory) == Keys{2, 3});
}

TEST_CASE("reset empties the memory") {
  Residency memory = memory_of(30);
  memory.use(0, 10);
  memory.reset(8, 10);
  CHECK(contents(memory).empty());
  CHECK(memory.use(0, 10) == 10);
  CHECK(memory.use(1, 10) == 10);
  CHECK(contents(memory) == Keys{1});
}

TEST_CASE("keys and sizes that are none are refused") {
  Residency memory = memory_of(30, 4);
  CHECK_THROWS_AS(memory.use(4, 1), InternalError);
  CHECK_THROWS_AS(memory.use(0, -1), InternalError);
  CHECK_THROWS_AS(memory.load(4, 1), InternalError);
  CHECK_THROWS_AS(memory_of(-1), InternalError);
}

TEST_CASE("on random uses the intrusive list does what a plain list does") {
  std::int64_t hits = 0, misses = 0;
  for (std::uint64_t seed = 0; seed < 300; ++seed) {
    CAPTURE(seed);
    SplitMix random(seed);
    const auto keys = static_cast<std::uint32_t>(random.between(1, 20));
    SimpleMemory simple{.capacity = random.between(0, 200), .entries = {}};
    Residency memory = memory_of(simple.capacity, keys);
    std::vector<std::int64_t> sizes;
    for (std::uint32_t key = 0; key < keys; ++key) sizes.push_back(random.between(0, 60));
    for (int i = 0; i < 300; ++i) {
      const auto key = static_cast<std::uint32_t>(random.between(0, keys - 1));
      if (random.chance(5)) sizes[key] = random.between(0, 60);
      const std::int64_t moved = memory.use(key, sizes[key]);
      REQUIRE(moved == simple.use(key, sizes[key]));
      REQUIRE(memory.used_bytes() == simple.used());
      (moved > 0 ? misses : hits) += sizes[key] > 0;
    }
    for (std::uint32_t key = 0; key < keys; ++key) {
      const bool there =
          std::any_of(simple.entries.begin(), simple.entries.end(), [&](const auto& e) { return e.key == key; });
      REQUIRE(memory.resident(key) == there);
    }
  }
  CHECK(hits > 1000);
  CHECK(misses > 1000);
}

// With resources of one size the memory holds the n used last, so that a larger memory holds all that a smaller one
// does (the stack property; Mattson, Gecsei, Slutz, Traiger 1970): each hit stays a hit. It does not hold for sizes
// that differ.
TEST_CASE("with resources of one size a larger memory uploads nothing that a smaller one does not") {
  for (std::uint64_t seed = 0; seed < 100; ++seed) {
    SplitMix random(seed);
    std::vector<Residency> memories;
    for (std::int64_t places = 0; places <= 12; ++places) memories.push_back(memory_of(7 * places, 12));
    std::vector<std::int64_t> uploads(memories.size(), 0);
    for (int i = 0; i < 400; ++i) {
      const auto key = static_cast<std::uint32_t>(random.between(0, random.chance(50) ? 3 : 11));
      for (std::size_t m = 0, moved_before = 1; m < memories.size(); ++m) {
        const auto moved = static_cast<std::size_t>(memories[m].use(key, 7) > 0);
        CAPTURE(seed, i, m);
        REQUIRE(moved <= moved_before);
        moved_before = moved;
        uploads[m] += static_cast<std::int64_t>(moved);
      }
    }
    CHECK(uploads.front() == 400);
    CHECK(uploads.back() == 12);  // each once: all twelve fit
    CHECK(std::is_sorted(uploads.rbegin(), uploads.rend()));
  }
}
