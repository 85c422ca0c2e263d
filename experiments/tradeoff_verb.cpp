// framesim tradeoff: what accuracy costs in time, as work-precision diagrams.
#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <memory>

#include "experiments/gnuplot.h"
#include "experiments/options.h"
#include "experiments/output_file.h"
#include "experiments/tradeoff/tradeoff.h"
#include "experiments/verbs.h"
#include "scenes/registry.h"

namespace framesim {
namespace {

struct TradeoffOptions {
  std::string what, folder = "results/tradeoff", frames = "all";
  std::vector<std::string> scenes;
  std::size_t most_items = 1'000'000;
};

// How to get the same again.
std::string command_of(const TradeoffOptions& options) {
  std::string command = "framesim tradeoff " + options.what;
  if (!options.scenes.empty()) command += fmt::format(" --scenes {}", fmt::join(options.scenes, ","));
  if (options.most_items != TradeoffScope{}.most_items) command += fmt::format(" --items {}", options.most_items);
  if (options.frames != "all") command += fmt::format(" --frames {}", options.frames);
  return command;
}

void tradeoff(const TradeoffOptions& options, const Session& session) {
  const InputLocation where{"command line"};
  TradeoffScope scope{.scenes = options.scenes.empty() ? all_scenes() : read_specs(options.scenes, where),
                      .most_items = options.most_items,
                      .frames = read_frames(options.frames, where),
                      .quiet = session.quiet};
  for (const Spec& scene : scope.scenes) load_scene(scene);  // whatever is wrong is said before anything is run
  require_gnuplot();
  make_folder(options.folder);
  const bool all = options.what == "all";
  std::vector<Tradeoff> parts;
  if (all || options.what == "decision") parts.push_back(tradeoff_decision(scope));
  if (all || options.what == "estimate") parts.push_back(tradeoff_estimate(scope));
  if (all || options.what == "simulation") parts.push_back(tradeoff_simulation(scope));
  std::vector<std::string> written;
  for (const Tradeoff& part : parts) {
    for (const WorkDiagram& diagram : part.diagrams) {
      for (std::string& path : write_diagram(diagram, options.folder)) written.push_back(std::move(path));
    }
  }
  const std::string page = options.folder + "/tradeoff.md";
  write_file(page, tradeoff_page(parts, command_of(options)));
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
  verb->add_option("--scenes", options->scenes,
                   "Scenes, separated by commas: names from 'framesim list scenes' or scene files, with parameters as "
                   "name:key=value,key=value (default: all built-in ones)")
      ->type_name("LIST")
      ->allow_extra_args(false);
  verb->add_option("--frames", options->frames, "Estimate and simulation: at most N frames of each camera path, or all")
      ->type_name("N")
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
      "  framesim tradeoff decision --items 10000 --out pictures\n"
      "  framesim tradeoff all --scenes my/scene.toml --frames 200");
  verb->callback([options, &session] { tradeoff(*options, session); });
}

}  // namespace framesim
