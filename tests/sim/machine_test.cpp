#include "sim/machine.h"

#include <limits>

#include "sim/policy.h"
#include "tests/catch.h"

using namespace framesim;

namespace {

MachineProfile round_numbers() {
  MachineProfile profile{.name = "round"};
  profile.algorithm[static_cast<std::size_t>(Algorithm::gouraud)] = {.draw_s = 1e-6,
                                                                     .polygon_s = 1e-7,
                                                                     .vertex_s = 1e-8,
                                                                     .texture_byte_s = 1e-9,
                                                                     .pixel_s = 1e-9,
                                                                     .pixel_nonlinearity = 0.5};
  profile.algorithm[static_cast<std::size_t>(Algorithm::lines)].polygon_s = 5e-8;
  profile.algorithm[static_cast<std::size_t>(Algorithm::points)].polygon_s = 2e-8;
  profile.submit_s = 2e-6;
  profile.submit_draw_s = 1e-6;
  profile.clear_s = 1e-5;
  return profile;
}

}  // namespace

TEST_CASE("stage times of one draw are the sums that MODEL section 3 states") {
  const Machine machine(round_numbers());
  const Facts facts{.polygons = 100, .vertices = 200, .texture_bytes = 1000, .lines = 10, .points = 50, .draws = 2};
  const auto times = machine.draw_time(facts, 1 << 20, 1, false);
  // 2 draws 2 us + 100 polygons 10 us + 200 vertices 2 us + 1000 bytes 1 us + 10 lines 0.5 us + 50 points 1 us
  CHECK(times.primitive_s == Approx(16.5e-6).epsilon(1e-12));
  // 2^20 pixels at 1 ns, and half as much again because k = 0.5 at the reference area
  CHECK(times.pixel_s == Approx(1.5 * 1048576e-9).epsilon(1e-12));
}

TEST_CASE("at half resolution primitives and pixels halve, draw calls do not") {
  const Machine machine(round_numbers());
  const Facts facts{.polygons = 100, .draws = 2};
  const auto times = machine.draw_time(facts, 1000, 0.5, false);
  CHECK(times.primitive_s == Approx(2e-6 + 5e-6).epsilon(1e-12));
  CHECK(times.pixel_s == Approx(500e-9 * (1 + 0.5 * 500 / 1048576)).epsilon(1e-12));
}

TEST_CASE("below the knee a group issues as many draw calls as it has primitives to show") {
  // 64 trees of 100 splats: at x = 1/200 there are 32 splats, so 32 trees; at x = 1/50 128 splats, so all 64.
  const Facts facts{.polygons = 6400, .draws = 64};
  CHECK(draws_issued(facts, 1.0 / 200, true) == 32);
  CHECK(draws_issued(facts, 1.0 / 50, true) == 64);
  CHECK(draws_issued(facts, 1.0 / 200, false) == 64);
}

TEST_CASE("a cost stated outright is the whole GPU time") {
  const Machine machine(round_numbers());
  const Facts facts{.polygons = 1e6, .stated_cost_s = 0.25};
  const auto times = machine.draw_time(facts, 1e6, 1, false);
  CHECK(times.primitive_s == 0.25);
  CHECK(times.pixel_s == 0);
}

TEST_CASE("a machine with a negative or missing number is refused by name") {
  MachineProfile profile = round_numbers();
  profile.submit_s = -1;
  CHECK_THROWS_WITH(Machine(profile), contains("machine round: submit is -1"));
  profile = round_numbers();
  profile.pixel_fifo = 0;
  CHECK_THROWS_AS(Machine(profile), InputError);
}

// A day has 86,400 s: the nonlinearity is no time, and its range is that of machine files.
TEST_CASE("a machine's nonlinearity in projected area may be 0 to a million") {
  MachineProfile profile = round_numbers();
  for (AlgorithmCosts& costs : profile.algorithm) costs.pixel_nonlinearity = 1e6;
  CHECK_NOTHROW(Machine(profile));
  for (const double wrong : {-1.0, 1.1e6, std::numeric_limits<double>::quiet_NaN()}) {
    profile.algorithm[0].pixel_nonlinearity = wrong;
    CHECK_THROWS_WITH(Machine(profile), contains("allowed is 0 to 1000000"));
  }
}

