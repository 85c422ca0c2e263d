#include "scenes/importers/gltf_camera.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>

#include "scenes/camera_path.h"
#include "sim/words.h"

namespace framesim {
namespace {

enum class Way { step, linear, cubic };

// One animated property of a node.
struct Channel {
  std::size_t node = 0;
  std::string path;
  Way way = Way::linear;
  std::vector<double> times, values;  // cubic: tangent in, value, tangent out for each time
};

using Values = std::array<double, 4>;

Values key_value(const Channel& c, std::size_t key, std::size_t part, std::size_t width) {
  const std::size_t per_key = c.way == Way::cubic ? 3 : 1;
  Values v{};
  for (std::size_t i = 0; i < width; ++i) v[i] = c.values[(key * per_key + part) * width + i];
  return v;
}

Values hermite(const Channel& c, std::size_t key, double t, double length, std::size_t width) {
  const Values p0 = key_value(c, key, 1, width), m0 = key_value(c, key, 2, width);
  const Values p1 = key_value(c, key + 1, 1, width), m1 = key_value(c, key + 1, 0, width);
  const double t2 = t * t, t3 = t2 * t;
  Values v{};
  for (std::size_t i = 0; i < width; ++i) {
    v[i] = (2 * t3 - 3 * t2 + 1) * p0[i] + length * (t3 - 2 * t2 + t) * m0[i] + (3 * t2 - 2 * t3) * p1[i] +
           length * (t3 - t2) * m1[i];
  }
  return v;
}

glm::dquat quaternion(const Values& v) { return glm::dquat(v[3], v[0], v[1], v[2]); }

Values sample(const Channel& c, double time) {
  const std::size_t width = c.path == "rotation" ? 4 : 3, middle = c.way == Way::cubic ? 1 : 0;
  if (time <= c.times.front()) return key_value(c, 0, middle, width);
  if (time >= c.times.back()) return key_value(c, c.times.size() - 1, middle, width);
  const auto after = std::upper_bound(c.times.begin(), c.times.end(), time);
  const auto key = static_cast<std::size_t>(after - c.times.begin()) - 1;
  const double length = c.times[key + 1] - c.times[key], t = (time - c.times[key]) / length;
  if (c.way == Way::step) return key_value(c, key, 0, width);
  if (c.way == Way::cubic) return hermite(c, key, t, length, width);
  const Values a = key_value(c, key, 0, width), b = key_value(c, key + 1, 0, width);
  if (width == 4) {
    const glm::dquat q = glm::slerp(quaternion(a), quaternion(b), t);
    return {q.x, q.y, q.z, q.w};
  }
  Values v{};
  for (std::size_t i = 0; i < width; ++i) v[i] = a[i] + t * (b[i] - a[i]);
  return v;
}

Channel read_channel(GltfDocument& document, const JsonValue& animation, const JsonValue& channel, std::size_t node) {
  Channel c{.node = node, .path = channel.need("target").need("path").text()};
  const JsonValue samplers = animation.need("samplers");
  const JsonValue sampler = samplers.at(channel.need("sampler").index(samplers.size(), "samplers"));
  if (const auto way = sampler.find("interpolation")) {
    if (way->text() == "STEP")
      c.way = Way::step;
    else if (way->text() == "CUBICSPLINE")
      c.way = Way::cubic;
    else if (way->text() != "LINEAR")
      way->refuse(fmt::format("found {}; expected LINEAR, STEP or CUBICSPLINE", framesim::quoted(way->text())));
  }
  c.times = document.values(sampler.need("input"), "SCALAR");
  for (std::size_t i = 1; i < c.times.size(); ++i) {
    if (!(c.times[i] > c.times[i - 1]))
      sampler.need("input").refuse(fmt::format("time {} s is not after {} s", c.times[i], c.times[i - 1]));
  }
  c.values = document.values(sampler.need("output"), c.path == "rotation" ? "VEC4" : "VEC3");
  const std::size_t wanted = c.times.size() * (c.way == Way::cubic ? 3 : 1) * (c.path == "rotation" ? 4 : 3);
  if (c.values.size() != wanted)
    sampler.need("output").refuse(
        fmt::format("has {} numbers for {} times; expected {}", c.values.size(), c.times.size(), wanted));
  return c;
}

// The channels that move one of `chain`, of all animations.
std::vector<Channel> channels_of(GltfDocument& document, const std::vector<std::size_t>& chain, std::size_t nodes) {
  std::vector<Channel> channels;
  for (std::size_t a = 0; a < document.count("animations"); ++a) {
    const JsonValue animation = document.element("animations", a);
    const JsonValue list = animation.need("channels");
    for (std::size_t c = 0; c < list.size(); ++c) {
      const auto target = list.at(c).need("target").find("node");
      if (!target) continue;
      const std::size_t node = target->index(nodes, "nodes");
      const std::string& path = list.at(c).need("target").need("path").text();
      const bool moves = path == "translation" || path == "rotation" || path == "scale";
      if (moves && std::find(chain.begin(), chain.end(), node) != chain.end())
        channels.push_back(read_channel(document, animation, list.at(c), node));
    }
  }
  return channels;
}

glm::dmat4 world_at(const std::vector<GltfNode>& nodes, const std::vector<std::size_t>& chain,
                    const std::vector<Channel>& channels, double time) {
  glm::dmat4 world(1);
  for (const std::size_t node : chain) {  // from the root down
    GltfTransform parts = nodes[node].parts;
    bool moved = false;
    for (const Channel& c : channels) {
      if (c.node != node) continue;
      const Values v = sample(c, time);
      moved = true;
      if (c.path == "translation") parts.translation = {v[0], v[1], v[2]};
      if (c.path == "scale") parts.scale = {v[0], v[1], v[2]};
      const glm::dquat q = quaternion(v);
      if (c.path == "rotation" && glm::length(q) > 1e-9) parts.rotation = glm::normalize(q);
    }
    world = world * (moved ? parts.matrix() : nodes[node].local);
  }
  return world;
}

}  // namespace

void read_gltf_camera(GltfDocument& document, const std::vector<GltfNode>& nodes, ImportedScene& scene) {
  for (std::size_t i = 0; i < nodes.size(); ++i) {
    const auto camera = document.element("nodes", i).find("camera");
    if (!camera) continue;
    const JsonValue json = document.element("cameras", camera->index(document.count("cameras"), "cameras"));
    if (const auto perspective = json.find("perspective"))
      scene.fov_y_rad = perspective->need("yfov").number(0.01, 3.1);
    std::vector<std::size_t> chain{i};
    while (nodes[chain.back()].parent >= 0) chain.push_back(static_cast<std::size_t>(nodes[chain.back()].parent));
    std::reverse(chain.begin(), chain.end());
    const std::vector<Channel> channels = channels_of(document, chain, nodes.size());
    if (channels.empty()) continue;
    double first = channels.front().times.front(), last = first;
    for (const Channel& c : channels) first = std::min(first, c.times.front()), last = std::max(last, c.times.back());
    const double frames = std::floor((last - first) * 30 + 1e-6) + 1;
    if (frames > static_cast<double>(kMostPoses))
      scene.note(fmt::format("of the camera's path only the first {} frames are taken", kMostPoses));
    for (std::size_t k = 0; k < static_cast<std::size_t>(std::min(frames, static_cast<double>(kMostPoses))); ++k) {
      const glm::dmat4 world = world_at(nodes, chain, channels, first + static_cast<double>(k) / 30);
      const glm::dvec3 forward = -glm::dvec3(world[2]);
      if (!(glm::length(forward) > 1e-9)) camera->refuse("a camera scaled to nothing");
      scene.poses.push_back(make_pose(glm::dvec3(world[3]), forward));
    }
    return;
  }
  scene.note("no camera is animated");
}

}  // namespace framesim
