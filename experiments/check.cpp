// framesim check: did anything move against the golden tables?
#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <memory>

#include "experiments/csv_row.h"
#include "experiments/golden.h"
#include "experiments/junit.h"
#include "experiments/options.h"
#include "experiments/output_file.h"
#include "experiments/thread_pool.h"
#include "experiments/verbs.h"

namespace framesim {
namespace {

struct CheckOptions {
  std::string folder, junit;
  bool update = false;
  int jobs = default_jobs();
};

void print_differences(const GoldenCheck& table) {
  if (table.is_new) {
    fmt::print("{}: has no rows yet, {} are due\n", table.path, table.rows);
    return;
  }
  for (const Difference& d : table.differences) {
    fmt::print("{}: scene {}, policy {}, target {} s, {}: expected {}, found {}\n", table.path, d.scene, d.policy,
               d.target, d.column, d.expected, d.found);
  }
}

std::string show(const Difference& d) {
  return fmt::format("{}: expected {}, found {}", d.column, d.expected, d.found);
}

std::string row_name(const std::string& scene, const std::string& policy, const std::string& target) {
  return fmt::format("{}, {}, {} s", scene, policy, target);
}

// A case for each row of the rerun, and one for each row that is there no more.
CheckedSuite suite_of(const GoldenCheck& table) {
  CheckedSuite suite{table.path, {}};
  const auto place = [&](const std::string& name) -> CheckedCase& {
    const auto at =
        std::find_if(suite.cases.begin(), suite.cases.end(), [&](const CheckedCase& c) { return c.name == name; });
    return at == suite.cases.end() ? suite.cases.emplace_back(CheckedCase{name, {}}) : *at;
  };
  std::size_t line = 0;
  for (std::size_t begin = 0; begin < table.rerun.size(); ++line) {
    const std::size_t end = std::min(table.rerun.find('\n', begin), table.rerun.size());
    // First how the table was made, then the heading: scene, policy, target_s, ...
    if (line >= 2) {
      const auto fields = split_csv_row(std::string_view(table.rerun).substr(begin, end - begin));
      CheckedCase& row = place(row_name(fields[0], fields[1], fields[2]));
      if (table.is_new) row.failures.push_back("the table has no rows yet");
    }
    begin = end + 1;
  }
  if (table.is_new) return suite;
  for (const Difference& d : table.differences)
    place(row_name(d.scene, d.policy, d.target)).failures.push_back(show(d));
  return suite;
}

void check(const CheckOptions& options, Session& session) {
  if (!options.junit.empty()) check_writable(options.junit);
  std::vector<CheckedSuite> suites;
  std::size_t rows = 0, differences = 0, rewritten = 0;
  const std::vector<std::string> paths = find_golden_tables(options.folder);
  for (const std::string& path : paths) {
    const GoldenCheck table = check_golden_table(path, options.jobs, session.quiet);
    rows += table.rows;
    differences += table.differences.size();
    suites.push_back(suite_of(table));
    print_differences(table);
    std::fflush(stdout);
    if (!options.update || table.differences.empty()) continue;
    write_file(path, table.rerun);
    fmt::print("{}: rewritten\n", path);
    ++rewritten;
  }
  const std::string verdict = fmt::format("{} tables, {} rows: {} differences{}", paths.size(), rows, differences,
                                          options.update ? fmt::format(", {} tables rewritten", rewritten) : "");
  fmt::print("{}\n", verdict);
  if (!options.junit.empty()) write_file(options.junit, junit_xml(suites));
  append_step_summary(markdown_summary("framesim check: " + verdict, suites));
  if (differences > 0 && !options.update) session.exit_code = 1;
}

}  // namespace

void add_check(CLI::App& app, Session& session) {
  CLI::App* verb =
      app.add_subcommand("check", "Rerun golden tables and list every difference; exit code 1 if there is one");
  const auto options = std::make_shared<CheckOptions>();
  verb->add_option("DIR", options->folder, "Folder with golden tables (*.csv)")->type_name("")->required();
  verb->add_flag("--update", options->update, "Rewrite the tables that differ, and end with exit code 0");
  verb->add_option("--junit", options->junit, "Write JUnit XML: a suite for each table, a case for each row")
      ->type_name("FILE");
  add_jobs_option(*verb, options->jobs);
  add_quiet_option(*verb, session.quiet);
  verb->footer(
      "A golden table is what 'framesim compare --format csv' prints, below a line '# framesim compare ...' with the "
      "options\n"
      "it was made with. To make a new one, write that line into DIR/name.csv and run 'framesim check DIR --update'.\n"
      "Where the environment variable GITHUB_STEP_SUMMARY names a file, a summary (Markdown) is added to it.\n"
      "Examples:\n"
      "  framesim check tests/golden --junit report.xml\n"
      "  framesim check tests/golden\n"
      "  framesim check tests/golden --update");
  verb->callback([options, &session] { check(*options, session); });
}

}  // namespace framesim
