// The fitted profiles hold what framesim fit finds: nobody typed the constants in.
#include <fmt/format.h>

#include <cmath>
#include <fstream>
#include <map>
#include <sstream>
#include <string>
#include <vector>

#include "experiments/csv_row.h"
#include "experiments/fit/fit.h"
#include "experiments/options.h"
#include "scenes/registry.h"
#include "tests/catch.h"
#include "tests/experiments/program.h"

using namespace framesim;

namespace {

std::string in_sources(const std::string& path) { return std::string(kSourceFolder) + "/" + path; }

// The words after "framesim" of the command in the profile's comment.
std::vector<std::string> recorded_command(const std::string& machine) {
  std::ifstream in(in_sources("scenes/data/machines/" + machine + ".toml"));
  const std::string prefix = "#   framesim ";
  for (std::string line; std::getline(in, line);) {
    if (!line.starts_with(prefix)) continue;
    std::istringstream words(line.substr(prefix.size()));
    std::vector<std::string> command;
    for (std::string word; words >> word;) command.push_back(word);
    return command;
  }
  return {};
}

std::string after(const std::vector<std::string>& words, const std::string& option) {
  for (std::size_t i = 0; i + 1 < words.size(); ++i) {
    if (words[i] == option) return words[i + 1];
  }
  return {};
}

// Five digits are in the profile: half a unit of the fifth is at most 5e-5 of the value.
constexpr double kPrinted = 5.1e-5;

void check_fitted(const std::string& device) {
  const std::string name = device + "-fitted";
  const std::vector<std::string> command = recorded_command(name);
  REQUIRE(command.size() >= 6);
  REQUIRE(command[0] == "fit");
  CHECK(command[1] == device);
  const FitRequest request{.machine = load_machine(parse_spec(command[1])),
                           .constants = split_list({after(command, "--constants")}, {"test"})};
  const auto runs = read_measured_runs(in_sources(after(command, "--from")), read_shared({}, {"test"}));
  const MachineFit fit = fit_runs(request, runs, "test", 2, true);
  const MachineProfile kept = load_machine(parse_spec(name));
  REQUIRE(fit.constants.size() == 3);
  for (const FittedConstant& constant : fit.constants) {
    CAPTURE(device, constant.name);
    CHECK(constant_of(kept, find_constant(constant.name)) == Approx(constant.value).epsilon(kPrinted));
    CHECK(constant.value != constant.before);
  }
}

// The mean square of what the fit makes small, for `machine` with one constant `factor` times as large.
double squares(MachineProfile machine, const std::string& constant, double factor) {
  const std::size_t c = find_constant(constant);
  set_constant(machine, c, constant_of(machine, c) * factor);
  double sum = 0;
  for (const MeasuredRun& measured :
       read_measured_runs(in_sources("experiments/reproduce/fit/robin-hood-linear.csv"), read_shared({}, {"test"}))) {
    const auto scene = std::make_shared<Scene>(load_scene(measured.spec.scene));
    scene->machine = machine;
    RunSpec spec = measured.spec;
    spec.machine.reset();
    const Summary summary = run(spec, *scene).summary;
    sum += std::pow(summary.mean_s / *measured.mean_s - 1, 2) + std::pow(summary.avg_err - *measured.avg_err, 2);
  }
  return sum;
}

}  // namespace

// Each takes a second; the sanitizers have time for one.
TEST_CASE("reproduce: the fit that a profile names finds its constants again, to the digits printed there") {
  check_fitted("ipad");
#if !defined(__SANITIZE_ADDRESS__)
  for (const char* device : {"iphone", "computer1", "computer2"}) check_fitted(device);
#endif
}

// The whole fit of Robin Hood's machine takes a minute. What it found must at least be where no step of 4 % of any of
// its constants fits the linear rows better: a constant moved by hand would show.
#if !defined(__SANITIZE_ADDRESS__)
TEST_CASE("reproduce: no neighbour of Robin Hood's fitted machine fits its linear rows better") {
  const MachineProfile fitted = load_machine(parse_spec("graphicon2005-fitted"));
  const std::vector<std::string> command = recorded_command("graphicon2005-fitted");
  REQUIRE(after(command, "--from") == "experiments/reproduce/fit/robin-hood-linear.csv");
  const double least = squares(fitted, "draw", 1);
  for (const std::string& constant : split_list({after(command, "--constants")}, {"test"})) {
    for (const double factor : {0.96, 1.04}) {
      CAPTURE(constant, factor);
      CHECK(squares(fitted, constant, factor) > least);
    }
  }
}
#endif
