#include <fmt/format.h>

#include <array>
#include <cmath>
#include <glm/geometric.hpp>
#include <numbers>

#include "scenes/camera_path.h"
#include "scenes/csv.h"
#include "scenes/scene_parts.h"
#include "sim/words.h"

namespace framesim {
namespace {

enum Kind : std::size_t { kPolyline, kSpline, kTurn, kCsv };
constexpr std::array<std::string_view, 4> kKinds = {"polyline", "spline", "turn", "csv"};

std::vector<std::string_view> leg_keys(std::size_t kind) {
  if (kind == kTurn) return {"kind", "angle", "frames", "step"};
  if (kind == kCsv) return {"kind", "file"};
  return {"kind", "points", "frames", "step", "look_at"};
}

LegLength read_length(const TableReader& leg, bool turn) {
  if (leg.has("frames") == leg.has("step")) {
    throw InputError(leg.where(), fmt::format("{} needs either 'frames' or 'step'", leg.name()));
  }
  LegLength length;
  if (leg.has("frames")) length.frames = leg.whole("frames", 1, kMostFrames);
  if (leg.has("step")) {
    const Range circle{0, 2 * std::numbers::pi, true};
    length.step = turn ? leg.angle_rad("step", circle) : leg.length_m("step", kLength);
  }
  return length;
}

// Columns of a pose file, by position.
constexpr std::array<std::string_view, 7> kPoseColumns = {"t", "x", "y", "z", "fx", "fy", "fz"};

glm::dvec3 read_vector(const CsvReader& csv, std::size_t first) {
  glm::dvec3 vector;
  for (int axis = 0; axis < 3; ++axis) {
    const std::size_t column = first + static_cast<std::size_t>(axis);
    vector[axis] = csv.number(column);
    if (kCoordinate.holds(vector[axis])) continue;
    csv.refuse(column,
               fmt::format("{} is out of range; allowed: {}", quoted(csv.text(column)), to_string(kCoordinate)));
  }
  return vector;
}

void append_poses(std::vector<Pose>& poses, const TableReader& leg, const SceneFolder& folder) {
  const std::string path = file_in_folder(leg, "file", folder);
  CsvReader csv(path, path, kPoseColumns, {}, leg.where("file"));
  std::optional<double> last;
  while (csv.next()) {
    const double time = csv.number(0);
    if (last && !(time > *last)) csv.refuse(0, fmt::format("{} s is not after {} s in the row before", time, *last));
    last = time;
    const glm::dvec3 eye = read_vector(csv, 1), forward = read_vector(csv, 4);
    if (!(glm::length(forward) > 1e-9)) csv.refuse(4, "the view direction fx, fy, fz has length 0");
    if (poses.size() >= static_cast<std::size_t>(kMostFrames)) {
      csv.refuse(0, fmt::format("the camera path has more than {} frames", kMostFrames));
    }
    poses.push_back(make_pose(eye, forward));
  }
  if (!last) leg.refuse("file", fmt::format("{} has no poses", quoted(path)));
}

void append(std::vector<Pose>& poses, const TableReader& leg, std::size_t kind, const SceneFolder& folder) {
  if (kind == kCsv) return append_poses(poses, leg, folder);
  const LegLength length = read_length(leg, kind == kTurn);
  if (kind == kTurn) {
    const Range turns{-2000 * std::numbers::pi, 2000 * std::numbers::pi};
    return append_leg(poses, TurnLeg{.angle_rad = leg.angle_rad("angle", turns)}, length, leg.where());
  }
  const auto points = leg.points("points", 2);
  const auto look_at = leg.has("look_at") ? std::optional(leg.point("look_at")) : std::nullopt;
  const InputLocation where = leg.where("points");
  if (kind == kPolyline) return append_leg(poses, PolylineLeg{.points = points, .look_at = look_at}, length, where);
  append_leg(poses, SplineLeg{.points = points, .look_at = look_at}, length, where);
}

SceneCamera read_path(const TomlDocument& document, const TomlNode& node, const SceneFolder& folder) {
  const TableReader path(document, node, "[[camera.path]]", {"name", "leg"});
  SceneCamera camera{.name = path.identifier("name"), .poses = {}};
  for (const TomlNode* leg : path.tables("leg")) {
    const std::string name = "[[camera.path.leg]]";
    const TableReader any(document, *leg, name, {"kind", "points", "frames", "step", "look_at", "angle", "file"});
    const std::size_t kind = any.word("kind", kKinds);
    append(camera.poses,
           TableReader(document, *leg, fmt::format("{} of kind '{}'", name, kKinds[kind]), leg_keys(kind)), kind,
           folder);
  }
  if (camera.poses.empty())
    throw InputError(path.where(), fmt::format("path {} has no [[camera.path.leg]]", quoted(camera.name)));
  return camera;
}

}  // namespace

SceneCamera read_camera(const TableReader& root, const SceneFolder& folder) {
  const TomlNode* node = root.table("camera");
  if (!node) throw InputError(root.where(), "the file has no table [camera]");
  const TableReader table(root.document(), *node, "[camera]", {"use", "path"});
  const std::string used = table.has("use") ? table.text("use") : "";  // "": the first
  std::vector<SceneCamera> paths;
  for (const TomlNode* path : table.tables("path")) {
    paths.push_back(read_path(root.document(), *path, folder));
    // Checked, and dropped at once: a line of text may stand for kMostFrames poses.
    if (used.empty() ? paths.size() > 1 : paths.back().name != used) paths.back().poses = std::vector<Pose>();
    for (std::size_t i = 0; i + 1 < paths.size(); ++i) {
      if (paths[i].name != paths.back().name) continue;
      throw InputError(root.document().where(path->place),
                       fmt::format("there are two paths {}", quoted(paths[i].name)));
    }
  }
  if (paths.empty()) throw InputError(table.where(), "[camera] has no [[camera.path]]");
  if (!table.has("use")) return std::move(paths.front());
  std::vector<std::string_view> names;
  for (const SceneCamera& path : paths) names.push_back(path.name);
  return std::move(paths[table.word("use", names)]);
}

}  // namespace framesim
