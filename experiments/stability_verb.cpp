// framesim stability: how exact the formulas are on hard cases, beside their naive forms.
#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <memory>

#include "experiments/options.h"
#include "experiments/stability/report.h"
#include "experiments/verbs.h"
#include "sim/check.h"

namespace framesim {
namespace {

struct StabilityOptions {
  std::string format{"markdown"};
  bool with_build = false;
  std::vector<std::string> merge;
};

std::string table(const StabilityOptions& options, const std::vector<StabilityColumn>& columns) {
  if (options.format == "markdown") return stability_markdown(columns);
  if (options.format == "html") return stability_html(columns);
  if (!options.merge.empty()) return merged_stability_csv(columns);
  return options.with_build ? named_stability_csv(columns.front()) : stability_csv(columns.front().rows);
}

// What is wrong, one line each; true if nothing is.
bool complain_of_rows(const std::vector<StabilityColumn>& columns) {
  bool good = true;
  for (const StabilityColumn& column : columns) {
    const std::string build = columns.size() > 1 ? column.compiler + ": " : "";
    for (const StabilityRow& row : column.rows) {
      if (row.within()) continue;
      fmt::print(stderr, "framesim: {}{}, {}: {} eps, bound {} eps\n", build, row.group, row.quantity, row.ours.max_eps,
                 row.bound_eps);
      good = false;
    }
  }
  for (const std::string& row : differing_rows(columns)) {
    fmt::print(stderr, "framesim: the builds differ in: {}\n", row);
    good = false;
  }
  return good;
}

void stability(const StabilityOptions& options, Session& session) {
  if (options.with_build && (options.format != "csv" || !options.merge.empty())) {
    throw UsageError("--with-build: only for '--format csv' of this build; all other forms name builds in any case");
  }
  const std::vector<StabilityColumn> columns = options.merge.empty()
                                                   ? std::vector<StabilityColumn>{{this_compiler(), stability_rows()}}
                                                   : read_stability_csvs(options.merge);
  fmt::print("{}", table(options, columns));
  std::fflush(stdout);
  if (!complain_of_rows(columns)) session.exit_code = 1;
}

}  // namespace

void add_stability(CLI::App& app, Session& session) {
  CLI::App* verb = app.add_subcommand(
      "stability", "Errors of the formulas on hard cases against 50 digits; exit code 1 if one is outside its bound");
  const auto options = std::make_shared<StabilityOptions>();
  verb->add_option("--format", options->format, "markdown, csv or html")
      ->type_name("FORMAT")
      ->check(CLI::Validator(CLI::IsMember({"markdown", "csv", "html"})).description(""))
      ->capture_default_str();
  verb->add_flag("--with-build", options->with_build, "Begin csv with a line that names compiler and optimisation");
  verb->add_option(
          "--merge", options->merge,
          "Nothing is computed: the csv of several builds as one table, a column each; exit code 1 also if they "
          "differ in a number")
      ->type_name("FILE.csv...");
  add_quiet_option(*verb, session.quiet);
  verb->footer(
      "Without --with-build csv has no compiler in it: what two builds print is compared with cmp, and\n"
      "--merge calls each column as its file.\n"
      "Examples:\n"
      "  framesim stability\n"
      "  framesim stability --format csv --with-build > g++.csv\n"
      "  framesim stability --merge g++.csv clang++.csv");
  verb->callback([options, &session] { stability(*options, session); });
}

}  // namespace framesim
