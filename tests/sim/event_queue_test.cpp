#include "sim/event_queue.h"

#include <algorithm>

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
