// framesim tradeoff: what accuracy costs in time, as work-precision diagrams.
#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <memory>

#include "experiments/gnuplot.h"
#include "experiments/options.h"
#include "experiments/output_file.h"
#include "experiments/tradeoff/tradeoff.h"
#include "experiments/verbs.h"

namespace framesim {
namespace {

struct TradeoffOptions {
  std::string what, folder = "results/tradeoff";
  std::size_t most_items = 1'000'000;
};

void tradeoff(const TradeoffOptions& options, const Session& session) {
  require_gnuplot();
  make_folder(options.folder);
  const bool all = options.what == "all";
  std::vector<Tradeoff> parts;
  if (all || options.what == "decision") parts.push_back(tradeoff_decision(options.most_items, session.quiet));
  if (all || options.what == "estimate") parts.push_back(tradeoff_estimate(session.quiet));
  if (all || options.what == "simulation") parts.push_back(tradeoff_simulation(session.quiet));
  std::vector<std::string> written;
  for (const Tradeoff& part : parts) {
    for (const WorkDiagram& diagram : part.diagrams) {
      for (std::string& path : write_diagram(diagram, options.folder)) written.push_back(std::move(path));
    }
  }
  const std::string page = options.folder + "/tradeoff.md";
  const std::string size = options.most_items == 1'000'000 ? "" : fmt::format(" --items {}", options.most_items);
  write_file(page, tradeoff_page(parts, fmt::format("framesim tradeoff {}{}", options.what, size)));
  written.push_back(page);
  for (const std::string& path : written) fmt::print("{}\n", path);
}

}  // namespace

void add_tradeoff(CLI::App& app, Session& session) {
  CLI::App* verb = app.add_subcommand("tradeoff", "Draw what accuracy costs in time: work-precision diagrams");
  const auto options = std::make_shared<TradeoffOptions>();
  verb->add_option("WHAT", options->what, "decision, estimate, simulation or all")
      ->type_name("")
      ->required()
      ->check(CLI::IsMember({"decision", "estimate", "simulation", "all"}));
  verb->add_option("--out", options->folder, "Folder for the page (tradeoff.md), pictures (SVG) and data (CSV)")
      ->type_name("DIR")
      ->capture_default_str();
  verb->add_option("--items", options->most_items, "Decision: largest workload, 100 to 10000000 items")
      ->type_name("N")
      ->check(CLI::Validator(CLI::Range(100, 10'000'000)).description(""))
      ->capture_default_str();
  add_quiet_option(*verb, session.quiet);
  verb->footer(
      "Prints the paths of what it wrote; begin with tradeoff.md. All takes some minutes.\n"
      "Examples:\n"
      "  framesim tradeoff all\n"
      "  framesim tradeoff decision --items 10000 --out pictures");
  verb->callback([options, &session] { tradeoff(*options, session); });
}

}  // namespace framesim
