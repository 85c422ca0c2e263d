// A short sweep file may ask for any number of runs: refused before they take memory.
#include <fmt/format.h>

#include "experiments/store/sweep_spec.h"
#include "tests/experiments/program.h"
#include "tests/scenes/refusal.h"

namespace framesim {
namespace {

// A [[vary]] with the values 0.001, 0.002, ...
std::string vary(const std::string& of, const std::string& name, const std::string& key, int count) {
  std::string text = fmt::format("[[vary]]\nof = \"{}\"\nname = \"{}\"\nkey = \"{}\"\nvalues = [", of, name, key);
  for (int i = 1; i <= count; ++i) text += fmt::format("{:.4f},", i / 10'000.0);
  return text + "]\n";
}

std::string refusal_of(const std::string& rest) {
  const TestFolder folder;
  const std::string path =
      folder.write("sweep.toml", "framesim = 1\nscenes = [\"street\"]\npolicies = [\"static\"]\n" + rest);
  return refusal([&] { read_sweep(path); });
}

}  // namespace

TEST_CASE("sweep: [[vary]] tables that multiply to more than a million are refused before they are made") {
  // 1000 * 1001 > 10^6. With one more table it would be 10^9 lists.
  const std::string effects = "effects = [\"jitter:sigma=0.1\", \"logic-spikes\"]\n";
  const std::string message =
      refusal_of(effects + vary("effect", "jitter", "sigma", 1000) + vary("effect", "logic-spikes", "rate", 1001) +
                 vary("effect", "logic-spikes", "factor", 1000));
  CAPTURE(message);
  CHECK(message.find("sweep.toml:10:1: the sweep has more than 1000000 runs") != std::string::npos);
}

TEST_CASE("sweep: lists of parts that multiply to more than a million are refused before they are made") {
  const std::string message =
      refusal_of("estimators = [\"linear-feedback\"]\neffects = [\"jitter:sigma=0.1\"]\n" +
                 vary("effect", "jitter", "sigma", 1001) + vary("estimator", "linear-feedback", "beta", 1000));
  CAPTURE(message);
  CHECK(message.find("sweep.toml:1:1: the sweep has more than 1000000 runs") != std::string::npos);
}

}  // namespace framesim
