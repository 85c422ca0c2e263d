// What a small scene file may ask for: memory is bounded by SceneLimits, files by the scene's folder.
#include <filesystem>
#include <string>

#include "scenes/registry.h"
#include "scenes/scene_file.h"
#include "tests/allocations.h"
#include "tests/catch.h"
#include "tests/scenes/refusal.h"
#include "tests/scenes/temp_folder.h"

using namespace framesim;

namespace {

const std::string kBegin = R"(framesim = 1
name = 't'
title = 'a title'
source = 'a source'
assumptions = 'none'
targets = ['16ms']
[[type]]
name = 'house'
radius = '6m'
area = 40.0
[[type.level]]
polygons = 12
vertices = 24
[camera]
[[camera.path]]
name = 'walk'
[[camera.path.leg]]
kind = 'polyline'
points = [[0, 0, 0], [0, 0, -9]]
frames = 2
)";

// With one table more, which begins at line 23.
std::string scene(const std::string& more, const std::string& machine = "street") {
  return kBegin + "[machine]\nuse = '" + machine + "'\n" + more;
}

std::string refused(const std::string& text, const std::string& folder = "", const SceneLimits& limits = {}) {
  return refusal([&] { parse_scene(text, "t.toml", folder, {}, limits); });
}

std::string generator(const std::string& settings) { return scene("[[generator]]\n" + settings); }

// The same with `types` more types, 100 bytes each, before the camera.
std::string with_types(std::string text, int types) {
  std::string more;
  for (int i = 0; i < types; ++i)
    more += "[[type]]\nname = 'type-" + std::to_string(1000 + i) +
            "'\nradius = '6m'\narea = 40.0\n[[type.level]]\npolygons = 12\nvertices = 24\n";
  return text.insert(text.find("[camera]"), more);
}

std::int64_t bytes_to_refuse(const std::string& text) {
  const std::int64_t before = testing::allocated_bytes();
  CHECK_FALSE(refused(text).empty());
  return testing::allocated_bytes() - before;
}

}  // namespace

TEST_CASE("a scene file of 2 KB that asks for a million million instances takes memory by its own size only",
          "[limits]") {
  for (const char* settings : {"kind = 'rows'\ntype = 'house'\ncolumns = 1000000\nrows = 1000000\n",
                               "kind = 'scatter'\ntypes = 'house'\ncount = 1000000000000\n",
                               "kind = 'terrain'\nside = 8388609\npatch = 32\n"}) {
    CAPTURE(settings);
    const std::string small = with_types(generator(settings), 16), large = with_types(generator(settings), 32);
    REQUIRE(small.size() > 1900);
    REQUIRE(small.size() < 2300);
    // All that was asked for from first to last, which is no less than what was ever held: 10^12 instances would be 4e13
    // bytes. Twice the file takes no more than twice as much.
    const std::int64_t bytes = bytes_to_refuse(small);
    CHECK(bytes < 100 * static_cast<std::int64_t>(small.size()));
    CHECK(bytes_to_refuse(large) < 2 * bytes);
  }
}

TEST_CASE("a few bytes that ask for a million million instances are refused with the limit", "[limits]") {
  const std::string raise = "--limit-instances N";
  const std::string rows = refused(generator("kind = 'rows'\ntype = 'house'\ncolumns = 1000000\nrows = 1000000\n"));
  CHECK(says(rows, "t.toml:23:1", "1000000000000 instances beside 0; allowed are 4000000"));
  CHECK(says(rows, "t.toml:23:1", raise));
  const std::string scatter = refused(generator("kind = 'scatter'\ntypes = 'house'\ncount = 1000000000000\n"));
  CHECK(says(scatter, "t.toml:23:1", "1000000000000 instances beside 0; allowed are 4000000"));
  CHECK(says(scatter, "t.toml:23:1", raise));
  // 2^23 + 1 = 32 * 2^18 + 1 samples a side: a tree of depth 18 with (4^19 - 1) / 3 nodes.
  const std::string terrain = refused(generator("kind = 'terrain'\nside = 8388609\npatch = 32\n"));
  CHECK(says(terrain, "t.toml:23:1", "70368760954881 height samples; allowed are 64000000"));
  CHECK(says(terrain, "t.toml:23:1", raise));
  const std::string groves = refused(generator("kind = 'groves'\ncount = 1000000000000\ngrid = 1048576\n"));
  CHECK(says(groves, "t.toml:23:1", "1099511627776 cells of the grid; allowed are 64000000"));
  CHECK(says(groves, "t.toml:23:1", raise));
  // The largest products that the parameters allow, one above what an int64 holds.
  CHECK(says(refused(generator("kind = 'rows'\ntype = 'house'\ncolumns = 1000000000000000\nrows = 1000000000000000\n")),
             "t.toml:23:1", "1000000000000000000 instances"));
}

TEST_CASE("a museum's sight lines and pairs of cells are bounded", "[limits]") {
  // 40,000 cells * 1,000,000 lines; and 200 * 50 = 10,000 cells see at most 10^8 pairs.
  CHECK(says(refused(generator("kind = 'museum'\ncolumns = 200\nrows = 200\nstatues = 0\nsamples = 1000000\n")),
             "t.toml:23:1", "40000000000 sight lines; allowed are 64000000"));
  CHECK(says(refused(generator("kind = 'museum'\ncolumns = 200\nrows = 50\nstatues = 0\nsamples = 1\n")), "t.toml:23:1",
             "100000000 pairs of cells; allowed are 64000000"));
}

