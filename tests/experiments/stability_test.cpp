// The accuracy table: every row inside its bound, and the measure of error itself.
#include <limits>

#include "experiments/stability/accuracy.h"
#include "experiments/stability/report.h"
#include "tests/catch.h"
#include "tests/experiments/program.h"

using namespace framesim;

namespace {

// Computed once: a second or so with sanitizers.
const std::vector<StabilityRow>& all_rows() {
  static const std::vector<StabilityRow> rows = stability_rows();
  return rows;
}

}  // namespace

TEST_CASE("stability: the error of a number in eps") {
  CHECK(error_eps(1.0, 1) == 0);
  // 1 + eps against 1: |a-b| / min = eps.
  CHECK(error_eps(1 + 0x1p-52, 1) == 1);
  // Symmetric: 2 against 1 and 1 against 2 are both wrong by the whole smaller one.
  CHECK(error_eps(2, 1) == kMaximalEps);
  CHECK(error_eps(1, 2) == kMaximalEps);
  CHECK(error_eps(0, 0) == 0);
  CHECK(error_eps(0, 1) == kMaximalEps);
  CHECK(error_eps(-1e-300, Exact(1e-300)) == kMaximalEps);
  CHECK(error_eps(std::numeric_limits<double>::quiet_NaN(), 1) == kMaximalEps);
  CHECK(error_eps(std::numeric_limits<double>::infinity(), 1) == kMaximalEps);
  // Root mean square of 0 and 2 eps: sqrt(4 / 2).
  ErrorCollector errors;
  errors.add(1, 1);
  errors.add(1 + 0x1p-51, 1);
  CHECK(errors.accuracy().max_eps == 2);
  CHECK(errors.accuracy().mean_eps == Approx(1.41421356));
}

TEST_CASE("stability: an error is divided by the condition of its quantity") {
  ErrorCollector errors;
  errors.add(1 + 0x1p-50, 1, 8);  // 4 eps of a quantity that multiplies its data's by 8
  CHECK(errors.accuracy().max_eps == 0.5);
}

TEST_CASE("stability: every row is inside its bound, and care buys figures where a naive form is named") {
  for (const StabilityRow& row : all_rows()) {
    INFO(row.group << ", " << row.quantity);
    CHECK(row.cases > 0);
    CHECK(row.within());
    CHECK(row.naive.has_value() == !row.naive_form.empty());
    // Where the pairs are still well apart the mean over all of them may come out nearer.
    if (row.group == "trees proportional to 1e-2") continue;
    if (row.naive) CHECK(row.naive->max_eps > row.ours.max_eps);
  }
}

TEST_CASE("stability: a row outside its bound is seen") {
  ErrorCollector errors, none;
  errors.add(1 + 0x1p-51, 1);  // 2 eps
  CHECK(make_row("g", "q", "", 2, errors, none).within());
  CHECK_FALSE(make_row("g", "q", "", 1, errors, none).within());
  const std::string page = stability_markdown({{"c", {make_row("g", "q", "", 1, errors, none)}}});
  CHECK(page.find("Max = 2 eps (Mean = 2 eps)<br>OUTSIDE its bound") != std::string::npos);
}

TEST_CASE("stability: the command prints its three forms and refuses a fourth") {
  const ProgramRun csv = run_program({"stability", "--format", "csv"});
  CHECK(csv.exit_code == 0);
  CHECK(csv.out == stability_csv(all_rows()));
  CHECK(run_program({"stability"}).out.starts_with("| hard cases | quantity | naive form | bound |"));
  CHECK(stability_html({{"c", all_rows()}}).starts_with("<!DOCTYPE html>"));
  CHECK(run_program({"stability", "--format", "xml"}).exit_code == 2);
  CHECK(run_program({"stability", "--format", "html", "--with-build"}).exit_code == 2);
}
