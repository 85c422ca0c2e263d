// The command line through its binary, as a user meets it: every verb, and right and wrong words.
#include <algorithm>
#include <cstdio>
#include <string>
#include <vector>

#include "scenes/registry.h"
#include "sim/effect.h"
#include "tests/catch.h"
#include "tests/experiments/program.h"

namespace framesim {
namespace {

bool has(const std::string& text, const std::string& part) { return text.find(part) != std::string::npos; }

long lines_in(const std::string& text) { return std::count(text.begin(), text.end(), '\n'); }

// A run that is refused: exit code, nothing on stdout, and stderr names all of `words`.
void check_refused(const std::vector<std::string>& arguments, int exit_code, const std::vector<std::string>& words) {
  const ProgramRun run = run_program(arguments);
  CAPTURE(arguments, run.out, run.err);
  CHECK(run.exit_code == exit_code);
  CHECK(run.out.empty());
  for (const std::string& word : words) {
    CAPTURE(word);
    CHECK(has(run.err, word));
  }
}

const std::vector<std::string> kSmall = {"compare",           "--scenes",  "street",    "--policies",
                                         "static,robin-hood", "--targets", "16ms,30fps"};

std::vector<std::string> small_with(const std::vector<std::string>& more) {
  std::vector<std::string> arguments = kSmall;
  arguments.insert(arguments.end(), more.begin(), more.end());
  return arguments;
}

}  // namespace

TEST_CASE("command line: --help of each verb has examples and goes to stdout") {
  for (const char* verb : {"list", "run", "compare", "explain", "check"}) {
    CAPTURE(verb);
    const ProgramRun help = run_program({verb, "--help"});
    CHECK(help.exit_code == 0);
    CHECK(has(help.out, "Examples:"));
    CHECK(has(help.out, std::string("framesim ") + verb));
    CHECK(help.err.empty());
  }
  CHECK(run_program({"--help"}).exit_code == 0);
}

// Costs that a machine file may state, but that are too much together: the machine is bad input, not the program.
TEST_CASE(
    "command line: a machine whose draws take longer than a day is refused, by a run and by an estimator's benchmark") {
  const TestFolder folder;
  const std::string machine = folder.write("slow.toml",
                                           "framesim = 1\n[machine]\nname = \"slow\"\nsource = \"test\"\n"
                                           "[machine.algorithm.default]\npolygon = \"10s\"\npixel = \"1s\"\n");
  for (const char* estimator : {"oracle", "table"}) {
    check_refused({"run", "auditorium", "--policy", "full-detail", "--machine", machine, "--estimator", estimator}, 3,
                  {"simulated time: "});
  }
}

TEST_CASE("command line: --version") {
  const ProgramRun version = run_program({"--version"});
  CHECK(version.exit_code == 0);
  CHECK(version.out.starts_with("framesim "));
}

TEST_CASE("command line: list prints each kind, its names and their parameters") {
  const ProgramRun all = run_program({"list"});
  CHECK(all.exit_code == 0);
  for (const char* kind :
       {"scenes\n", "policies\n", "effects\n", "estimators\n", "machines\n", "planners\n", "generators\n"}) {
    CAPTURE(kind);
    CHECK(has(all.out, kind));
  }
  const ProgramRun policies = run_program({"list", "policies"});
  CHECK(policies.exit_code == 0);
  CHECK(has(policies.out, "\n  robin-hood "));
  CHECK(has(policies.out, "\n      value="));
  CHECK_FALSE(has(policies.out, "scenes\n"));
}

TEST_CASE("command line: run says what was run, whether it held, and where the time went") {
  const ProgramRun run = run_program({"run", "street", "--policy", "full-detail", "--target", "16ms"});
  CHECK(run.exit_code == 0);
  for (const char* word : {"scene ", "machine ", "overlap ", "policy ", "target         16ms", "holds          NO",
                           "AvgErr", "critical path  CPU before the first command"}) {
    CAPTURE(word);
    CHECK(has(run.out, word));
  }
  CHECK(has(run.err, "took "));  // the clock is no result: it stays off stdout
  CHECK(run_program({"run", "street", "--policy", "full-detail", "--target", "16ms", "--quiet"}).err.empty());
}

TEST_CASE("command line: the frames file has a heading and one row a frame, and is the only file written") {
  const TestFolder folder;
  const ProgramRun run =
      run_program({"run", "street", "--policy", "static", "--frames", "7", "--frames-out", folder.path("f.csv")});
  CHECK(run.exit_code == 0);
  const std::string text = folder.read("f.csv");
  CHECK(lines_in(text) == 8);
  CHECK(text.starts_with("frame,"));
  CHECK(has(text, "\n6,"));
  CHECK(folder.names() == std::vector<std::string>{"f.csv"});
}

TEST_CASE("command line: recurrence and event queue give the same frame rows") {
  // Columns up to the critical path, which only the recurrence traces; the one after it says which engine it was.
  const TestFolder folder;
  for (const char* engine : {"recurrence", "events"}) {
    const ProgramRun run = run_program({"run", "auditorium", "--policy", "feedback", "--frames", "20", "--fidelity",
                                        engine, "--frames-out", folder.path(engine)});
    CAPTURE(engine, run.err);
    REQUIRE(run.exit_code == 0);
  }
  const auto without_critical = [](const std::string& text) {
    const std::size_t wanted = static_cast<std::size_t>(
        std::count(text.begin(), text.begin() + static_cast<long>(text.find("critical_")), ','));
    std::string kept;
    std::size_t fields = 0;
    for (const char c : text) {
      if (c == '\n') fields = 0;
      if (c == ',') ++fields;
      if (fields < wanted) kept += c;
    }
    return kept;
  };
  CHECK(without_critical(folder.read("recurrence")) == without_critical(folder.read("events")));
}

TEST_CASE("command line: compare has one row for each scene, target and policy, in the order asked for") {
  const ProgramRun csv = run_program(small_with({"--format", "csv"}));
  CHECK(csv.exit_code == 0);
  CHECK(lines_in(csv.out) == 1 + 2 * 2);
  const std::size_t rows[] = {csv.out.find("\nstreet,static,0.016,"), csv.out.find("\nstreet,robin-hood,0.016,"),
                              csv.out.find("\nstreet,static,0.0333"), csv.out.find("\nstreet,robin-hood,0.0333")};
  CHECK(std::is_sorted(std::begin(rows), std::end(rows)));
  CHECK(rows[3] != std::string::npos);
}

TEST_CASE("command line: compare in every format, and into a file") {
  CHECK(has(run_program(small_with({})).out, "Targets held"));
  CHECK(has(run_program(small_with({"--format", "markdown"})).out, "| scene | target | policy | holds |"));
  CHECK(has(run_program(small_with({"--format", "json"})).out, "\"policy\": \"robin-hood\""));
  const TestFolder folder;
  const ProgramRun file = run_program(small_with({"--format", "csv", "-o", folder.path("t.csv")}));
  CHECK(file.exit_code == 0);
  CHECK(file.out.empty());
  CHECK(folder.read("t.csv") == run_program(small_with({"--format", "csv"})).out);
  CHECK(folder.names() == std::vector<std::string>{"t.csv"});
}

TEST_CASE("command line: any number of jobs gives the same bytes") {
  const auto with_jobs = [](const char* jobs) {
    return run_program(
               {"compare", "--scenes", "street,auditorium", "--frames", "20", "--format", "csv", "--jobs", jobs})
        .out;
  };
  const std::string one = with_jobs("1");
  CHECK(lines_in(one) > 10);
  CHECK(with_jobs("2") == one);
  CHECK(with_jobs("5") == one);
}

TEST_CASE("command line: policies with parameters stay whole between commas, and list options may be repeated") {
  const ProgramRun run =
      run_program({"compare", "--scenes", "street", "--policies", "robin-hood:value=9,levels=false,static",
                   "--policies", "feedback", "--format", "csv", "--frames", "5"});
  CHECK(run.exit_code == 0);
  CHECK(has(run.out, "\nstreet,\"robin-hood:value=9,levels=false\","));
  CHECK(has(run.out, "\nstreet,static,"));
  CHECK(has(run.out, "\nstreet,feedback,"));
}

TEST_CASE("command line: effects are added, replaced and taken away") {
  const auto frames = [](const std::vector<std::string>& more) {
    std::vector<std::string> arguments = {"run", "street", "--policy", "static", "--target", "16ms"};
    arguments.insert(arguments.end(), more.begin(), more.end());
    const ProgramRun run = run_program(arguments);
    CAPTURE(run.err);
    CHECK(run.exit_code == 0);
    return run.out;
  };
  CHECK(has(frames({"--effect", "jitter:sigma=0.1"}), "jitter:sigma=0.1"));
  // The scene declares vsync:rate=off, which is inert; a rate of 60 Hz in its place is not.
  CHECK(has(frames({}), "vsync:rate=off left out"));
  CHECK(has(frames({"--effect", "vsync:rate=60Hz"}), "effects        semantics, vsync:rate=60Hz\n"));
  CHECK(has(frames({"--no-effect", "vsync"}), "effects        semantics\n"));
  CHECK(has(frames({"--no-effect", "all"}), "effects        none\n"));
  CHECK(frames({"--effect", "jitter", "--seed", "2"}) != frames({"--effect", "jitter", "--seed", "3"}));
  // They apply in the order of the registry, in whatever order they are declared.
  const std::vector<std::string> bare = {"--no-effect", "all"};
  const auto with_bare = [&](std::vector<std::string> more) {
    more.insert(more.begin(), bare.begin(), bare.end());
    return frames(more);
  };
  const std::string ordered = with_bare({"--effect", "frames-in-flight", "--effect", "jitter", "--effect", "vsync"});
  CHECK(has(ordered, "effects        frames-in-flight, jitter, vsync\n"));
  CHECK(ordered == with_bare({"--effect", "vsync", "--effect", "jitter", "--effect", "frames-in-flight"}));
  // Forced in, an inert effect runs, and only the line that says so differs.
  CHECK(has(with_bare({"--effect", "jitter:sigma=0", "--force-inert-effects"}), "effects        jitter:sigma=0\n"));
  CHECK_FALSE(has(run_program({"run", "--help"}).out, "force-inert"));
}

TEST_CASE("command line: an effect of the machine shows in the machine") {
  const ProgramRun run = run_program({"run", "street", "--policy", "static", "--effect", "frames-in-flight:n=3"});
  CHECK(run.exit_code == 0);
  CHECK(has(run.out, "overlap        staged:3\n"));
}

TEST_CASE("command line: explain names each effect as active, inert with its reason, or not declared") {
  const ProgramRun run =
      run_program({"explain", "street", "--policy", "distance", "--no-effect", "semantics", "--effect", "jitter",
                   "--effect", "frames-in-flight:n=1", "--effect", "submission:command=7us"});
  CAPTURE(run.out, run.err);
  CHECK(run.exit_code == 0);
  const auto line = [&](const std::string& name, const std::string& value) {
    CAPTURE(name);
    const std::size_t at = run.out.find("\n  " + name + " ");
    REQUIRE(at != std::string::npos);
    const std::string text = run.out.substr(at + 1, run.out.find('\n', at + 1) - at - 1);
    CAPTURE(text);
    CHECK(has(text, value));
  };
  line("jitter", "active: jitter");
  line("submission", "active: submission:command=7us");
  line("frames-in-flight", "inert: the machine has n=1 already");
  line("vsync", "inert: the display does not wait: rate is off (vsync:rate=off)");
  line("logic-spikes", "not declared");
  // Hooks and columns that follow: distance is what this policy reads, the view angle nothing reads.
  line("machine", "submission (");
  line("commands", "jitter (");
  line("workload", "empty");
  line("distance", "computed for policy distance");
  line("view angle", "not computed");
  line("estimated cost", "always computed");
}

TEST_CASE("command line: explain says which engine follows, and which columns an effect asks for") {
  const auto explained = [](std::vector<std::string> more) {
    more.insert(more.begin(), {"explain", "street"});
    return run_program(more).out;
  };
  CHECK(has(explained({"--fidelity", "events"}),
            "engine         events: asked for; exact for overlap staged:1 with semantics; the recurrence gives"));
  CHECK(has(explained({"--overlap", "serial"}),
            "engine         closed-form: exact for overlap serial with semantics; one formula a frame\n"));
  CHECK(has(explained({"--effect", "preemption", "--effect", "streaming:preload=no", "--effect", "jitter"}),
            "needed for streaming, preemption\n"));
  CHECK(has(explained({"--effect", "streaming"}), "engine         recurrence: exact"));  // the street fits: inert
  CHECK(has(explained({"--policy", "static", "--effect", "focus"}), "view angle         computed for effects focus\n"));
  CHECK(has(explained({"--effect", "focus:weight=0"}), "view angle         not computed\n"));
}

// The street declares semantics and vsync, and vsync is inert: it is not among what the times are exact for.
TEST_CASE("command line: explain names the effects for which the times are exact") {
  const auto engine = [](std::vector<std::string> more) {
    more.insert(more.begin(), {"explain", "street"});
    const std::string out = run_program(more).out;
    const std::size_t at = out.find("\nengine ");
    return at == std::string::npos ? out : out.substr(at + 1, out.find('\n', at + 1) - at - 1);
  };
  const std::string pass = "engine         recurrence: exact for overlap staged:1";
  CHECK(engine({}) == pass + " with semantics; one pass over the commands");
  CHECK(engine({"--no-effect", "all"}) == pass + ", no effect is active; one pass over the commands");
  // In the order in which they apply, not that of the command line.
  CHECK(engine({"--effect", "jitter", "--effect", "focus", "--no-effect", "semantics"}) ==
        pass + " with focus, jitter; one pass over the commands");
  CHECK(engine({"--effect", "preemption"}) ==
        "engine         events: exact for overlap staged:1 with semantics, preemption; needed for preemption");
  CHECK(engine({"--effect", "preemption", "--fidelity", "recurrence"}) ==
        "engine         recurrence: asked for; not exact, as events would be (exact for overlap staged:1 with "
        "semantics, preemption; needed for preemption)");
}

TEST_CASE("command line: explain lists what an engine that was asked for leaves out") {
  const auto explained = [](std::vector<std::string> more) {
    more.insert(more.begin(), {"explain", "street"});
    return run_program(more).out;
  };
  const std::string formula = explained({"--fidelity", "closed-form", "--effect", "preemption"});
  CHECK(has(formula, "engine         closed-form: asked for; not exact, as events would be"));
  CHECK(has(formula, "\nleaves out     overlap staged:1"));
  CHECK(has(formula, "\nleaves out     preemption: "));
  const std::string staged = explained({"--fidelity", "recurrence", "--overlap", "serial"});
  CHECK(has(staged, "engine         recurrence: asked for; not exact, as closed-form would be"));
  CHECK(has(staged, "\nleaves out     overlap serial"));
  CHECK_FALSE(has(explained({"--fidelity", "recurrence"}), "leaves out"));
  CHECK_FALSE(has(explained({"--fidelity", "events", "--effect", "preemption"}), "leaves out"));
}

TEST_CASE("command line: explain works on every built-in scene, and names each effect") {
  for (const BuiltIn& scene : built_in_scenes()) {
    const ProgramRun run = run_program({"explain", std::string(scene.name)});
    CAPTURE(scene.name, run.out, run.err);
    CHECK(run.exit_code == 0);
    CHECK(run.err.empty());
    CHECK(has(run.out, "\nengine         "));
    for (const EffectEntry& effect : effects()) CHECK(has(run.out, "\n  " + std::string(effect.name) + " "));
  }
}

TEST_CASE("command line: wrong words are refused with exit code 2 and the legal ones") {
  check_refused({}, 2, {"list, run, compare, explain, check"});
  check_refused({"comapre"}, 2, {"comapre", "did you mean 'compare'"});
  check_refused({"run", "street"}, 2, {"--policy"});
  check_refused({"run", "street", "--policy", "robinhood"}, 2, {"robinhood", "robin-hood", "full-detail"});
  check_refused({"run", "street", "--policy", "robin-hood:valu=8"}, 2, {"valu", "value", "levels"});
  check_refused({"run", "street", "--policy", "robin-hood:value=7"}, 2, {"7", "8", "9", "10", "11"});
  check_refused({"run", "nowhere", "--policy", "static"}, 2, {"nowhere", "street"});
  check_refused({"run", "graphicon-forest:tress=3", "--policy", "static"}, 2, {"tress", "trees"});
  check_refused({"run", "street", "--policy", "static", "--target", "25mm"}, 2, {"25mm", "ns, us, ms, s, Hz, fps"});
  check_refused({"run", "street", "--policy", "static", "--target", "0"}, 2, {"longer than 0"});
  check_refused({"run", "street", "--policy", "static", "--estimator", "oracel"}, 2, {"oracel", "oracle"});
  check_refused({"run", "street", "--policy", "static", "--machine", "cray"}, 2, {"cray", "street"});
  check_refused({"run", "street", "--policy", "static", "--planner", "none"}, 2, {"none", "inverse"});
  check_refused({"run", "street", "--policy", "static", "--overlap", "staged:9"}, 2, {"staged:9"});
  check_refused({"run", "street", "--policy", "static", "--effect", "fog"}, 2, {"fog", "jitter"});
  check_refused({"run", "street", "--policy", "static", "--no-effect", "fog"}, 2, {"fog", "jitter"});
  check_refused({"run", "street", "--policy", "static", "--seed", "-1"}, 2, {"-1"});
  check_refused({"run", "street", "--policy", "static", "--frames", "0"}, 2, {"'0'", "all"});
  check_refused({"run", "street", "--policy", "static", "--fidelity", "high"}, 2, {"high", "recurrence"});
  check_refused({"run", "street", "--policy", "static", "--frobnicate"}, 2, {"--frobnicate"});
  check_refused({"list", "cars"}, 2, {"cars", "policies"});
  check_refused({"compare", "--format", "xml"}, 2, {"xml", "markdown"});
  check_refused({"compare", "--jobs", "0"}, 2, {"--jobs"});
  check_refused({"compare", "--policies", "static,,distance"}, 2, {"empty"});
  check_refused({"compare", "--scenes", "street", "-o", "/nonexistent/t.csv"}, 2, {"/nonexistent"});
}

TEST_CASE("command line: an engine that is not exact runs, and a note says what it leaves out") {
  const auto with = [](std::vector<std::string> more) {
    more.insert(more.begin(), {"run", "street", "--policy", "static", "--frames", "5"});
    const ProgramRun run = run_program(more);
    CAPTURE(more, run.err);
    CHECK(run.exit_code == 0);
    return run;
  };
  const std::string note = "framesim: note: --fidelity ";
  CHECK(has(with({"--fidelity", "closed-form"}).err, note + "closed-form leaves out: overlap staged:1"));
  CHECK(has(with({"--overlap", "serial", "--fidelity", "recurrence"}).err,
            note + "recurrence leaves out: overlap serial"));
  CHECK(has(with({"--effect", "preemption", "--fidelity", "recurrence"}).err, "never comes"));
  CHECK(with({"--fidelity", "closed-form", "--quiet"}).err.empty());
  CHECK_FALSE(has(with({"--overlap", "serial", "--fidelity", "closed-form"}).err, note));
  CHECK_FALSE(has(with({"--fidelity", "events"}).err, note));
  CHECK_FALSE(has(with({"--effect", "preemption"}).err, note));
  // Of a comparison: each different note once, whatever the number of runs.
  const ProgramRun table = run_program(small_with({"--fidelity", "closed-form"}));
  CHECK(table.exit_code == 0);
  CHECK(table.err.find(note) != std::string::npos);
  CHECK(table.err.find(note) == table.err.rfind(note));
  CHECK(run_program(small_with({"--fidelity", "closed-form", "--quiet"})).err.empty());
}

TEST_CASE("command line: run says what streaming and preemption did, where they ran") {
  const auto with = [](std::vector<std::string> more) {
    more.insert(more.begin(), {"run", "dong-forest", "--policy", "static", "--frames", "20"});
    return run_program(more).out;
  };
  const std::string both = with({"--effect", "streaming:memory=0", "--effect", "preemption:period=7ms"});
  CHECK(has(both, "\nstreaming      "));
  CHECK(has(both, "\npreemption     another client held the GPU for "));
  CHECK_FALSE(has(with({}), "\nstreaming      "));
  CHECK_FALSE(has(with({}), "\npreemption     "));
}

TEST_CASE("command line: the last policy's mistake stops a comparison before its first run") {
  check_refused(small_with({"--policies", "feedback:gain=oops"}), 2, {"gain", "oops"});
}

TEST_CASE("command line: a full disk is an error, not a short table") {
  // /dev/full takes nothing: the table cannot be written, whatever the run said.
  const ProgramRun run = run_program(small_with({"-o", "/dev/full"}));
  CHECK(run.exit_code == 2);
  CHECK(has(run.err, "/dev/full"));
}

}  // namespace framesim
