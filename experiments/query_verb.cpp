// framesim query: what is in a store.
#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <memory>

#include "experiments/output_file.h"
#include "experiments/store/query.h"
#include "experiments/terminal.h"
#include "experiments/verbs.h"

namespace framesim {
namespace {

struct QueryOptions {
  std::string store, what, output;
  std::string format{kTableFormatNames[0]};
};

TableFormat format_named(const std::string& name) {
  std::size_t at = 0;
  while (kTableFormatNames[at] != name) ++at;  // CLI11 has checked it
  return static_cast<TableFormat>(at);
}

void query(const QueryOptions& options) {
  if (!options.output.empty()) check_writable(options.output);
  Store store = Store::open(options.store);
  const bool color = options.output.empty() && wants_color(stdout);
  const std::string text = query_store(store, options.what, format_named(options.format), color);
  if (options.output.empty()) {
    fmt::print("{}", text);
  } else {
    write_file(options.output, text);
  }
}

}  // namespace

void add_query(CLI::App& app, Session&) {
  CLI::App* verb = app.add_subcommand("query", "Print what is in a store: the error table, a view, or any SQL that reads");
  const auto options = std::make_shared<QueryOptions>();
  verb->add_option("STORE", options->store, "A store that 'framesim sweep' or 'framesim merge' made")
      ->type_name("")
      ->required();
  verb->add_option("WHAT", options->what,
                   "error_table (default), runs, frames, manifests, inputs, progress, about, or an SQL statement")
      ->type_name("");
  const std::vector<std::string> formats(std::begin(kTableFormatNames), std::end(kTableFormatNames));
  verb->add_option("--format", options->format, "table (for people), csv, json or markdown")
      ->type_name("NAME")
      ->check(CLI::Validator(CLI::IsMember(formats)).description(""))
      ->capture_default_str();
  verb->add_option("--output,-o", options->output, "Write to this file instead of standard output")->type_name("FILE");
  verb->footer(
      "'framesim query STORE about' says what every view and column means. Plain sqlite3 reads a store too.\n"
      "The error table in csv is that of 'framesim compare --format csv' for the same runs, byte for byte.\n"
      "Examples:\n"
      "  framesim query results.sqlite\n"
      "  framesim query results.sqlite error_table --format csv -o table.csv\n"
      "  framesim query results.sqlite progress\n"
      "  framesim query results.sqlite 'SELECT policy, avg(avg_err) FROM runs GROUP BY policy ORDER BY 2'");
  verb->callback([options] { query(*options); });
}

}  // namespace framesim
