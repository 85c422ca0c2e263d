// framesim fit: constants that are known come back, and what cannot be known is refused.
#include "experiments/fit/fit.h"

#include <fmt/format.h>

#include <cmath>
#include <random>

#include "scenes/registry.h"
#include "tests/experiments/program.h"
#include "tests/scenes/refusal.h"
#include "tests/seeds.h"

using namespace framesim;

namespace {

struct Known {
  double clear = 3e-5;  // not fitted: that of desktop2020, where the fits start
  double setup = 2e-4, submit = 5e-6, draw = 2e-6, polygon = 2e-8, vertex = 3e-8, pixel = 1e-9, swap = 1e-4, s = 0.25;
};

// Rows whose times follow the closed form with the constants above, each time off by a normal factor of deviation
// `noise`.
std::string rows(std::uint64_t seed, double noise, int count, bool proportional = false) {
  std::mt19937_64 random(seed);
  std::normal_distribution<double> normal(0, 1);
  const auto between = [&](double low, double high) {
    return std::floor(std::uniform_real_distribution<double>(low, high)(random));
  };
  const Known k;
  std::string text = "cpu_s,gpu_s,frame_s,commands,draws,polygons,vertices,pixels\n";
  for (int i = 0; i < count; ++i) {
    const double commands = between(50, 400), draws = commands, polygons = between(1e3, 1e5);
    const double vertices = proportional ? 3 * polygons : between(1e3, 2e5), pixels = between(1e5, 2e7);
    const auto vary = [&](double t) { return t * (1 + noise * normal(random)); };
    const double cpu = vary(k.setup + k.submit * commands);
    const double gpu = vary(
        std::max(k.draw * draws + k.polygon * polygons + k.vertex * vertices, k.clear + k.pixel * pixels) + k.swap);
    const double frame = vary(std::max(cpu, gpu) + k.s * std::min(cpu, gpu));
    text += fmt::format("{},{},{},{},{},{},{},{}\n", cpu, gpu, frame, commands, draws, polygons, vertices, pixels);
  }
  return text;
}

const std::vector<std::string> kFitted = {"frame_setup", "submit", "draw", "polygon",
                                          "vertex",      "pixel",  "swap", "overlap"};

double truth(const std::string& name) {
  const Known k;
  if (name == "frame_setup") return k.setup;
  if (name == "submit") return k.submit;
  if (name == "draw") return k.draw;
  if (name == "polygon") return k.polygon;
  if (name == "vertex") return k.vertex;
  if (name == "pixel") return k.pixel;
  return name == "swap" ? k.swap : k.s;
}

FitRequest request(std::vector<std::string> constants = kFitted) {
  return {.machine = load_machine(parse_spec("desktop2020")), .constants = std::move(constants)};
}

MachineFit fit_text(const std::string& text, std::vector<std::string> constants = kFitted) {
  const TestFolder folder;
  return fit_frames(request(std::move(constants)), read_frame_rows(folder.write("rows.csv", text), 1));
}

}  // namespace

TEST_CASE("fit finds the constants again where rows carry no noise") {
  for (const FittedConstant& constant : fit_text(rows(1, 0, 60)).constants) {
    CAPTURE(constant.name, constant.value);
    CHECK(constant.value == Approx(truth(constant.name)).epsilon(1e-8));
  }
}

// 95 % of intervals hold the truth. With 8 constants and 40 seeds 320 intervals, not all independent: 0.95 +- 0.05 is
// four
// deviations of 320 independent ones (1.2 % each).
TEST_CASE("fit: the 95 % intervals hold the true constants in about 95 of 100 cases") {
  const std::uint64_t count = seeds(40);
  int held = 0, all = 0;
  for (std::uint64_t seed = 1; seed <= count; ++seed) {
    CAPTURE(seed);
    for (const FittedConstant& constant : fit_text(rows(seed, 0.02, 60)).constants) {
      held += std::abs(constant.value - truth(constant.name)) <= constant.half_width;
      ++all;
    }
  }
  const double share = static_cast<double>(held) / all;
  CAPTURE(share);
  CHECK(share > (count < 40 ? 0.80 : 0.90));
}

