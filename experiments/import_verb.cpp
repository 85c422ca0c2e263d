// framesim import: what others measured or made. `import capture` reads frame times.
#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <memory>

#include "experiments/captures/report.h"
#include "experiments/options.h"
#include "experiments/verbs.h"
#include "sim/quantity.h"

namespace framesim {
namespace {

const InputLocation kCommandLine{"command line"};

struct CaptureOptions {
  std::string file, process, refresh, format{kTableFormatNames[0]};
};

void import_capture(const CaptureOptions& options) {
  const double refresh_hz = options.refresh.empty() ? 0 : 1 / read_target_s(options.refresh, kCommandLine);
  const CaptureReport report = report_on(load_capture(options.file, options.process), refresh_hz);
  fmt::print("{}", format_capture(report, read_table_format(options.format)));
}

void add_capture(CLI::App& app) {
  CLI::App* verb = app.add_subcommand("capture", "Measures of frame times from PresentMon, OCAT or CapFrameX");
  const auto options = std::make_shared<CaptureOptions>();
  verb->add_option("FILE", options->file, "Capture (CSV); columns are found by name")->type_name("")->required();
  verb->add_option("--process", options->process,
                   "Application to take, of several in one file (default: that of the swap chain with most frames)")
      ->type_name("NAME");
  verb->add_option(
          "--refresh", options->refresh,
          "Refresh rate or period of the display, for missed blanks (default: found from the times on the screen)")
      ->type_name("RATE");
  verb->add_option("--format", options->format, "table, csv, json or markdown")->type_name("")->capture_default_str();
  verb->footer(
      "Examples:\n"
      "  framesim import capture capture.csv\n"
      "  framesim import capture all-processes.csv --process game.exe --refresh 60Hz --format markdown");
  verb->callback([options] { import_capture(*options); });
}

}  // namespace

void add_import(CLI::App& app, Session&) {
  CLI::App* verb = app.add_subcommand("import", "Read what others measured: captures of frame times");
  verb->require_subcommand(1);
  verb->footer(
      "Examples:\n"
      "  framesim import capture capture.csv");
  add_capture(*verb);
}

}  // namespace framesim
