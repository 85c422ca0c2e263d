// Accuracy tables of several builds as one, and what the exit code says, through the whole command line.
#include <fcntl.h>
#include <unistd.h>

#include "experiments/command_line.h"
#include "experiments/stability/report.h"
#include "tests/experiments/program.h"
#include "tests/scenes/refusal.h"

using namespace framesim;

namespace {

StabilityRow row(const char* group, double max_eps, std::optional<double> naive_eps, double bound_eps) {
  StabilityRow row{.group = group, .quantity = "q, r", .naive_form = naive_eps ? "n" : ""};
  row.cases = 3;
  row.ours = {.max_eps = max_eps, .mean_eps = max_eps / 2};
  if (naive_eps) row.naive = Accuracy{.max_eps = *naive_eps, .mean_eps = *naive_eps / 3};
  row.bound_eps = bound_eps;
  return row;
}

// What `act` prints is dropped.
template <class Act>
auto silently(Act act) {
  std::fflush(nullptr);
  const int out = dup(1), err = dup(2), nowhere = open("/dev/null", O_WRONLY);
  dup2(nowhere, 1);
  dup2(nowhere, 2);
  const auto result = act();
  std::fflush(nullptr);
  dup2(out, 1);
  dup2(err, 2);
  for (const int file : {out, err, nowhere}) close(file);
  return result;
}

int exit_code_of_stability() {
  std::string verb = "stability", program = "framesim";
  char* arguments[] = {program.data(), verb.data(), nullptr};
  return silently([&] { return run_command_line(2, arguments); });
}

bool has(const std::string& text, const std::string& part) { return text.find(part) != std::string::npos; }

}  // namespace

TEST_CASE("stability: a formula outside its bound makes the command's exit code 1") {
  const AddRows wrong = [](std::vector<StabilityRow>& rows) {
    ErrorCollector errors, none;
    errors.add(1 + 0x1p-51, 1);  // 2 eps
    rows.push_back(make_row("a program's own", "formula", "", 1, errors, none));
  };
  {
    const MoreStabilityRows more(wrong);
    CHECK(exit_code_of_stability() == 1);
  }
#if !defined(__SANITIZE_ADDRESS__)  // some ten seconds there
  CHECK(exit_code_of_stability() == 0);
#endif
}

TEST_CASE("stability: tables of two builds become one, which says whether they are identical") {
  const TestFolder folder;
  const std::vector<StabilityRow> rows = {row("g", 0.1, 12345678.9, 1), row("h", 0, std::nullopt, 0)};
  const std::string plain = folder.write("clang.csv", stability_csv(rows));
  const std::string named = folder.write("x.csv", named_stability_csv({"g++ 12.2, optimised", rows}));
  const ProgramRun both = run_program({"stability", "--merge", named, plain});
  CAPTURE(both.out, both.err);
  CHECK(both.exit_code == 0);
  CHECK(has(both.out, "| g++ 12.2, optimised | clang |\n"));
  CHECK(has(both.out, "\n\nAll 2 builds gave identical numbers.\n"));
  const ProgramRun csv = run_program({"stability", "--format", "csv", "--merge", named, plain});
  CHECK(csv.out ==
        "# All 2 builds gave identical numbers.\n"
        "build,group,quantity,naive_form,cases,max_eps,mean_eps,naive_max_eps,naive_mean_eps,bound_eps\n"
        "\"g++ 12.2, optimised\",\"g\",\"q, r\",\"n\",3,0.1,0.05,12345678.9,4115226.3000000003,1\n"
        "\"g++ 12.2, optimised\",\"h\",\"q, r\",\"\",3,0,0,NA,NA,0\n"
        "\"clang\",\"g\",\"q, r\",\"n\",3,0.1,0.05,12345678.9,4115226.3000000003,1\n"
        "\"clang\",\"h\",\"q, r\",\"\",3,0,0,NA,NA,0\n");
  CHECK(has(run_program({"stability", "--format", "html", "--merge", named, plain, named}).out,
            "<th>g++ 12.2, optimised (" + named + ")</th></tr>"));
}

TEST_CASE("stability: a last bit between two builds, or a row outside its bound, makes the merge's exit code 1") {
  const TestFolder folder;
  const std::string a = folder.write("a.csv", stability_csv({row("g", 0.5, 9, 1)}));
  const std::string b = folder.write("b.csv", stability_csv({row("g", 0.50000000000000011, 9, 1)}));
  const ProgramRun differ = run_program({"stability", "--merge", a, b});
  CHECK(differ.exit_code == 1);
  CHECK(has(differ.out, "The builds differ in 1 of 1 rows, first in: g, q, r.\n"));
  CHECK(has(differ.err, "the builds differ in: g, q, r"));
  const std::string outside = folder.write("c.csv", stability_csv({row("g", 1.5, 9, 1)}));
  const ProgramRun wrong = run_program({"stability", "--merge", outside});
  CHECK(wrong.exit_code == 1);
  CHECK(has(wrong.out, "OUTSIDE its bound"));
  CHECK(has(wrong.err, "g, q, r: 1.5 eps, bound 1 eps"));
}

TEST_CASE("stability: tables that cannot be merged are refused with file and reason") {
  const TestFolder folder;
  const StabilityRow first = row("g", 0.5, 9, 1), second = row("h", 0.5, 9, 1);
  const std::string good = folder.write("good.csv", stability_csv({first, second}));
  const auto refused = [&](const std::string& text) {
    return refusal([&] { read_stability_csvs({good, folder.write("bad.csv", text)}); });
  };
  const std::string path = folder.path("bad.csv"), header = stability_csv({});
  CHECK(says(refused(""), path + ":1", "no accuracy table; allowed: what 'framesim stability --format csv' writes"));
  CHECK(says(refused("a,b\n"), path + ":1", "no accuracy table"));
  CHECK(says(refused(header), path + ":1", "without rows"));
  CHECK(says(refused(header + "\"g\",1\n"), path + ":2", "2 fields, but the heading has 9"));
  CHECK(says(refused(header + "g,q,n,3,zero,1,2,3,4\n"), path + ":2", "'zero' is not a finite number"));
  CHECK(says(refused(header + "g,q,n,3,-1,1,2,3,4\n"), path + ":2", "found -1; allowed: numbers from 0 up"));
  CHECK(says(refused(stability_csv({first})), path, "has no row 'h, q, r'; " + good + " is of another version"));
  CHECK(says(refused(stability_csv({first, second, row("i", 0, {}, 0)})), path, "has a row more: 'i, q, r'"));
  CHECK(says(refused(stability_csv({second, first})), path, "has the row 'h, q, r' in place of 'g, q, r'"));
  CHECK(says(refused(stability_csv({first, row("h", 0.5, 9, 2)})), path, "bound in the row 'h, q, r'"));
  CHECK(run_program({"stability", "--merge", good, path}).exit_code == 3);
  CHECK(run_program({"stability", "--merge", folder.path("none.csv")}).exit_code == 3);
}
