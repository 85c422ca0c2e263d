#include "scenes/scene_file.h"

#include <fmt/format.h>

#include <array>
#include <filesystem>
#include <numbers>

#include "scenes/machine_file.h"
#include "scenes/registry.h"
#include "scenes/scene_parameters.h"
#include "scenes/scene_parts.h"
#include "scenes/text_file.h"
#include "sim/effect.h"
#include "sim/words.h"

namespace framesim {
namespace {

constexpr std::string_view kTopKeys[] = {"framesim", "name",           "title",    "source",    "assumptions",
                                         "targets",  "parameters",     "screen",   "machine",   "logic",
                                         "type",     "representation", "instance", "instances", "generator",
                                         "camera",   "visibility",     "cell",     "portal",    "effect"};
// <filesystem> brings std::quoted in, which a std::string argument would find first: hence framesim::quoted below.
constexpr const char* kRootName = "the file";

Screen read_screen(const TableReader& root) {
  Screen screen;
  const TomlNode* node = root.table("screen");
  if (!node) return screen;
  const TableReader table(root.document(), *node, "[screen]", {"width", "height", "fov_y", "near", "far"});
  screen.width = static_cast<int>(table.whole("width", 1, 65'536, screen.width));
  screen.height = static_cast<int>(table.whole("height", 1, 65'536, screen.height));
  // Half a degree short of flat: the tangent of half the angle stays below 230. Divided first, as degrees are read, so
  // that '179.5deg' itself is allowed.
  const Range angles{0, 179.5 / 180 * std::numbers::pi, true};
  screen.fov_y_rad = table.angle_rad("fov_y", angles, screen.fov_y_rad);
  screen.near_m = table.length_m("near", kLength, screen.near_m);
  screen.far_m = table.length_m("far", kLength, screen.far_m);
  if (!(screen.near_m < screen.far_m)) {
    table.refuse("far", fmt::format("{} m is not beyond 'near', {} m", screen.far_m, screen.near_m));
  }
  return screen;
}

MachineProfile machine_in_use(const TableReader& table, const SceneFolder& folder) {
  const std::string use = table.text("use");
  if (use.find('/') == std::string::npos && !use.ends_with(".toml")) {
    return load_machine({.name = use, .settings = {}, .where = table.where("use")});
  }
  const std::string path = file_in_folder(table, "use", folder);
  if (const auto why = why_unreadable(path, kLargestSceneFile))
    table.refuse("use", fmt::format("cannot read '{}': {}", path, *why));
  return parse_machine(read_text_file(path, kLargestSceneFile), path);
}

MachineProfile read_scene_machine(const TableReader& root, const SceneFolder& folder) {
  const TomlNode* node = root.table("machine");
  if (!node) throw InputError(root.where(), "the file has no table [machine]");
  if (!find_member(*node->as_table(), "use")) return read_machine(root.document(), *node);
  return machine_in_use(TableReader(root.document(), *node, "[machine] with 'use'", {"use"}), folder);
}

LogicLoad read_logic(const TableReader& root) {
  LogicLoad logic;
  const TomlNode* node = root.table("logic");
  if (!node) return logic;
  const TableReader table(root.document(), *node, "[logic]", {"base", "per_item", "task"});
  logic.base_s = table.duration_s("base", kDuration, 0.0);
  logic.per_item_s = table.duration_s("per_item", kDuration, 0.0);
  for (const TomlNode* task_node : table.tables("task")) {
    const TableReader task(root.document(), *task_node, "[[logic.task]]", {"name", "time", "after"});
    logic.tasks.push_back({.name = task.identifier("name"),
                           .time_s = task.duration_s("time"),
                           .after = task.texts("after"),
                           .where = task.where("name")});
  }
  StageGraph{logic.tasks};  // checks names and cycles, at the task's place
  return logic;
}

std::vector<Spec> read_effects(const TableReader& root) {
  std::vector<Spec> specs;
  for (const TomlNode* node : root.tables("effect")) {
    const TableReader table(root.document(), *node, "[[effect]]", {});
    Spec spec{.name = table.text("name"), .settings = table.settings({"name"}), .where = table.where("name")};
    for (const Spec& other : specs) {
      if (other.name == spec.name)
        table.refuse("name", fmt::format("effect {} is there twice", framesim::quoted(spec.name)));
    }
    find_entry("effect", effects(), spec).make(spec.settings, 0);  // checks the settings
    specs.push_back(std::move(spec));
  }
  return specs;
}

void read_visibility(const TableReader& root, Scene& scene) {
  constexpr std::array<std::string_view, 3> kMethods = {"frustum", "portals", "cells"};
  const TomlNode* node = root.table("visibility");
  if (!node) return;
  const TableReader table(root.document(), *node, "[visibility]", {"method", "smallest_px", "flat_depth"});
  scene.visibility = static_cast<VisibilityMethod>(table.word("method", kMethods, 0));
  scene.smallest_px = table.number("smallest_px", {0, 1e9}, scene.smallest_px);
  scene.flat_depth = static_cast<int>(table.whole("flat_depth", 0, 32, scene.flat_depth));
  if (scene.visibility == VisibilityMethod::portals && scene.cells.empty()) {
    table.refuse("method", "'portals' needs cells: [[cell]] or a generator that makes them");
  }
  if (scene.visibility == VisibilityMethod::cells && scene.cell_visibility.seen.empty()) {
    table.refuse("method", "'cells' needs sampled cell visibility: a generator that makes it");
  }
}

SceneDescription read_description(const TableReader& root) {
  return {.name = root.identifier("name"),
          .title = root.text("title"),
          .source = root.text("source"),
          .assumptions = root.text("assumptions"),
          .parameters = list_parameters(root.document())};
}

// Whether `path`, all symbolic links followed, is `folder` or below it. What does not exist has no links.
bool is_below(const std::filesystem::path& path, const std::filesystem::path& folder) {
  std::error_code error;
  const std::filesystem::path from = std::filesystem::weakly_canonical(folder, error);
  if (error) return false;
  const std::filesystem::path to = std::filesystem::weakly_canonical(path, error);
  if (error) return false;
  const std::filesystem::path way = to.lexically_relative(from);
  return !way.empty() && *way.begin() != "..";
}

Scene read_scene(const TableReader& root, const SceneFolder& folder, const SceneLimits& limits) {
  SceneDescription description = read_description(root);
  Scene scene{.limits = limits};
  scene.name = std::move(description.name);
  scene.title = std::move(description.title);
  scene.source = std::move(description.source);
  scene.assumptions = std::move(description.assumptions);
  scene.targets_s = root.durations_s("targets", {0, 86'400, true});
  scene.screen = read_screen(root);
  scene.machine = read_scene_machine(root, folder);
  scene.logic = read_logic(root);
  scene.effects = read_effects(root);
  scene.camera = read_camera(root, folder);
  const TypeNames types = read_types(root, scene);
  const CellNames cells = read_cells(root, scene);
  read_portals(root, cells, scene);
  read_instances(root, folder, types, cells, scene);
  if (scene.types.empty()) throw InputError(root.where(), "the file has no [[type]], and no generator makes one");
  scene.view_levels.resize(scene.types.size());  // generators may have added types
  if (const auto why = missing_costs(scene, scene.machine)) throw InputError(root.where("machine"), *why);
  read_visibility(root, scene);
  return scene;
}

}  // namespace

void check_version(const TableReader& root) { root.whole("framesim", 1, 1); }

std::string file_in_folder(const TableReader& table, std::string_view key, const SceneFolder& folder) {
  namespace fs = std::filesystem;
  const std::string name = table.text(key);
  if (folder.path.empty())
    table.refuse(key, fmt::format("found {}; a built-in scene has no files beside it", framesim::quoted(name)));
  const fs::path path(name);
  const std::string whole = path.is_absolute() || folder.path == "." ? name : folder.path + "/" + name;
  if (folder.outside_paths) return whole;
  bool inside = path.is_relative();
  for (const fs::path& part : path) inside = inside && part != "..";
  if (!inside || name.find('\0') != std::string::npos || !is_below(whole, folder.path)) {
    table.refuse(key, fmt::format("{} leads out of the scene's folder; allowed: a file in or below it, or any with "
                                  "--allow-outside-paths",
                                  framesim::quoted(name)));
  }
  return whole;
}

Scene parse_scene(std::string_view text, const std::string& file, const std::string& folder, const Settings& settings,
                  const SceneLimits& limits) {
  TomlDocument document = parse_toml(text, file);
  check_version(TableReader(document, document.root, kRootName, kTopKeys));
  apply_parameters(document, settings);
  return read_scene(TableReader(document, document.root, kRootName, kTopKeys), {folder, limits.outside_paths}, limits);
}

SceneDescription describe_scene(std::string_view text, const std::string& file) {
  const TomlDocument document = parse_toml(text, file);
  const TableReader root(document, document.root, kRootName, kTopKeys);
  check_version(root);
  return read_description(root);
}

Scene load_scene_file(const std::string& path, const Settings& settings, const SceneLimits& limits) {
  const std::string text = read_text_file(path, kLargestSceneFile);
  const std::string folder = std::filesystem::path(path).parent_path().string();
  return parse_scene(text, path, folder.empty() ? "." : folder, settings, limits);
}

}  // namespace framesim
