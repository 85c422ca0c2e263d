// framesim check: did anything move against the golden tables?
#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <memory>

#include "experiments/golden.h"
#include "experiments/options.h"
#include "experiments/output_file.h"
#include "experiments/thread_pool.h"
#include "experiments/verbs.h"

namespace framesim {
namespace {

struct CheckOptions {
  std::string folder;
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

void check(const CheckOptions& options, Session& session) {
  std::size_t rows = 0, differences = 0, rewritten = 0;
  const std::vector<std::string> paths = find_golden_tables(options.folder);
  for (const std::string& path : paths) {
    const GoldenCheck table = check_golden_table(path, options.jobs, session.quiet);
    rows += table.rows;
    differences += table.differences.size();
    print_differences(table);
    std::fflush(stdout);
    if (!options.update || table.differences.empty()) continue;
    write_file(path, table.rerun);
    fmt::print("{}: rewritten\n", path);
    ++rewritten;
  }
  fmt::print("{} tables, {} rows: {} differences{}\n", paths.size(), rows, differences,
             options.update ? fmt::format(", {} tables rewritten", rewritten) : "");
  if (differences > 0 && !options.update) session.exit_code = 1;
}

}  // namespace

void add_check(CLI::App& app, Session& session) {
  CLI::App* verb =
      app.add_subcommand("check", "Rerun golden tables and list every difference; exit code 1 if there is one");
  const auto options = std::make_shared<CheckOptions>();
  verb->add_option("DIR", options->folder, "Folder with golden tables (*.csv)")->type_name("")->required();
  verb->add_flag("--update", options->update, "Rewrite the tables that differ, and end with exit code 0");
  add_jobs_option(*verb, options->jobs);
  add_quiet_option(*verb, session.quiet);
  verb->footer(
      "A golden table is what 'framesim compare --format csv' prints, below a line '# framesim compare ...' with the "
      "options\n"
      "it was made with. To make a new one, write that line into DIR/name.csv and run 'framesim check DIR --update'.\n"
      "Examples:\n"
      "  framesim check tests/golden\n"
      "  framesim check tests/golden --update");
  verb->callback([options, &session] { check(*options, session); });
}

}  // namespace framesim
