// framesim import: what others measured or made. `import capture` reads frame times, `import scene` geometry.
#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <memory>

#include "experiments/captures/report.h"
#include "experiments/options.h"
#include "experiments/output_file.h"
#include "experiments/verbs.h"
#include "scenes/importers/importer.h"
#include "sim/quantity.h"

namespace framesim {
namespace {

const InputLocation kCommandLine{"command line"};

struct CaptureOptions {
  std::string file, process, refresh, logic_out, format{kTableFormatNames[0]};
};

// The CPU work of the capture as an effect for a scene file. Throws InputError if a frame has none.
std::string logic_effect(const Capture& capture) {
  std::string times;
  for (const CaptureFrame& frame : capture.frames) {
    if (!frame.cpu_ms) throw InputError({capture.name, frame.line}, "--logic-out: the frame has no CPU work");
    times += fmt::format("{}{}", times.empty() ? "" : ":", *frame.cpu_ms);
  }
  return fmt::format("# CPU work of {} frames\n[[effect]]\nname = \"logic-times\"\ntimes = \"{}\"\n",
                     capture.frames.size(), times);
}

void import_capture(const CaptureOptions& options) {
  const double refresh_hz = options.refresh.empty() ? 0 : 1 / read_target_s(options.refresh, kCommandLine);
  if (!options.logic_out.empty()) check_writable(options.logic_out);
  const CaptureReport report = report_on(load_capture(options.file, options.process), refresh_hz);
  if (!options.logic_out.empty()) write_file(options.logic_out, logic_effect(report.capture));
  fmt::print("{}", format_capture(report, read_table_format(options.format)));
}

// "folder/scene.toml" is the folder "folder/" and the stem "scene".
void import_scene_file(const std::string& file, const std::string& output) {
  const std::size_t name = output.find_last_of('/') + 1;  // 0 if there is no folder
  std::string stem = output.substr(name);
  if (!output.empty() && (!stem.ends_with(".toml") || stem.size() == 5))
    throw InputError(kCommandLine, fmt::format("--output: '{}' does not end in .toml, as scene files do", output));
  if (!output.empty()) check_writable(output);
  const ImportedScene scene = import_scene(file);
  fmt::print("{}", describe(scene));
  if (output.empty()) return;
  stem.resize(stem.size() - 5);
  const SceneFiles files = write_scene(scene, stem);
  const std::string folder = output.substr(0, name);
  write_file(folder + files.instances_name, files.instances);
  if (!files.camera.empty()) write_file(folder + files.camera_name, files.camera);
  write_file(output, files.scene);
  fmt::print("wrote {} and {}{}\n", output, files.instances_name, files.camera.empty() ? "" : ", " + files.camera_name);
}

void add_scene(CLI::App& app) {
  CLI::App* verb = app.add_subcommand("scene", "A scene file from glTF 2.0 or 3D Tiles");
  const auto file = std::make_shared<std::string>(), output = std::make_shared<std::string>();
  verb->add_option("FILE", *file, ".gltf, .glb or tileset.json; what it refers to is read in and below its folder")
      ->type_name("")
      ->required();
  verb->add_option("--output,-o", *output,
                   "Write the scene to this file (.toml), its instances to a CSV file beside it; without, only say "
                   "what there is")
      ->type_name("FILE");
  verb->footer(
      "Counts and bounds come from accessors and headers; no mesh is read. The machine, the logic and, where no camera "
      "is\n"
      "animated, the camera's path are assumed: edit the scene file.\n"
      "Examples:\n"
      "  framesim import scene city/tileset.json -o city.toml\n"
      "  framesim run city.toml --policy funkhouser");
  verb->callback([file, output] { import_scene_file(*file, *output); });
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
  verb->add_option("--logic-out", options->logic_out,
                   "Write the frames' CPU work to this file as [[effect]] logic-times, to be put into a scene file")
      ->type_name("FILE");
  verb->add_option("--format", options->format, "table, csv, json or markdown")->type_name("")->capture_default_str();
  verb->footer(
      "Examples:\n"
      "  framesim import capture capture.csv\n"
      "  framesim import capture all-processes.csv --process game.exe --refresh 60Hz --format markdown");
  verb->callback([options] { import_capture(*options); });
}

}  // namespace

void add_import(CLI::App& app, Session&) {
  CLI::App* verb = app.add_subcommand("import", "Read what others measured or made: captures of frame times, scenes");
  verb->require_subcommand(1);
  verb->footer(
      "Examples:\n"
      "  framesim import capture capture.csv\n"
      "  framesim import scene model.glb --output model.toml");
  add_capture(*verb);
  add_scene(*verb);
}

}  // namespace framesim
