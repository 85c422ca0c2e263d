#include "policies/knapsack/indexed_heap.h"

#include <vector>

#include "tests/catch.h"
#include "tests/policies/workloads.h"

using namespace framesim;
using namespace framesim::testing;

TEST_CASE("indexed heap: equal keys by item, either way") {
  for (const bool higher_first : {false, true}) {
    IndexedHeap heap(higher_first);
    heap.reset(5);
    for (const std::size_t item : {3, 1, 4, 0, 2}) heap.set(item, 1);
    for (std::size_t k = 0; k < 5; ++k) {
      CHECK(heap.top() == (higher_first ? 4 - k : k));
      heap.erase(heap.top());
    }
    CHECK(heap.empty());
    heap.erase(2);  // not in: nothing happens
    CHECK(heap.empty());
  }
}

// Against a plain array searched from front to back.
TEST_CASE("indexed heap: random insertions, changes and removals") {
  TestRandom random(5);
  IndexedHeap heap;
  heap.reset(50);
  std::vector<double> keys(50, -1);  // -1: not in
  for (int step = 0; step < 20000; ++step) {
    const auto item = static_cast<std::size_t>(random.whole(0, 49));
    if (random.chance(0.4)) {
      heap.erase(item);
      keys[item] = -1;
    } else {
      keys[item] = random.whole(0, 20);
      heap.set(item, keys[item]);
    }
    std::size_t best = 0;
    for (std::size_t i = 1; i < keys.size(); ++i) best = keys[i] > keys[best] ? i : best;
    CAPTURE(step);
    REQUIRE(heap.empty() == (keys[best] < 0));
    if (heap.empty()) continue;
    REQUIRE(heap.top() == best);
    REQUIRE(heap.key(best) == keys[best]);
  }
  CHECK(heap.moves() > 0);
}