// Half of 2,000 pixels are covered, 1,000; to the power of e = 1/3 that is 10. Draw calls and texture do not grow.
TEST_CASE("a primitive takes longer by a power of what its draw covers, a draw call does not") {
  MachineProfile profile = round_numbers();
  for (AlgorithmCosts& costs : profile.algorithm) costs.area_exponent = 1.0 / 3;
  const Machine machine(profile);
  const Facts facts{
      .polygons = 100, .vertices = 200, .texture_bytes = 1000, .lines = 10, .points = 50, .draws = 2, .coverage = 0.5};
  // 2 draws 2 us + 1000 bytes 1 us, and 10 times (10 us polygons + 2 us vertices + 0.5 us lines + 1 us points)
  CHECK(machine.draw_time(facts, 2000, 1, false).primitive_s == Approx(3e-6 + 135e-6).epsilon(1e-12));
  // half of it: 500 pixels, so half of everything but the draws, and 500^(1/3) = 7.93700526 times
  CHECK(machine.draw_time(facts, 2000, 0.5, false).primitive_s ==
        Approx(2.5e-6 + 6.75e-6 * 7.9370052598).epsilon(1e-9));
  // what covers less than a pixel counts as one
  CHECK(machine.draw_time(facts, 0.1, 1, false).primitive_s == Approx(16.5e-6).epsilon(1e-12));
  CHECK(machine.draw_time(facts, 0, 1, false).primitive_s == machine.draw_time(facts, 2, 1, false).primitive_s);
}

TEST_CASE("without an exponent, or with nothing that grows, a draw has the bits of a machine without") {
  MachineProfile growing = round_numbers();
  for (AlgorithmCosts& costs : growing.algorithm) costs.area_exponent = 0.5;
  const Machine plain(round_numbers()), exponent(growing);
  const Facts facts{.polygons = 1e6, .stated_cost_s = 0.25}, texture{.texture_bytes = 777};
  for (const Facts& each : {facts, texture}) {
    CHECK(exponent.draw_time(each, 12345, 0.7, false).primitive_s ==
          plain.draw_time(each, 12345, 0.7, false).primitive_s);
    CHECK_FALSE(exponent.level_costs(each).primitives_depend_on_view());
  }
  CHECK_FALSE(plain.level_costs({.polygons = 5}).primitives_depend_on_view());
  CHECK(exponent.level_costs({.polygons = 5}).primitives_depend_on_view());
}

TEST_CASE("a machine's area exponent may be 0 to 1") {
  MachineProfile profile = round_numbers();
  profile.algorithm[0].area_exponent = 1;
  CHECK_NOTHROW(Machine(profile));
  for (const double wrong : {-0.1, 1.1, std::numeric_limits<double>::quiet_NaN()}) {
    profile.algorithm[0].area_exponent = wrong;
    CHECK_THROWS_WITH(Machine(profile), contains("area_exponent") && contains("allowed is 0 to 1"));
  }
}

TEST_CASE("overlap models are read and written in the same words") {
  for (const char* text : {"staged:1", "staged:4", "serial", "paper2005", "max-plus-s:0.25"}) {
    CHECK(to_string(parse_overlap(text)) == text);
  }
  CHECK(to_string(parse_overlap("staged")) == "staged:1");
  CHECK(parse_overlap("paper2005").serial_share == Approx(1.0 / 3));
  for (const char* text :
       {"", "staged:0", "staged:5", "staged:1.5", "max-plus-s", "max-plus-s:2", "max-plus-s:nan", "serial:1"}) {
    CAPTURE(text);
    CHECK_THROWS_AS(parse_overlap(text), InputError);
  }
}
