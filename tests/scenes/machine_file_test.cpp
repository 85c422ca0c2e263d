#include "scenes/machine_file.h"

#include <string>

#include "scenes/registry.h"
#include "tests/catch.h"
#include "tests/scenes/refusal.h"
#include "tests/scenes/temp_folder.h"

using namespace framesim;

namespace {

// Line 1 to 3, then the lines given.
std::string machine(const std::string& lines) { return "framesim = 1\n[machine]\nname = \"m\"\n" + lines; }

std::string refused(const std::string& text) {
  return refusal([&] { parse_machine(text, "m.toml"); });
}

const AlgorithmCosts& costs(const MachineProfile& profile, Algorithm algorithm) {
  return profile.algorithm[static_cast<std::size_t>(algorithm)];
}

}  // namespace

TEST_CASE("a whole machine profile is read", "[machine_file]") {
  const MachineProfile m = parse_machine(machine("source = \"s\"\nsubmit = \"2us\"\nsubmit_draw = \"1us\"\n"
                                                 "frame_setup = \"0.1ms\"\nclear = \"0.05ms\"\nswap = \"3ms\"\n"
                                                 "visibility_test = \"50ns\"\noperation = \"20ns\"\n"
                                                 "primitive_fifo = 8\npixel_fifo = 4\noverlap = \"staged:2\"\n"
                                                 "[machine.algorithm.flat]\npolygon = \"7us\"\n"
                                                 "[machine.algorithm.default]\ndraw = \"1us\"\npolygon = \"100ns\"\n"
                                                 "vertex = \"50ns\"\npixel = \"1ns\"\ntexture_byte = \"0.5ns\"\n"
                                                 "pixel_nonlinearity = 0.25\narea_exponent = 0.04\n"),
                                         "m.toml");
  CHECK(m.name == "m");
  CHECK(m.source == "s");
  CHECK(m.submit_s == 2e-6);
  CHECK(m.submit_draw_s == 1e-6);
  CHECK(m.frame_setup_s == 1e-4);
  CHECK(m.clear_s == 5e-5);
  CHECK(m.swap_s == 3e-3);
  CHECK(m.visibility_test_s == 50e-9);
  CHECK(m.operation_s == 20e-9);
  CHECK(m.primitive_fifo == 8);
  CHECK(m.pixel_fifo == 4);
  CHECK(m.overlap.kind == OverlapKind::staged);
  CHECK(m.overlap.frames_in_flight == 2);
  CHECK(costs(m, Algorithm::flat).polygon_s == 7e-6);
  CHECK(costs(m, Algorithm::flat).area_exponent == 0);
  CHECK(costs(m, Algorithm::flat).draw_s == 0);  // the default is for algorithms that are not listed at all
  for (const Algorithm a :
       {Algorithm::gouraud, Algorithm::textured, Algorithm::lines, Algorithm::points, Algorithm::splats}) {
    CHECK(costs(m, a).draw_s == 1e-6);
    CHECK(costs(m, a).polygon_s == 100e-9);
    CHECK(costs(m, a).vertex_s == 50e-9);
    CHECK(costs(m, a).pixel_s == 1e-9);
    CHECK(costs(m, a).texture_byte_s == 0.5e-9);
    CHECK(costs(m, a).pixel_nonlinearity == 0.25);
    CHECK(costs(m, a).area_exponent == 0.04);
  }
}

TEST_CASE("a machine file is refused at file, line and column", "[machine_file]") {
  const std::string rest = "source = \"s\"\n[machine.algorithm.default]\npolygon = \"1us\"\n";
  struct Case {
    std::string text, where, words;
  };
  const Case cases[] = {
      {"framesim = 2\n[machine]\n", "m.toml:1:12", "found 2; allowed: a whole number from 1 to 1"},
      {"framesim = 1\n", "m.toml:1:1", "no table [machine]"},
      {"framesim = 1\nmachine = 3\n", "m.toml:2:11", "found 3"},
      {"framesim = 1\n[screen]\n", "m.toml:2:2", "unknown key 'screen'"},
      {machine("sourc = \"s\"\n"), "m.toml:4:1", "did you mean 'source'?"},
      {machine(""), "m.toml:2:1", "has no 'source'"},
      {machine("source = \"s\"\n"), "m.toml:2:1", "[machine.algorithm.NAME]"},
      {machine("submit = 3\n" + rest), "m.toml:4:10", "'3' has no unit"},
      {machine("submit = \"3m\"\n" + rest), "m.toml:4:10", "unknown unit 'm'"},
      {machine("submit = \"-3us\"\n" + rest), "m.toml:4:10", "negative duration"},
      {machine("submit = nan\n" + rest), "m.toml:4:10", "nan"},
      {machine("submit = \"2days\"\n" + rest), "m.toml:4:10", "unknown unit"},
      {machine("submit = \"90000s\"\n" + rest), "m.toml:4:10", "from 0s to 86400s"},
      {machine("primitive_fifo = 0\n" + rest), "m.toml:4:18", "from 1 to 1000000"},
      {machine("pixel_fifo = 2.5\n" + rest), "m.toml:4:14", "found 2.5"},
      {machine("overlap = \"parallel\"\n" + rest), "m.toml:4:11", "'parallel' is no overlap model"},
      {machine(rest + "[machine.algorithm.phong]\npolygon = \"1us\"\n"), "m.toml:7:20", "unknown key 'phong'"},
      {machine(rest + "[machine.algorithm.flat]\npolygons = \"1us\"\n"), "m.toml:8:1", "did you mean 'polygon'?"},
      {machine(rest + "[machine.algorithm.flat]\npolygon = \"0us\"\n"), "m.toml:7:1", "no cost above 0"},
      {machine(rest + "pixel_nonlinearity = inf\n"), "m.toml:7:22", "found inf"},
      {machine(rest + "area_exponent = 1.5\n"), "m.toml:7:17", "from 0 to 1"},
      {machine("source = \"s\"\nalgorithm = 1\n"), "m.toml:5:13", "a table [algorithm]"},
      {machine("source = \"s\"\n[machine.algorithm]\nflat = 1\n"), "m.toml:6:8", "a table [flat]"},
  };
  for (const Case& c : cases) CHECK(says(refused(c.text), c.where, c.words));
}

