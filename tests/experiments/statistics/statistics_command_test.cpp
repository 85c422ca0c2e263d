// Policies compared over seeds, through the binary.
#include "tests/experiments/program.h"

namespace framesim {
namespace {

bool has(const std::string& text, const std::string& part) { return text.find(part) != std::string::npos; }

const std::vector<std::string> kCompare = {
    "compare",   "--scenes",  "street",   "--policies",       "static,robin-hood,funkhouser",
    "--targets", "16ms,33ms", "--effect", "jitter:sigma=0.1", "--frames",
    "30",        "--seed",    "5",        "--seeds",          "6",
    "--quiet"};

std::vector<std::string> with(std::vector<std::string> words, const std::vector<std::string>& more) {
  words.insert(words.end(), more.begin(), more.end());
  return words;
}

}  // namespace

TEST_CASE("compare --seeds and query --statistics agree, though they run the seeds in different ways") {
  const TestFolder folder;
  folder.write(
      "sweep.toml",
      "framesim = 1\nscenes = [\"street\"]\npolicies = [\"static\", \"robin-hood\", \"funkhouser\"]\ntargets = "
      "[\"16ms\", \"33ms\"]\neffects = [\"jitter:sigma=0.1\"]\nframes = 30\nfirst_seed = 5\nseeds = 6\n");
  REQUIRE(run_program({"sweep", folder.path("sweep.toml"), "--store", folder.path("s.sqlite")}).exit_code == 0);
  for (const char* format : {"table", "csv", "json", "markdown"}) {
    CAPTURE(format);
    const ProgramRun compared = run_program(with(kCompare, {"--format", format}));
    const ProgramRun queried = run_program({"query", folder.path("s.sqlite"), "--statistics", "--format", format});
    CHECK(compared.exit_code == 0);
    CHECK(compared.out == queried.out);
    CHECK(has(compared.out, "funkhouser"));
  }
  const std::string text = run_program(kCompare).out;
  CAPTURE(text);
  CHECK(has(text, "6 seeds, 5 to 10"));
  CHECK(has(text, "times closer to the target than static (beaten)"));
  // All of six seeds one way: 2 / 2^6.
  CHECK(has(text, "6/6   <0.0001    0.0312"));
}

TEST_CASE("query --statistics: one policy by several planners stands there under several names") {
  const TestFolder folder;
  folder.write("sweep.toml",
               "framesim = 1\nscenes = [\"street\"]\npolicies = [\"robin-hood\"]\nplanners = [\"target\", "
               "\"inverse\"]\nframes = 10\neffects = [\"jitter:sigma=0.1\"]\nseeds = 2\n");
  REQUIRE(run_program({"sweep", folder.path("sweep.toml"), "--store", folder.path("s.sqlite")}).exit_code == 0);
  const ProgramRun run = run_program({"query", folder.path("s.sqlite"), "--statistics"});
  CAPTURE(run.out, run.err);
  CHECK(run.exit_code == 0);
  CHECK(has(run.out, "robin-hood by target"));
  CHECK(has(run.out, "robin-hood by inverse"));
}

TEST_CASE("compare --seeds: where the seed changes nothing, no chance is claimed") {
  const ProgramRun run = run_program({"compare", "--scenes", "street", "--policies", "static,robin-hood", "--seeds",
                                      "4", "--frames", "20", "--quiet"});
  CHECK(run.exit_code == 0);
  CAPTURE(run.out);
  CHECK(has(run.out, "(no spread)"));
  CHECK_FALSE(has(run.out, "(beaten)"));
  const ProgramRun one = run_program({"compare", "--scenes", "street", "--policies", "static,robin-hood", "--seeds",
                                      "1", "--frames", "20", "--quiet"});
  CHECK(has(one.out, "one seed says nothing about chance"));
}

TEST_CASE("compare --seeds and query --statistics refuse what does not go together") {
  const auto refused = [](const std::vector<std::string>& arguments, int exit_code, const std::string& words) {
    const ProgramRun run = run_program(arguments);
    CAPTURE(run.err, words);
    CHECK(run.exit_code == exit_code);
    CHECK(has(run.err, words));
    CHECK(run.out.empty());
  };
  refused(with(kCompare, {"--yardstick", "none"}), 2, "--yardstick");
  refused(with(kCompare, {"--plot", "x"}), 2, "--plot");
  refused({"compare", "--seeds", "0"}, 2, "--seeds");
  refused({"compare", "--seed", "18446744073709551615", "--seeds", "2"}, 2, "pass the largest");
  const TestFolder folder;
  folder.write("sweep.toml",
               "framesim = 1\nscenes = [\"street\"]\npolicies = [\"static\", \"robin-hood\"]\nframes = 3\n"
               "effects = [\"jitter:sigma=0.1\"]\nseeds = 3\n");
  const std::string store = folder.path("s.sqlite");
  // Half of a sweep: the policies have different seeds.
  REQUIRE(run_program({"sweep", folder.path("sweep.toml"), "--store", store, "--shard", "0/2"}).exit_code == 0);
  refused({"query", store, "--statistics"}, 3, "different seeds");
  refused({"query", store, "runs", "--statistics"}, 2, "no WHAT");
}

}  // namespace framesim
