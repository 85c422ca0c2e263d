#include "sim/event_queue.h"

#include <algorithm>
#include <array>
#include <limits>
#include <set>

#include "sim/check.h"
#include "tests/catch.h"
#include "tests/sim/random_pipeline.h"

using namespace framesim;
using framesim::test::SplitMix;

TEST_CASE("events are taken by time, then phase, then in the order scheduled") {
  EventQueue queue;
  queue.schedule(SimTime(5), Phase::frame_start, 0);
  queue.schedule(SimTime(5), Phase::submit_done, 1);
  queue.schedule(SimTime(3), Phase::frame_start, 2);
  queue.schedule(SimTime(5), Phase::pixel_done, 3);
  queue.schedule(SimTime(5), Phase::submit_done, 4);
  queue.schedule(SimTime(5), Phase::frame_shown, 5);
  queue.schedule(SimTime(5), Phase::primitive_done, 6);
  // Time 3 first; at 5 the phases as declared: pixel, primitive, submit (1 before 4), shown, start.
  for (const std::uint64_t expected : {2u, 3u, 6u, 1u, 4u, 5u, 0u}) CHECK(queue.take().payload == expected);
  CHECK(queue.empty());
  CHECK(queue.taken() == 7);
  CHECK(queue.now() == SimTime(5));
}

TEST_CASE("an event in the past and taking from an empty queue are refused") {
  EventQueue queue;
  CHECK_THROWS_AS(queue.take(), InternalError);
  queue.schedule(SimTime(10), Phase::pixel_done, 0);
  queue.schedule(SimTime(4), Phase::pixel_done, 0);
  queue.take();
  CHECK_THROWS_AS(queue.schedule(SimTime(3), Phase::pixel_done, 0), InternalError);
  CHECK_NOTHROW(queue.schedule(SimTime(4), Phase::pixel_done, 7));  // now is not the past
  CHECK(queue.take().payload == 7);
}

TEST_CASE("a copy is a checkpoint with its own clock") {
  EventQueue queue;
  queue.schedule(SimTime(1), Phase::submit_done, 1);
  queue.schedule(SimTime(9), Phase::submit_done, 9);
  queue.take();
  EventQueue checkpoint = queue;
  CHECK(queue.take().payload == 9);
  CHECK_THROWS_AS(queue.schedule(SimTime(5), Phase::submit_done, 5), InternalError);
  queue = checkpoint;  // the clock goes back to 1
  CHECK(queue.now() == SimTime(1));
  queue.schedule(SimTime(5), Phase::submit_done, 5);
  CHECK(queue.take().payload == 5);
  CHECK(queue.take().payload == 9);
  CHECK(checkpoint.size() == 1);
}

// Reference: scan all pending events for the smallest (time, phase, order of scheduling).
TEST_CASE("random schedules come out as a scan for the smallest would take them") {
  for (std::uint64_t seed = 0; seed < 200; ++seed) {
    CAPTURE(seed);
    SplitMix random(seed);
    EventQueue queue;
    std::vector<std::array<std::int64_t, 3>> pending;  // time, phase, order
    for (std::int64_t order = 0; order < 100;) {
      if (pending.empty() || random.chance(60)) {
        const std::int64_t time = queue.now().count() + random.between(0, 4), phase = random.between(0, 4);
        queue.schedule(SimTime(time), static_cast<Phase>(phase), static_cast<std::uint64_t>(order));
        pending.push_back({time, phase, order++});
      } else {
        const auto expected = std::min_element(pending.begin(), pending.end());
        const Event event = queue.take();
        REQUIRE(event.time.count() == (*expected)[0]);
        REQUIRE(event.payload == static_cast<std::uint64_t>((*expected)[2]));
        pending.erase(expected);
      }
    }
    CHECK(queue.size() == pending.size());
  }
}

// Reference: an ordered set of (time, phase, sequence). Long runs of one kind: the queue grows to hundreds, is emptied and
// grows again, and a copy is taken now and then right after an event was.
TEST_CASE("long runs of schedules and of takes, down to empty and from copies, keep the order") {
  std::size_t most = 0, emptied = 0, copies = 0;
  for (std::uint64_t seed = 0; seed < 30; ++seed) {
    CAPTURE(seed);
    SplitMix random(seed);
    EventQueue queue;
    std::set<std::array<std::int64_t, 3>> pending;
    std::int64_t sequence = 0;
    for (int run = 0; run < 20; ++run) {
      for (std::int64_t i = random.between(0, 200); i > 0; --i) {
        const std::int64_t time = queue.now().count() + random.between(0, 100), phase = random.between(0, 4);
        queue.schedule(SimTime(time), static_cast<Phase>(phase), static_cast<std::uint64_t>(7 * sequence));
        pending.insert({time, phase, sequence++});
      }
      most = std::max(most, pending.size());
      for (std::int64_t i = random.between(0, 300); i > 0 && !pending.empty(); --i) {
        const std::array<std::int64_t, 3> expected = *pending.begin();
        pending.erase(pending.begin());
        const Event event = queue.take();
        REQUIRE(event.time.count() == expected[0]);
        REQUIRE(static_cast<std::int64_t>(event.phase) == expected[1]);
        REQUIRE(static_cast<std::int64_t>(event.sequence) == expected[2]);
        REQUIRE(static_cast<std::int64_t>(event.payload) == 7 * expected[2]);
        REQUIRE(queue.size() == pending.size());
        if (random.chance(5)) {
          queue = EventQueue(queue);
          ++copies;
        }
      }
      emptied += pending.empty();
    }
  }
  // The cases that the test is about must have occurred.
  CHECK(most > 250);
  CHECK(emptied > 30);
  CHECK(copies > 100);
}

// Times up to the end of the clock keep their order: the key holds all 63 bits.
TEST_CASE("events at the ends of the clock come out in order") {
  EventQueue queue;
  constexpr std::int64_t kLast = std::numeric_limits<std::int64_t>::max();
  for (const std::int64_t time : {kLast, std::int64_t{0}, kLast - 1, std::int64_t{1} << 32, std::int64_t{1}}) {
    queue.schedule(SimTime(time), Phase::frame_start, 0);
  }
  for (const std::int64_t time : {std::int64_t{0}, std::int64_t{1}, std::int64_t{1} << 32, kLast - 1, kLast}) {
    CHECK(queue.take().time.count() == time);
  }
}
