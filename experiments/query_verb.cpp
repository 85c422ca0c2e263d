// framesim query: what is in a store.
#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <memory>

#include "experiments/cells.h"
#include "experiments/output_file.h"
#include "experiments/statistics/replicated.h"
#include "experiments/store/query.h"
#include "experiments/terminal.h"
#include "experiments/verbs.h"

namespace framesim {
namespace {

struct QueryOptions {
  std::string store, what, output;
  std::string format{kTableFormatNames[0]};
  bool statistics = false;
};

std::string statistics(const QueryOptions& options, const Store& store, TableFormat format) {
  if (!options.what.empty()) throw UsageError("--statistics takes all runs of the store and no WHAT");
  std::vector<RunResult> results;
  for (StoredRun& run : store.runs()) results.push_back(std::move(run.result));
  return format_replicated(group_seeds(results), format, {options.store});
}

void query(const QueryOptions& options) {
  const TableFormat format = read_table_format(options.format);
  if (!options.output.empty()) check_writable(options.output);
  Store store = Store::open(options.store);
  const bool color = options.output.empty() && wants_color(stdout);
  const std::string text =
      options.statistics ? statistics(options, store, format) : query_store(store, options.what, format, color);
  if (options.output.empty()) {
    fmt::print("{}", text);
  } else {
    write_file(options.output, text);
  }
}

}  // namespace

void add_query(CLI::App& app, Session&) {
  CLI::App* verb =
      app.add_subcommand("query", "Print what is in a store: the error table, a view, or any SQL that reads");
  const auto options = std::make_shared<QueryOptions>();
  verb->add_option("STORE", options->store, "A store that 'framesim sweep' or 'framesim merge' made")
      ->type_name("")
      ->required();
  verb->add_option("WHAT", options->what,
                   "error_table (default), runs, frames, manifests, inputs, progress, about, or an SQL statement")
      ->type_name("");
  verb->add_flag("--statistics", options->statistics,
                 "Compare the policies over the seeds: confidence intervals, paired differences to the best, tests");
  verb->add_option("--format", options->format, "table (for people), csv, json or markdown")
      ->type_name("NAME")
      ->capture_default_str();
  verb->add_option("--output,-o", options->output, "Write to this file instead of standard output")->type_name("FILE");
  verb->footer(
      "'framesim query STORE about' says what every view and column means. Plain sqlite3 reads a store too.\n"
      "The error table in csv is that of 'framesim compare --format csv' for the same runs, byte for byte.\n"
      "Examples:\n"
      "  framesim query results.sqlite\n"
      "  framesim query results.sqlite error_table --format csv -o table.csv\n"
      "  framesim query results.sqlite progress\n"
      "  framesim query results.sqlite --statistics\n"
      "  framesim query results.sqlite 'SELECT policy, avg(avg_err) FROM runs GROUP BY policy ORDER BY 2'");
  verb->callback([options] { query(*options); });
}

}  // namespace framesim
