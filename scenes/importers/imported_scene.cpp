#include "scenes/importers/imported_scene.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>

#include "scenes/scene_file.h"
#include "scenes/table_reader.h"
#include "sim/words.h"

namespace framesim {

ImportedFacts& ImportedFacts::operator+=(const ImportedFacts& other) {
  polygons += other.polygons;
  vertices += other.vertices;
  lines += other.lines;
  points += other.points;
  draws += other.draws;
  return *this;
}

ImportedFacts ImportedFacts::times(std::size_t n) const {
  const auto k = static_cast<double>(n);
  return {k * polygons, k * vertices, k * lines, k * points, k * draws};
}

std::string legal_name(const std::string& text) {
  std::string name;
  for (const char c : text.substr(0, 40)) {
    const bool legal =
        (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || (c >= '0' && c <= '9') || c == '_' || c == '.';
    if (legal) name += c;
    if (!legal && !name.empty() && name.back() != '-') name += '-';
  }
  while (!name.empty() && name.back() == '-') name.pop_back();
  return name.empty() ? "unnamed" : name;
}

std::size_t ImportedScene::type(const std::string& name, double radius_m, double area_m2,
                                std::vector<ImportedFacts> levels) {
  const std::size_t given = levels.size();
  std::erase_if(levels, [](const ImportedFacts& f) { return f.primitives() <= 0; });
  if (levels.size() < given) note("levels without anything to draw are left out");
  const auto fewer = [](const ImportedFacts& a, const ImportedFacts& b) { return a.primitives() < b.primitives(); };
  if (!std::is_sorted(levels.begin(), levels.end(), fewer)) {
    std::stable_sort(levels.begin(), levels.end(), fewer);
    note("levels are put in order of their primitives");
  }
  std::string key = fmt::format("{} {}", radius_m, area_m2);
  for (const ImportedFacts& f : levels)
    key += fmt::format("; {} {} {} {} {}", f.polygons, f.vertices, f.lines, f.points, f.draws);
  const auto [known, is_new] = known_.try_emplace(std::move(key), types.size());
  if (!is_new) return known->second;
  std::string unique = legal_name(name);
  if (const long before = names_[unique]++; before > 0) unique += fmt::format("-{}", before + 1);
  ++names_[unique];
  types.push_back({std::move(unique), radius_m, area_m2, std::move(levels)});
  return types.size() - 1;
}

namespace {

std::string toml_text(const std::string& text) {
  std::string out = "\"";
  for (const char c : text) {
    if (c == '"' || c == '\\') out += '\\';
    out += static_cast<unsigned char>(c) < 0x20 || c == 0x7f ? ' ' : c;
  }
  return out + '"';
}

std::string assumptions(const ImportedScene& scene) {
  std::string text = "machine, logic and targets are not in such files: assumed";
  if (scene.poses.empty()) text += "; so is the camera's path";
  for (const auto& [note, count] : scene.notes()) text += "; " + note;
  return text;
}

std::string level_toml(const ImportedFacts& f) {
  std::string text = fmt::format("{{ polygons = {}, vertices = {}", f.polygons, f.vertices);
  if (f.lines > 0) text += fmt::format(", lines = {}", f.lines);
  if (f.points > 0) text += fmt::format(", points = {}", f.points);
  return text + fmt::format(", draws = {} }}", std::max(1.0, f.draws));
}

std::string type_toml(const ImportedType& type) {
  std::string text = fmt::format("\n[[type]]\nname = \"{}\"\nradius = \"{}m\"\narea = {}\nlevel = [", type.name,
                                 type.radius_m, type.area_m2);
  for (std::size_t l = 0; l < type.levels.size(); ++l)
    text += (l > 0 ? ",\n         " : "") + level_toml(type.levels[l]);
  return text + "]\n";
}

struct Sphere {
  glm::dvec3 centre{0};
  double radius_m = 1;
};

// Around all instances, not the smallest.
Sphere around(const ImportedScene& scene) {
  glm::dvec3 low(1e300), high(-1e300);
  for (const ImportedInstance& i : scene.instances) {
    const double radius = scene.types[i.type].radius_m * i.scale;
    low = glm::min(low, i.centre - radius);
    high = glm::max(high, i.centre + radius);
  }
  return {(low + high) / 2.0, std::max(glm::length(high - low) / 2, 1e-3)};
}

// From twice the scene's radius away through its middle, at an eye's height of an eighth of it, looking ahead.
std::string assumed_path(const ImportedScene& scene) {
  const Sphere s = around(scene);
  const auto point = [&](double along) {
    const glm::dvec3 eye = s.centre + s.radius_m * glm::dvec3(0, 0.125, along);
    check_coordinates(scene, "the assumed path of the camera leads to", eye);
    return fmt::format("[{}, {}, {}]", eye.x, eye.y, eye.z);
  };
  return fmt::format(
      "leg = [{{ kind = \"polyline\", points = [{}, {}], frames = 240 }},\n"
      "       {{ kind = \"turn\", angle = \"360deg\", frames = 120 }}]\n",
      point(2), point(0));
}

std::string camera_csv(const std::vector<Pose>& poses) {
  std::string text = "t,x,y,z,fx,fy,fz\n";
  for (std::size_t i = 0; i < poses.size(); ++i) {
    const glm::dvec3 &e = poses[i].eye, &f = poses[i].forward;
    text += fmt::format("{},{},{},{},{},{},{}\n", static_cast<double>(i) / 30, e.x, e.y, e.z, f.x, f.y, f.z);
  }
  return text;
}

}  // namespace

SceneFiles write_scene(const ImportedScene& scene, const std::string& stem) {
  check_scene_limits(scene);
  SceneFiles files;
  files.instances_name = stem + "-instances.csv";
  const Sphere s = around(scene);
  if (!(s.radius_m <= kLargestLength))
    throw InputError({scene.title}, fmt::format("a scene of {} m; allowed: up to {} m", s.radius_m, kLargestLength));
  std::string& toml = files.scene;
  toml = fmt::format(
      "framesim = 1\nname = \"{}\"\ntitle = {}\nsource = {}\nassumptions = {}\ntargets = [\"16ms\", \"33ms\"]\n",
      legal_name(stem), toml_text(scene.title), toml_text(scene.source), toml_text(assumptions(scene)));
  const double near = std::max(s.radius_m * 1e-4, 1e-6), far = std::min(s.radius_m * 1e2, 1e9);
  toml += fmt::format("\n[screen]\nwidth = 1280\nheight = 720\nfov_y = \"{}rad\"\nnear = \"{}m\"\nfar = \"{}m\"\n",
                      scene.fov_y_rad.value_or(1.0471975511965976), near, far);
  toml += "\n[machine]\nuse = \"desktop2020\"\n\n[logic]\nbase = \"2ms\"\n";
  for (const ImportedType& type : scene.types) toml += type_toml(type);
  toml += fmt::format("\n[instances]\ncsv = {}\n", toml_text(files.instances_name));
  toml += "\n[camera]\n[[camera.path]]\nname = \"imported\"\n";
  if (scene.poses.empty()) {
    toml += assumed_path(scene);
  } else {
    files.camera_name = stem + "-camera.csv";
    files.camera = camera_csv(scene.poses);
    toml += fmt::format("leg = [{{ kind = \"csv\", file = {} }}]\n", toml_text(files.camera_name));
  }
  files.instances = "type,x,y,z,scale\n";
  for (const ImportedInstance& i : scene.instances) {
    files.instances +=
        fmt::format("{},{},{},{},{}\n", scene.types[i.type].name, i.centre.x, i.centre.y, i.centre.z, i.scale);
  }
  return files;
}

std::string describe(const ImportedScene& scene) {
  std::string text = fmt::format("{}: {}\n", scene.format, scene.title);
  text += fmt::format("{} types, {} instances; camera: {}\n", scene.types.size(), scene.instances.size(),
                      scene.poses.empty() ? "assumed" : fmt::format("{} frames", scene.poses.size()));
  constexpr std::size_t kShown = 20;
  std::vector<long> count(scene.types.size());
  for (const ImportedInstance& i : scene.instances) ++count[i.type];
  for (std::size_t t = 0; t < std::min(kShown, scene.types.size()); ++t) {
    const ImportedType& type = scene.types[t];
    text += fmt::format("  {:<24} {:>7} x, radius {:.4g} m, primitives", type.name, count[t], type.radius_m);
    for (const ImportedFacts& f : type.levels) text += fmt::format(" {}", f.primitives());
    text += '\n';
  }
  if (scene.types.size() > kShown) text += fmt::format("  ... and {} more\n", scene.types.size() - kShown);
  for (const auto& [note, times] : scene.notes())
    text += fmt::format("note: {}{}\n", note, times > 1 ? fmt::format(" ({} times)", times) : "");
  return text;
}

}  // namespace framesim
