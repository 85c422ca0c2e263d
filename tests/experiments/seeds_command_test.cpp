// framesim run --seeds, from outside.
#include "tests/experiments/program.h"

using namespace framesim;

namespace {

bool has(const std::string& text, const std::string& part) { return text.find(part) != std::string::npos; }

std::vector<std::string> run_with(const std::vector<std::string>& more, const std::string& policy = "robin-hood") {
  std::vector<std::string> words = {"run", "street", "--policy", policy, "--frames", "6", "--effect", "jitter"};
  words.insert(words.end(), more.begin(), more.end());
  return words;
}

}  // namespace

TEST_CASE("run --seeds prints the spread of the figures, and on stderr how the seeds were run") {
  const ProgramRun shared = run_program(run_with({"--seeds", "9"}));
  CHECK(shared.exit_code == 0);
  for (const char* word : {"seeds          9: 1 to 9", "AvgErr, %", "latency, ms", "std dev", "Student"}) {
    CAPTURE(word);
    CHECK(has(shared.out, word));
  }
  CHECK(has(shared.err, "9 seeds shared"));
  CHECK(has(shared.err, "8 at a time side by side"));
  const ProgramRun apart = run_program(run_with({"--seeds", "2", "--seed", "7"}, "feedback"));
  CHECK(has(apart.out, "seeds          2: 7 to 8"));
  CHECK(has(apart.err, "each simulated on its own: the policy learns from outcomes"));
  CHECK(run_program(run_with({"--seeds", "2", "--quiet"})).err.empty());
}

TEST_CASE("run --seeds refuses what is about one run, and counts that are none") {
  const auto refused = [](const std::vector<std::string>& more, const std::string& word) {
    const ProgramRun run = run_program(run_with(more));
    CAPTURE(more, run.out, run.err);
    CHECK(run.exit_code == 2);
    CHECK(run.out.empty());
    CHECK(has(run.err, word));
  };
  refused({"--seeds", "0"}, "'0'");
  refused({"--seeds", "2.5"}, "'2.5'");
  refused({"--seeds", "many"}, "'many'");
  refused({"--seeds", "2", "--seed", "18446744073709551615"}, "pass the largest one");
  refused({"--seeds", "2", "--profile"}, "--profile");
  refused({"--seeds", "2", "--frames-out", "f.csv"}, "--frames-out");
  refused({"--seeds", "2", "--plot", "p"}, "--plot");
  refused({"--seeds-out", "s.csv"}, "--seeds");
}