// Three vertices a polygon in each row: only polygon + 3 vertex is known.
TEST_CASE("fit names the two constants whose columns are proportional") {
  const std::string message = refusal([] { fit_text(rows(3, 0.01, 60, true)); });
  CAPTURE(message);
  CHECK(message.find("'polygon' and 'vertex' apart") != std::string::npos);
}

TEST_CASE("fit refuses bad rows at their line, and too few of them") {
  CHECK(refusal([] { fit_text("gpu_s,polygons\n0.1,5\n0.2,many\n"); }).find("rows.csv:3:5") != std::string::npos);
  CHECK(refusal([] { fit_text("gpu_s,polygons\n0.1,5\n0,6\n"); }).find("rows.csv:3:1") != std::string::npos);
  CHECK(refusal([] { fit_text("gpu_s,polygens\n0.1,5\n"); }).find("did you mean 'polygons'") != std::string::npos);
  CHECK(refusal([] { fit_text("gpu_s,polygons\n0.1,5\n", {"polygon"}); }).find("at least 2") != std::string::npos);
}

// T = max + s*min with s = 1/2: 10 + 2 = 12, 8 + 3 = 11, 20 + 5 = 25 ms.
// What each draw covers is not in rows of frames.
TEST_CASE("fit finds an area exponent from runs only, and starts no fit to frames from a machine with one") {
  const std::string text = rows(6, 0.01, 60);
  CHECK(refusal([&] {
          fit_text(text, {"polygon", "area_exponent"});
        }).find("'area_exponent' needs rows of runs") != std::string::npos);
  const TestFolder folder;
  const FrameRows read = read_frame_rows(folder.write("rows.csv", text), 1);
  FitRequest from = request({"polygon"});
  from.machine = load_machine(parse_spec("graphicon2005-fitted"));
  CHECK(refusal([&] { fit_frames(from, read); }).find("'graphicon2005-fitted' has an area_exponent") !=
        std::string::npos);
  from.constants = {"overlap"};  // of measured CPU and GPU times: what the GPU does with its polygons is not asked
  CHECK(refusal([&] { fit_frames(from, read); }).empty());
}

TEST_CASE("fit takes the overlap from a capture's columns and passes the others over") {
  const MachineFit fit =
      fit_text("Application,CPUBusy,GPUBusy,FrameTime\na.exe,4,10,12\na.exe,8,6,11\na.exe,20,10,25\n", {});
  REQUIRE(fit.constants.size() == 1);
  CHECK(fit.constants[0].name == "overlap");
  CHECK(fit.constants[0].value == Approx(0.5).epsilon(1e-9));
}

TEST_CASE("fit takes the dominant swap chain of a capture, and refuses one that has no GPU busy") {
  // The rows of b.exe would give s = 0; the frame without a GPU time is left out.
  const MachineFit fit = fit_text(
      "Application,SwapChainAddress,CPUBusy,GPUBusy,FrameTime\na.exe,0x1,4,10,12\nb.exe,0x2,4,10,10\n"
      "a.exe,0x1,8,6,11\na.exe,0x1,8,NA,30\na.exe,0x1,20,10,25\n",
      {});
  CHECK(fit.constants[0].value == Approx(0.5).epsilon(1e-9));
  CHECK(refusal([] { fit_text("Application,CPUBusy,FrameTime\na.exe,4,12\n"); }).find("no column of GPU busy") !=
        std::string::npos);
}

