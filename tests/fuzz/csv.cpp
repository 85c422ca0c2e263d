// CSV of instances and of recorded poses, beside a small scene.
#include "scenes/scene_file.h"
#include "tests/fuzz/fuzz.h"

using namespace framesim;

namespace {

constexpr std::string_view kScene = R"(
framesim = 1
name = 't'
title = 't'
source = 's'
assumptions = 'none'
targets = ['16ms']
[machine]
use = 'street'
[[type]]
name = 'house'
radius = '6m'
area = 40.0
[[type.level]]
polygons = 12
vertices = 24
[[cell]]
name = 'hall'
low = [-9, -9, -9]
high = [9, 9, 9]
[camera]
[[camera.path]]
name = 'walk'
[[camera.path.leg]]
)";

void read(const std::string& path, std::string_view leg, std::string_view rest) {
  const std::filesystem::path file(path);
  const std::string text = std::string(kScene) + std::string(leg) + std::string(rest);
  fuzz::accepts([&] { parse_scene(text, "fuzz.toml", file.parent_path().string(), {}, {.instances = 1000}); });
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  const std::string_view text = fuzz::text_of(data, size);
  const std::string path = fuzz::as_file(text, "input.csv");
  // Only instances have a type; what is neither goes to the poses.
  if (text.substr(0, text.find('\n')).find("type") != std::string_view::npos) {
    read(path, "kind = 'polyline'\npoints = [[0, 0, 0], [0, 0, -9]]\nframes = 2\n", "[instances]\ncsv = 'input.csv'\n");
  } else {
    read(path, "kind = 'csv'\nfile = 'input.csv'\n", "[[instance]]\ntype = 'house'\nposition = [0, 0, 0]\n");
  }
  return 0;
}
