// Comparisons beside earlier ones, and their reports.
#include "experiments/statistics/baseline.h"

#include <limits>

#include "tests/experiments/program.h"

namespace framesim {
namespace {

bool has(const std::string& text, const std::string& part) { return text.find(part) != std::string::npos; }

WatchedRow row(const std::string& policy, double avg_err, double p95_s, double benefit) {
  return {"street", policy, 0.016, avg_err, p95_s, benefit};
}

const std::vector<std::string> kCompare = {"compare",   "--scenes",  "street",   "--policies", "static,robin-hood",
                                           "--targets", "16ms,33ms", "--frames", "20",         "--quiet"};

std::vector<std::string> with(std::vector<std::string> words, const std::vector<std::string>& more) {
  words.insert(words.end(), more.begin(), more.end());
  return words;
}

// The CSV with the first number after "street,robin-hood,0.016," ... of column avg_err divided by 1.1: what is now is 10 % worse.
std::string better_past(const std::string& csv) {
  std::string text = csv;
  const std::size_t line = text.find("street,robin-hood,0.016,");
  REQUIRE(line != std::string::npos);
  std::size_t field = line;
  for (int commas = 0; commas < 6; ++commas)
    field = text.find(',', field) + 1;  // scene policy target frames mean stddev
  const std::size_t end = text.find(',', field);
  const double value = std::stod(text.substr(field, end - field));
  return text.replace(field, end - field, std::to_string(value / 1.1));
}

}  // namespace

TEST_CASE("a baseline: what became worse, by each measure and beyond the noise") {
  const std::vector<WatchedRow> before = {row("a", 0.10, 0.020, 0.9), row("b", 0.10, 0.020, 0.9),
                                          row("c", 0.00, 0.020, 0.9), row("gone", 1, 1, 1)};
  // a: 10 % more error; b: error half, but 20 % of the benefit lost; c: an error where there was none; d: was not there.
  const std::vector<WatchedRow> now = {row("a", 0.11, 0.020, 0.9), row("b", 0.05, 0.020, 0.72),
                                       row("c", 0.01, 0.020, std::numeric_limits<double>::quiet_NaN()),
                                       row("d", 1, 1, 1)};
  const BaselineCheck strict = check_baseline(now, before, 0.05);
  CHECK(strict.worse == 3);
  CHECK(strict.better == 0);  // b is better and worse: worse
  CHECK(strict.is_new == 1);
  CHECK(strict.not_run == 1);
  REQUIRE(strict.rows.size() == 4);
  CHECK(strict.rows[0].worse == std::vector<std::string>{"AvgErr 10 % -> 11 % (+10.00 %)"});
  CHECK(strict.rows[1].worse == std::vector<std::string>{"benefit 90 % -> 72 % (-20.00 %)"});
  CHECK(strict.rows[1].better == std::vector<std::string>{"AvgErr 10 % -> 5 % (-50.00 %)"});
  CHECK(strict.rows[2].worse == std::vector<std::string>{"AvgErr 0 % -> 1 % (from nothing)"});
  const BaselineCheck lenient = check_baseline(now, before, 0.30);
  CHECK(lenient.worse == 1);  // c: no share of nothing is noise
  CHECK(lenient.better == 1);
  CHECK(check_baseline(before, before, 0).worse == 0);
  CHECK(read_noise_threshold("2.5%") == 0.025);
  CHECK(read_noise_threshold("3") == 0.03);
  for (const char* wrong : {"", "%", "-1%", "much", "5%%"}) CHECK_THROWS(read_noise_threshold(wrong));
}

TEST_CASE("compare --baseline: a table, a store and a golden table serve, and a regression is exit code 1") {
  const TestFolder folder;
  const ProgramRun csv = run_program(with(kCompare, {"--format", "csv"}));
  folder.write("same.csv", csv.out);
  folder.write("golden.csv", "# framesim compare --scenes street\n" + csv.out);
  folder.write("past.csv", better_past(csv.out));
  folder.write("sweep.toml",
               "framesim = 1\nscenes = [\"street\"]\npolicies = [\"static\", \"robin-hood\"]\ntargets = "
               "[\"16ms\", \"33ms\"]\nframes = 20\n");
  REQUIRE(run_program({"sweep", folder.path("sweep.toml"), "--store", folder.path("s.sqlite")}).exit_code == 0);
  for (const char* name : {"same.csv", "golden.csv", "s.sqlite"}) {
    const ProgramRun run = run_program(with(kCompare, {"--baseline", folder.path(name), "--fail-on-regression"}));
    CAPTURE(name, run.out, run.err);
    CHECK(run.exit_code == 0);
    CHECK(has(run.out, "4 rows, 0 worse, 0 better, 0 new; 0 rows of it not run"));
  }
  const std::vector<std::string> past = with(kCompare, {"--baseline", folder.path("past.csv")});
  CHECK(run_program(past).exit_code == 0);
  const ProgramRun failed = run_program(with(past, {"--fail-on-regression", "--junit", folder.path("j.xml")}));
  CAPTURE(failed.out);
  CHECK(failed.exit_code == 1);
  CHECK(has(failed.out, "4 rows, 1 worse"));
  CHECK(has(failed.out, "worse   street, robin-hood, 16ms: AvgErr"));
  CHECK(has(failed.out, "(+10.00 %)"));
  CHECK(has(folder.read("j.xml"), "tests=\"4\" failures=\"1\""));
  CHECK(has(folder.read("j.xml"), "<testcase classname=\"" + folder.path("past.csv") +
                                      "\" name=\"street, robin-hood, 16ms\">\n      <failure message=\"AvgErr "));
  CHECK(run_program(with(past, {"--fail-on-regression", "--noise-threshold", "11%"})).exit_code == 0);
  // The list stays out of a table for programs.
  const ProgramRun piped = run_program(with(past, {"--fail-on-regression", "--format", "csv"}));
  CHECK(piped.out == csv.out);
  CHECK(has(piped.err, "worse   street, robin-hood"));
  // Seeds: the means of the seeds beside those of the store.
  folder.write("sweep.toml", folder.read("sweep.toml") + "effects = [\"jitter:sigma=0.1\"]\nseeds = 3\n");
  REQUIRE(run_program({"sweep", folder.path("sweep.toml"), "--store", folder.path("n.sqlite")}).exit_code == 0);
  const ProgramRun means = run_program(with(kCompare, {"--effect", "jitter:sigma=0.1", "--seeds", "3", "--baseline",
                                                       folder.path("n.sqlite"), "--fail-on-regression"}));
  CHECK(means.exit_code == 0);
  CHECK(has(means.out, "4 rows, 0 worse, 0 better, 0 new; 0 rows of it not run"));
}

TEST_CASE("compare --baseline: what is no baseline is refused before the first run") {
  const TestFolder folder;
  const auto refused = [&](const std::vector<std::string>& more, int exit_code, const std::string& words) {
    const ProgramRun run = run_program(with(kCompare, more));
    CAPTURE(run.err, words);
    CHECK(run.exit_code == exit_code);
    CHECK(has(run.err, words));
    CHECK(run.out.empty());
  };
  refused({"--baseline", folder.path("none.csv")}, 3, "none.csv");
  refused({"--baseline", folder.write("empty.csv", "")}, 3, "is empty");
  refused({"--baseline", folder.write("other.csv", "a,b\n1,2\n")}, 3, "other.csv:1: there is no column 'scene'");
  const std::string head = "scene,policy,target_s,avg_err,p95_s,benefit_share\n";
  refused({"--baseline", folder.write("short.csv", head + "street,static,0.016\n")}, 3, "short.csv:2: 3 fields");
  refused({"--baseline", folder.write("word.csv", head + "street,static,0.016,much,1,1\n")}, 3, "word.csv:2: avg_err");
  refused({"--fail-on-regression"}, 2, "--baseline");
  refused({"--junit", "x.xml"}, 2, "--baseline");
  refused({"--baseline", folder.path("empty.csv"), "--noise-threshold", "much"}, 2, "--noise-threshold");
  // Two estimators: which of them would be the baseline?
  folder.write("sweep.toml",
               "framesim = 1\nscenes = [\"street\"]\npolicies = [\"static\"]\nestimators = [\"oracle\", "
               "\"table\"]\nframes = 3\n");
  REQUIRE(run_program({"sweep", folder.path("sweep.toml"), "--store", folder.path("s.sqlite")}).exit_code == 0);
  refused({"--baseline", folder.path("s.sqlite")}, 3, "different conditions");
}

TEST_CASE("JUnit XML and Markdown hold what names and failures hold") {
  const std::vector<CheckedSuite> suites = {
      {"t<1>", {{"a & \"b\"", {}}, {"c|d", {"x: expected 1, found 2", "y: <\x01>"}}}}};
  CHECK(junit_xml(suites) ==
        "<?xml version=\"1.0\" encoding=\"UTF-8\"?>\n"
        "<testsuites name=\"framesim\" tests=\"2\" failures=\"1\">\n"
        "  <testsuite name=\"t&lt;1&gt;\" tests=\"2\" failures=\"1\" errors=\"0\" skipped=\"0\">\n"
        "    <testcase classname=\"t&lt;1&gt;\" name=\"a &amp; &quot;b&quot;\"/>\n"
        "    <testcase classname=\"t&lt;1&gt;\" name=\"c|d\">\n"
        "      <failure message=\"x: expected 1, found 2\">x: expected 1, found 2&#10;y: &lt;?&gt;</failure>\n"
        "    </testcase>\n"
        "  </testsuite>\n"
        "</testsuites>\n");
  CHECK(markdown_summary("verdict", suites) ==
        "### verdict\n\n- t<1>: 1 of 2 rows as expected\n\n| table | row | what differs |\n|---|---|---|\n"
        "| t<1> | c\\|d | x: expected 1, found 2<br>y: <\x01> |\n\n");
}

TEST_CASE("check writes JUnit XML, and adds its summary to the page that GitHub names") {
  const TestFolder folder;
  const ProgramRun csv = run_program(with(kCompare, {"--format", "csv", "--yardstick", "none"}));
  const std::string first =
      "# framesim compare --scenes street --policies static,robin-hood --targets 16ms,33ms --frames "
      "20 --yardstick none\n";
  std::filesystem::create_directory(folder.path("golden"));
  folder.write("golden/good.csv", first + csv.out);
  folder.write("golden/moved.csv", first + better_past(csv.out));
  folder.write("summary.md", "before\n");
  setenv("GITHUB_STEP_SUMMARY", folder.path("summary.md").c_str(), 1);
  const ProgramRun run = run_program({"check", folder.path("golden"), "--junit", folder.path("j.xml"), "--quiet"});
  setenv("GITHUB_STEP_SUMMARY", folder.path("none/summary.md").c_str(), 1);
  const ProgramRun unwritable = run_program({"check", folder.path("golden"), "--quiet"});
  unsetenv("GITHUB_STEP_SUMMARY");
  CAPTURE(run.out, run.err);
  CHECK(run.exit_code == 1);
  const std::string xml = folder.read("j.xml");
  CAPTURE(xml);
  CHECK(has(xml, "<testsuites name=\"framesim\" tests=\"8\" failures=\"1\">"));
  CHECK(has(xml, "golden/good.csv\" tests=\"4\" failures=\"0\""));
  CHECK(has(xml, "golden/moved.csv\" tests=\"4\" failures=\"1\""));
  CHECK(has(xml, "name=\"street, robin-hood, 0.016 s\">\n      <failure message=\"avg_err: expected"));
  const std::string summary = folder.read("summary.md");
  CHECK(has(summary, "before\n### framesim check: 2 tables, 8 rows: 1 differences\n"));
  CHECK(has(summary, "| street, robin-hood, 0.016 s | avg_err: expected"));
  CHECK(unwritable.exit_code == 1);
  CHECK(unwritable.out == run.out);
  CHECK(has(unwritable.err, "GITHUB_STEP_SUMMARY"));
}

}  // namespace framesim
