#include "sim/benchmark.h"

#include "tests/catch.h"
#include "tests/sim/estimators/fixtures.h"

using namespace framesim;
using namespace framesim::testing;

TEST_CASE("a draw that is bound by primitives measures the per-primitive time") {
  const Machine machine(test_profile());
  // gouraud, a = 2: 1 draw 4 us + 100 polygons 6 us = 10 us; 100 pixels take 0.8 us
  CHECK(measure_draw_s(machine, {.polygons = 100}, 100) == Approx(10e-6).epsilon(1e-7));
}

TEST_CASE("a draw that is bound by pixels measures the per-pixel time") {
  const Machine machine(test_profile());
  // gouraud, a = 2: 100,000 pixels of 8 ns = 800 us; primitives take 10 us
  CHECK(measure_draw_s(machine, {.polygons = 100}, 100'000) == Approx(800e-6).epsilon(1e-8));
}

TEST_CASE("the number of draws does not change the measured time, filling the pipeline does not count") {
  const Machine machine(test_profile());
  const Facts facts{.polygons = 100};
  for (const int draws : {1, 2, 7, 64, 500}) {
    CAPTURE(draws);
    CHECK(measure_draw_s(machine, facts, 1000, draws) == Approx(10e-6).epsilon(1e-9));
  }
}

TEST_CASE("FIFOs of one place measure the same as deep ones") {
  MachineProfile shallow = test_profile();
  shallow.primitive_fifo = 1;
  shallow.pixel_fifo = 1;
  const Facts facts{.polygons = 100};
  CHECK(measure_draw_s(Machine(shallow), facts, 5000) == measure_draw_s(Machine(test_profile()), facts, 5000));
}

TEST_CASE("the overlap of CPU and GPU does not change what the benchmark measures") {
  MachineProfile serial = test_profile();
  serial.overlap = {.kind = OverlapKind::serial, .serial_share = 1};
  const Facts facts{.polygons = 100};
  CHECK(measure_draw_s(Machine(serial), facts, 5000) == measure_draw_s(Machine(test_profile()), facts, 5000));
}

TEST_CASE("an empty frame takes the time of the clear") {
  CHECK(measure_empty_frame_s(Machine(test_profile())) == Approx(5e-4).epsilon(1e-9));
}

TEST_CASE("no draws at all cannot be measured") {
  CHECK_THROWS_AS(measure_draw_s(Machine(test_profile()), {}, 0, 0), InternalError);
}

TEST_CASE("logic time is base, visible items and the longest path of tasks") {
  // ai (3 ms) then crowd (1 ms) beside physics (2 ms): the longest path is 4 ms; 1 ms base + 100 items of 2 us = 1.2 ms
  const LogicLoad load{.base_s = 1e-3,
                       .per_item_s = 2e-6,
                       .tasks = {{.name = "ai", .time_s = 3e-3, .after = {}, .where = {}},
                                 {.name = "crowd", .time_s = 1e-3, .after = {"ai"}, .where = {}},
                                 {.name = "physics", .time_s = 2e-3, .after = {}, .where = {}}}};
  CHECK(LogicBenchmark(load).measure_s(100) == Approx(5.2e-3).epsilon(1e-12));
  CHECK(LogicBenchmark(load).measure_s(0) == Approx(5e-3).epsilon(1e-12));
  CHECK_THROWS_AS(LogicBenchmark(load).measure_s(-1), InternalError);
}
