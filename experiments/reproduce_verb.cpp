// framesim reproduce: the papers' figures beside the simulator's.
#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <memory>

#include "experiments/gnuplot.h"
#include "experiments/options.h"
#include "experiments/output_file.h"
#include "experiments/reproduce/pictures.h"
#include "experiments/reproduce/reproduce.h"
#include "experiments/thread_pool.h"
#include "experiments/verbs.h"
#include "sim/check.h"
#include "sim/words.h"

namespace framesim {
namespace {

struct ReproduceOptions {
  std::string document;
  std::string format = std::string(kReproduceFormatNames[0]);
  std::string plot_folder;
  int jobs = default_jobs();
};

std::vector<std::string_view> allowed_documents() {
  std::vector<std::string_view> names;
  for (const ReproducedDocument& document : reproduced_documents()) names.push_back(document.name);
  names.push_back("all");
  return names;
}

ReproduceFormat read_reproduce_format(const std::string& text) {
  for (std::size_t i = 0; i < std::size(kReproduceFormatNames); ++i) {
    if (kReproduceFormatNames[i] == text) return static_cast<ReproduceFormat>(i);
  }
  throw UsageError(fmt::format("--format: {} is unknown; allowed: {}{}", framesim::quoted(text),
                               list_of(kReproduceFormatNames), did_you_mean(text, kReproduceFormatNames)));
}

// In `folder`, which exists. Tells on stderr what was written.
void draw_pictures(const ReproducedDocument& document, const ReproduceContext& context, const std::string& folder) {
  for (const std::string& path : write_pictures(reproduced_pictures(document, context), folder)) {
    if (!context.quiet) fmt::print(stderr, "wrote {}\n", path);
  }
}

void reproduce_documents(const ReproduceOptions& options, const Session& session) {
  const ReproduceFormat format = read_reproduce_format(options.format);
  const std::vector<std::string_view> names = allowed_documents();
  if (std::find(names.begin(), names.end(), options.document) == names.end()) {
    throw UsageError(fmt::format("there is no document {}; allowed: {}{}", framesim::quoted(options.document),
                                 list_of(names), did_you_mean(options.document, names)));
  }
  if (!options.plot_folder.empty()) {
    require_gnuplot();
    make_folder(options.plot_folder);
  }
  const ReproduceContext context{.jobs = options.jobs, .quiet = session.quiet};
  std::vector<Reproduction> parts;
  for (const ReproducedDocument& document : reproduced_documents()) {
    if (options.document != "all" && options.document != document.name) continue;
    parts.push_back(reproduce(document, context));
    if (!options.plot_folder.empty()) draw_pictures(document, context, options.plot_folder);
  }
  fmt::print("{}", format_reproduction(parts, format));
}

}  // namespace

void add_reproduce(CLI::App& app, Session& session) {
  CLI::App* verb = app.add_subcommand("reproduce", "Set the papers' figures beside the simulator's");
  const auto options = std::make_shared<ReproduceOptions>();
  verb->add_option("DOCUMENT", options->document, list_of(allowed_documents()))->type_name("")->required();
  verb->add_option("--format", options->format, "table (for people), csv or markdown")
      ->type_name("FORM")
      ->capture_default_str();
  verb->add_option("--plot", options->plot_folder,
                   "Write the papers' figures, from our runs (SVG), to this folder; needs gnuplot")
      ->type_name("DIR");
  add_jobs_option(*verb, options->jobs);
  add_quiet_option(*verb, session.quiet);
  verb->footer(
      "Each row: what was published, what was simulated, the difference, whether that is within its target, and the "
      "same "
      "scene under the policy certified.\n"
      "Examples:\n"
      "  framesim reproduce robin-hood\n"
      "  framesim reproduce dong --plot pictures\n"
      "  framesim reproduce all --format markdown");
  verb->callback([options, &session] { reproduce_documents(*options, session); });
}

}  // namespace framesim