TEST_CASE("a fitted profile written to a file loads with the same numbers") {
  const MachineFit fit = fit_text(rows(4, 0.02, 60));
  const TestFolder folder;
  const MachineProfile read = load_machine(parse_spec(folder.write("m.toml", fit_toml(fit))));
  for (std::size_t c = 0; c < constant_infos().size(); ++c) {
    CAPTURE(constant_infos()[c].name);
    CHECK(constant_of(read, c) == constant_of(fit.machine, c));
  }
  CHECK(read.primitive_fifo == fit.machine.primitive_fifo);
}

// The simulator itself measures two runs with a known polygon cost; the fit starts from half of it.
TEST_CASE("fit through the simulator finds the polygon cost of the machine that made the runs") {
  FitRequest from = request({"polygon"});
  from.machine = load_machine(parse_spec("street"));
  const double known = constant_of(from.machine, find_constant("polygon"));
  set_constant(from.machine, find_constant("polygon"), known / 2);
  std::vector<MeasuredRun> runs;
  for (const char* policy : {"full-detail", "static"}) {
    MeasuredRun row{.spec = {.scene = parse_spec("street"), .policy = parse_spec(policy)}, .mean_s = {}, .avg_err = {}};
    row.spec.target_s = 0.025;
    row.spec.frames = 6;
    row.mean_s = run(row.spec, load_scene(row.spec.scene)).summary.mean_s;
    runs.push_back(row);
  }
  const MachineFit fit = fit_runs(from, runs, "test", 1, true);
  CHECK(fit.constants[0].value == Approx(known).epsilon(1e-4));
  CHECK(fit_runs(from, runs, "test", 2, true).constants[0].value == fit.constants[0].value);
}

// Trees that are complete in the one and drawn in part in the other. A start of 0 has no size to step by.
TEST_CASE("fit through the simulator finds the area exponent of the machine that made the runs") {
  FitRequest from = request({"area_exponent"});
  from.machine = load_machine(parse_spec("graphicon2005-fitted"));
  const std::size_t exponent = find_constant("area_exponent");
  const double known = constant_of(from.machine, exponent);
  set_constant(from.machine, exponent, known / 2);
  std::vector<MeasuredRun> runs;
  for (const double target_s : {0.025, 1.0}) {
    MeasuredRun row{.spec = {.scene = parse_spec("graphicon-forest:trees=100"),
                             .policy = parse_spec("robin-hood:levels=false"),
                             .machine = parse_spec("graphicon2005-fitted"),
                             .target_s = target_s},
                    .mean_s = {},
                    .avg_err = {}};
    row.spec.frames = 6;
    row.mean_s = run(row.spec, load_scene(row.spec.scene)).summary.mean_s;
    runs.push_back(row);
  }
  CHECK(fit_runs(from, runs, "test", 1, true).constants[0].value == Approx(known).epsilon(1e-4));
  set_constant(from.machine, exponent, 0);
  CHECK(refusal([&] { fit_runs(from, runs, "test", 1, true); }).find("'area_exponent' is 0") != std::string::npos);
}

TEST_CASE("fit on the command line writes a profile, prints intervals, and refuses with the right exit code") {
  const TestFolder folder;
  const std::string file = folder.write("rows.csv", rows(5, 0.02, 60));
  const std::string names = "frame_setup,submit,draw,polygon,vertex,pixel,swap,overlap";
  const ProgramRun good = run_program({"fit", "desktop2020", "--from", file, "--constants", names, "--output",
                                       folder.path("m.toml"), "--format", "csv"});
  CAPTURE(good.out, good.err);
  CHECK(good.exit_code == 0);
  CHECK(good.out.rfind("constant,value,low,high,before,at_bound\nframe_setup,", 0) == 0);
  CHECK(folder.read("m.toml").find("overlap = \"max-plus-s:") != std::string::npos);
  CHECK(run_program({"fit", "desktop2020", "--from", file, "--constants", "polygn"}).exit_code == 2);
  CHECK(run_program({"fit", "desktop2020", "--from", folder.path("none.csv")}).exit_code == 3);
}