TEST_CASE("the limit counts every way of making instances, and is the caller's to set", "[limits]") {
  const TempFolder folder;
  folder.write("a.csv", "type,x,y,z\nhouse,1,2,3\nhouse,1,2,3\nhouse,1,2,3\n");
  const std::string inline_two = "[[instance]]\ntype = 'house'\nposition = [0, 0, 0]\n";
  const std::string csv = "[instances]\ncsv = 'a.csv'\n";
  const std::string rows = "[[generator]]\nkind = 'rows'\ntype = 'house'\ncolumns = 4\n";
  const std::string all = scene(inline_two + inline_two + csv + rows);  // 2 + 3 + 4
  const auto within = [&](std::size_t most) { return refused(all, folder.path(), {.instances = most}); };
  CHECK(within(9).empty());
  CHECK(says(within(8), "t.toml:31:1", "4 instances beside 5; allowed are 8"));
  CHECK(says(within(4), folder.path("a.csv") + ":4:1", "more than 4 instances; --limit-instances N allows more"));
  CHECK(says(within(1), "t.toml:27:8", "more than 1 instances; --limit-instances N allows more"));
  CHECK(parse_scene(all, "t.toml", folder.path(), {}, {.instances = 9}).instances.size() == 9);
}

TEST_CASE("cylinders of trunks count towards the limit", "[limits]") {
  const auto types = [](int count) {
    std::string text =
        "representation = 'view-levels'\n" + scene("[[instance]]\ntype = 'house'\nposition = [0, 0, 0]\n");
    for (int i = 0; i < count; ++i) {
      text += "[[type]]\nname = 't" + std::to_string(i) +
              "'\nradius = '1m'\narea = 1.0\n[type.continuous]\npolygons = 9\nvertices = 9\n[type.view_levels]\n"
              "part = 'trunk'\ncylinders = 80\nthickest = '9cm'\nthinnest = '1cm'\n";
    }
    return text;
  };
  // 16 * 10 = 160 are two types' worth.
  CHECK(refused(types(2), "", {.instances = 10}).empty());
  CHECK(refused(types(3), "", {.instances = 10}).find("240 cylinders with those before; allowed are 160") !=
        std::string::npos);
}

TEST_CASE("of several camera paths the one in use has its poses", "[limits]") {
  const std::string two = kBegin +
                          "[[camera.path]]\nname = 'run'\n[[camera.path.leg]]\nkind = 'polyline'\n"
                          "points = [[5, 0, 0], [5, 0, -9]]\nframes = 3\n[machine]\nuse = 'street'\n"
                          "[[instance]]\ntype = 'house'\nposition = [0, 0, 0]\n";
  std::string second = two;
  second.replace(second.find("[camera]\n"), 9, "[camera]\nuse = 'run'\n");
  CHECK(parse_scene(two, "t.toml", "").camera.poses.size() == 2);
  CHECK(parse_scene(second, "t.toml", "").camera.poses.size() == 3);
  CHECK(parse_scene(second, "t.toml", "").camera.poses[0].eye.x == 5);
}

TEST_CASE("a symbolic link may not lead out of the scene's folder", "[limits]") {
  namespace fs = std::filesystem;
  const TempFolder outside, folder;
  outside.write("a.csv", "type,x,y,z\nhouse,1,2,3\n");
  fs::create_symlink(outside.path("a.csv"), folder.path("link.csv"));
  fs::create_directory_symlink(outside.path(), folder.path("sub"));
  folder.write("real.csv", "type,x,y,z\nhouse,1,2,3\n");
  fs::create_symlink("real.csv", folder.path("inside.csv"));
  const auto named = [&](const std::string& name, const SceneLimits& limits = {}) {
    return refused(scene("[instances]\ncsv = '" + name + "'\n"), folder.path(), limits);
  };
  CHECK(says(named("link.csv"), "t.toml:24:7", "leads out of the scene's folder"));
  CHECK(says(named("link.csv"), "t.toml:24:7", "--allow-outside-paths"));
  CHECK(says(named("sub/a.csv"), "t.toml:24:7", "leads out of the scene's folder"));
  CHECK(named("inside.csv").empty());
  CHECK(named("real.csv").empty());
  const SceneLimits anywhere{.outside_paths = true};
  CHECK(named("link.csv", anywhere).empty());
  CHECK(named("sub/a.csv", anywhere).empty());
  CHECK(named(outside.path("a.csv"), anywhere).empty());
  CHECK(named("../" + fs::path(outside.path()).filename().string() + "/a.csv", anywhere).empty());
  CHECK(says(named("/nowhere/a.csv", anywhere), "t.toml:24:7", "no such file"));
}

TEST_CASE("a scene's folder may itself be reached by a symbolic link", "[limits]") {
  const TempFolder folder, other;
  folder.write("a.csv", "type,x,y,z\nhouse,1,2,3\n");
  std::filesystem::create_directory_symlink(folder.path(), other.path("link"));
  CHECK(refused(scene("[instances]\ncsv = 'a.csv'\n"), other.path("link")).empty());
  const std::string path = folder.write("s.toml", scene("[instances]\ncsv = 'a.csv'\n"));
  CHECK(load_scene_file(path).instances.size() == 1);
}

TEST_CASE("a machine outside of the scene's folder needs the flag", "[limits]") {
  const TempFolder outside, folder;
  const std::string path = outside.write(
      "m.toml", "framesim = 1\n[machine]\nname = 'm'\nsource = 's'\n[machine.algorithm.default]\npolygon = '1us'\n");
  const std::string text = scene("[[instance]]\ntype = 'house'\nposition = [0, 0, 0]\n", path);
  CHECK(says(refused(text, folder.path()), "t.toml:22:7", "leads out of the scene's folder"));
  CHECK(parse_scene(text, "t.toml", folder.path(), {}, {.outside_paths = true}).machine.name == "m");
  // A built-in scene has no folder: the flag opens none.
  CHECK(says(refused(text, "", {.outside_paths = true}), "t.toml:22:7", "has no files beside it"));
}