TEST_CASE("every built-in machine loads under its own name", "[machine_file]") {
  REQUIRE(built_in_machines().size() == 9 + 5);  // as assumed, and fitted to published tables
  for (const BuiltIn& entry : built_in_machines()) {
    CAPTURE(entry.name);
    const MachineProfile m = load_machine({.name = std::string(entry.name), .settings = {}, .where = {"here"}});
    CHECK(m.name == entry.name);
    CHECK_FALSE(m.source.empty());
  }
}

TEST_CASE("Zach's printed constants are in the profile of his machine", "[machine_file]") {
  const MachineProfile m = load_machine({.name = "vrvis2002", .settings = {}, .where = {}});
  // Zach et al. 2002, section 5.3: 0.35 us a splat, 2.45 us a tree, 0.06 us a vertex.
  CHECK(costs(m, Algorithm::splats).polygon_s == 0.35e-6);
  CHECK(costs(m, Algorithm::splats).draw_s == 2.45e-6);
  CHECK(costs(m, Algorithm::gouraud).vertex_s == 0.06e-6);
}

TEST_CASE("an unknown machine is answered with the legal set", "[machine_file]") {
  const auto load = [](const std::string& name, Settings settings = {}) {
    return refusal([&] { load_machine({.name = name, .settings = settings, .where = {"command line"}}); });
  };
  CHECK(says(load("vgx321"), "command line", "unknown machine 'vgx321'; allowed: street, vgx320, graphicon2005"));
  CHECK(says(load("vgx321"), "command line", "did you mean 'vgx320'?"));
  CHECK(says(load("street", {{"submit", "1us", {"command line"}}}), "command line",
             "unknown parameter 'submit'; allowed: none"));
}

TEST_CASE("a machine can be a file", "[machine_file]") {
  const TempFolder folder;
  const std::string path =
      folder.write("fast.toml", machine("source = \"s\"\n[machine.algorithm.flat]\npolygon = \"1us\"\n"));
  CHECK(load_machine({.name = path, .settings = {}, .where = {}}).name == "m");
  const std::string missing = folder.path("none.toml");
  CHECK(says(refusal([&] { load_machine({.name = missing, .settings = {}, .where = {}}); }), missing + ":1",
             "no such file"));
}

TEST_CASE("an algorithm that the machine does not list is found for each way of using it", "[machine_file]") {
  MachineProfile m;
  m.name = "m";
  m.algorithm[static_cast<std::size_t>(Algorithm::gouraud)].polygon_s = 1e-6;
  Scene scene;
  scene.types.resize(1);
  scene.types[0].name = "oak";
  scene.view_levels.resize(1);
  Facts& facts = scene.types[0].levels.emplace_back();
  facts.polygons = 10;
  CHECK_FALSE(missing_costs(scene, m));
  const auto missing = [&] { return missing_costs(scene, m).value_or(""); };
  facts.algorithm = Algorithm::splats;
  CHECK(missing().find("'splats', which type 'oak' uses") != std::string::npos);
  facts.stated_cost_s = 1e-3;  // stated outright: no coefficients are asked
  CHECK(missing().empty());
  facts.stated_cost_s.reset();
  facts.algorithm = Algorithm::gouraud;
  facts.lines = 1;
  CHECK(missing().find("'lines'") != std::string::npos);
  facts.lines = 0;
  scene.view_levels[0].part = ViewPart::leaves;
  CHECK(missing().find("'points'") != std::string::npos);
  scene.view_levels[0].part = ViewPart::trunk;
  CHECK(missing().find("'lines'") != std::string::npos);
}
