#include <algorithm>
#include <cmath>
#include <glm/common.hpp>
#include <glm/geometric.hpp>
#include <map>

#include "scenes/generator.h"
#include "scenes/generators/noise.h"
#include "scenes/generators/place.h"
#include "tests/catch.h"

using namespace framesim;

namespace {

Scene scene_with(std::vector<std::string> names) {
  Scene scene;
  for (std::string& name : names) {
    ObjectType type;
    type.name = std::move(name);
    type.levels = {Facts{}};
    scene.types.push_back(type);
  }
  scene.view_levels.resize(scene.types.size());
  return scene;
}

// Free text holds commas, so the settings are given one by one.
void run(Scene& scene, const std::string& name, const std::vector<std::pair<std::string, std::string>>& settings) {
  Spec spec{.name = name, .settings = {}, .where = {"test.toml", 7, 1}};
  for (const auto& [key, value] : settings) spec.settings.push_back({key, value, spec.where});
  find_entry<GeneratorEntry>("generator", generators(), spec).make(spec.settings)->generate(scene, spec.where);
}

std::string refusal(Scene scene, const std::string& name,
                    const std::vector<std::pair<std::string, std::string>>& settings) {
  try {
    run(scene, name, settings);
  } catch (const InputError& error) {
    return error.what();
  }
  return "";
}

// Columns agree in length, and the tree, if there is one, nests.
void check_columns(const Scene& scene) {
  const Instances& rows = scene.instances;
  REQUIRE(rows.radius_m.size() == rows.size());
  REQUIRE(rows.area_m2.size() == rows.size());
  REQUIRE(rows.type.size() == rows.size());
  REQUIRE(rows.kind.size() == rows.size());
  REQUIRE(rows.cell.size() == (scene.cells.empty() ? 0 : rows.size()));
  REQUIRE(scene.view_levels.size() == scene.types.size());
  if (rows.subtree_end.empty()) return;
  REQUIRE(rows.subtree_end.size() == rows.size());
  for (std::uint32_t row = 0; row < rows.size(); ++row) {
    REQUIRE(rows.subtree_end[row] > row);
    for (std::uint32_t child = row + 1; child < rows.subtree_end[row]; child = rows.subtree_end[child]) {
      REQUIRE(rows.subtree_end[child] <= rows.subtree_end[row]);
      const double reach =
          glm::length(rows.centre[child] - rows.centre[row]) + static_cast<double>(rows.radius_m[child]);
      REQUIRE(reach <= static_cast<double>(rows.radius_m[row]));
    }
  }
}

}  // namespace

TEST_CASE("every generator is registered once, describes its parameters, and refuses unknown ones") {
  std::map<std::string_view, int> names;
  for (const GeneratorEntry& entry : generators()) {
    ++names[entry.name];
    CHECK_FALSE(entry.summary.empty());
    CHECK_FALSE(entry.parameters.empty());
    CHECK_THROWS_AS(entry.make({{"no-such-key", "1", {"test"}}}), InputError);
  }
  CHECK(names.size() == generators().size());
}

TEST_CASE("scatter deals kinds by weight, exactly, and joins parts at one spot") {
  Scene scene = scene_with({"trunk", "leaves", "rock"});
  run(scene, "scatter", {{"types", "trunk@2+leaves@5:2,rock:1"}, {"count", "100"}, {"seed", "5"}});
  check_columns(scene);
  // 100 spots at 2:1 are 66.67 and 33.33: 67 trees of two instances each, and 33 rocks.
  int trunks = 0, rocks = 0;
  for (std::size_t row = 0; row < scene.instances.size(); ++row) {
    const std::size_t type = index(scene.instances.type[row]);
    rocks += type == 2;
    if (type != 0) continue;
    ++trunks;
    REQUIRE(index(scene.instances.type[row + 1]) == 1);
    CHECK(scene.instances.centre[row + 1] - scene.instances.centre[row] == glm::dvec3(0, 3, 0));
  }
  CHECK(trunks == 67);
  CHECK(rocks == 33);
  CHECK(scene.instances.size() == 167);
}

TEST_CASE("scatter keeps the spacing and the rectangle, for any seed") {
  for (int seed = 1; seed <= 10; ++seed) {
    CAPTURE(seed);
    Scene scene = scene_with({"a"});
    run(scene, "scatter",
        {{"types", "a@0"},
         {"count", "150"},
         {"seed", std::to_string(seed)},
         {"spacing", "3"},
         {"low_x", "-40"},
         {"high_x", "20"},
         {"low_z", "0"},
         {"high_z", "60"},
         {"ground", "2"}});
    const auto& at = scene.instances.centre;
    REQUIRE(at.size() == 150);
    for (std::size_t i = 0; i < at.size(); ++i) {
      CHECK((at[i].x >= -40 && at[i].x <= 20 && at[i].z >= 0 && at[i].z <= 60 && at[i].y == 2));
      for (std::size_t j = 0; j < i; ++j) REQUIRE(glm::length(at[i] - at[j]) >= 3 - 1e-9);
    }
  }
}

TEST_CASE("scatter with the same seed gives the same bits, with another seed other places") {
  const auto places = [](const char* seed) {
    Scene scene = scene_with({"a"});
    run(scene, "scatter", {{"types", "a"}, {"seed", seed}});
    return scene.instances.centre;
  };
  CHECK(places("1") == places("1"));
  CHECK(places("1") != places("2"));
}

TEST_CASE("scatter refuses what it cannot do, at its table") {
  const Scene scene = scene_with({"oak", "elm"});
  const std::string unknown = refusal(scene, "scatter", {{"types", "oka:2"}});
  CHECK(unknown.find("test.toml:7") == 0);
  CHECK(unknown.find("'oka'") != std::string::npos);
  CHECK(unknown.find("oak, elm") != std::string::npos);
  CHECK(refusal(scene, "scatter", {{"types", "oak:0"}}) != "");
  CHECK(refusal(scene, "scatter", {{"types", "oak:x"}}) != "");
  CHECK(refusal(scene, "scatter", {{"types", "oak:nan"}}) != "");
  CHECK(refusal(scene, "scatter", {{"types", ""}}) != "");
  CHECK(refusal(scene, "scatter", {{"types", "oak"}, {"spacing", "30"}}) != "");
  CHECK(refusal(scene, "scatter", {{"types", "oak"}, {"low_x", "5"}, {"high_x", "5"}}) != "");
  CHECK(refusal(scene, "scatter", {{"types", "oak+elm"}, {"count", "9000000"}}) != "");  // 18 million instances
  CHECK(refusal(scene, "scatter", {{"types", "oak"}, {"cell", "hall"}}) != "");
}

TEST_CASE("rows stand where they are told, rising") {
  Scene scene = scene_with({"seat"});
  run(scene, "rows",
      {{"type", "seat"},
       {"columns", "3"},
       {"rows", "2"},
       {"x", "1"},
       {"y", "0.5"},
       {"z", "-4"},
       {"step_x", "0.5"},
       {"step_z", "-1"},
       {"rise", "0.25"}});
  check_columns(scene);
  const std::vector<glm::dvec3> expected = {{1, 0.5, -4},  {1.5, 0.5, -4},  {2, 0.5, -4},
                                            {1, 0.75, -5}, {1.5, 0.75, -5}, {2, 0.75, -5}};
  CHECK(scene.instances.centre == expected);
}

TEST_CASE("terrain is a full quadtree whose spheres nest and whose patches tile the region") {
  Scene scene = scene_with({});
  run(scene, "terrain", {{"side", "257"}, {"patch", "32"}, {"region", "1000"}, {"relief", "300"}});
  check_columns(scene);
  CHECK(scene.instances.size() == 1 + 4 + 16 + 64);  // 256 / 32 = 8 = 2^3
  REQUIRE(scene.types.size() == 4);
  double leaf_area = 0;
  for (std::size_t row = 0; row < scene.instances.size(); ++row) {
    if (index(scene.instances.type[row]) == 3) leaf_area += static_cast<double>(scene.instances.area_m2[row]);
  }
  CHECK(leaf_area == Approx(1e6));
  // A patch of 33^2 samples: 32 strips of 2 * 33 vertices. Weight 2^(dmax - d).
  CHECK(scene.types[0].levels[0].vertices == 32 * 66);
  CHECK(scene.types[0].levels[0].polygons == 2048);
  CHECK(scene.types[0].levels[0].benefit_weight == 8);
  CHECK(scene.types[3].levels[0].benefit_weight == 1);
}

TEST_CASE("terrain refuses a side that is not patch * 2^k + 1") {
  for (const char* side : {"256", "258", "97", "33000"}) {
    CAPTURE(side);
    CHECK(refusal(scene_with({}), "terrain", {{"side", side}}) != "");
  }
  CHECK(refusal(scene_with({}), "terrain", {{"side", "33"}}) == "");  // one patch: k = 0
}

TEST_CASE("groves hold exactly the trees asked for, in groups of at most the size asked for") {
  for (const int count : {0, 1, 63, 1000, 5000, 16384}) {
    for (const int group : {1, 7, 64}) {
      CAPTURE(count, group);
      Scene scene = scene_with({});
      run(scene, "groves",
          {{"count", std::to_string(count)}, {"grid", "128"}, {"group", std::to_string(group)}, {"region", "6000"}});
      check_columns(scene);
      double trees = 0, most = 0;
      for (std::size_t row = 0; row < scene.instances.size(); ++row) {
        const bool leaf = scene.instances.subtree_end[row] == row + 1;
        REQUIRE(leaf == (scene.instances.kind[row] == ItemKind::curve));
        if (!leaf) continue;
        const Facts& facts = scene.types[index(scene.instances.type[row])].levels[0];
        CHECK(facts.draws == facts.benefit_weight);
        trees += facts.draws;
        most = std::max(most, facts.draws);
      }
      CHECK(trees == count);
      CHECK(most <= group);
    }
  }
}

// Both orders are the quadtree's, so that the trees of a group follow each other among the single ones. A tree is 60 m high
// and 15 m around; its own sphere tells where it stands, and a group's sphere is that around the boxes of its trees.
TEST_CASE("trees one by one are the trees of the groups") {
  const auto groves = [](const char* group) {
    Scene scene = scene_with({});
    run(scene, "groves", {{"count", "3000"}, {"grid", "128"}, {"group", group}, {"region", "6000"}, {"seed", "5"}});
    return scene;
  };
  const Scene grouped = groves("16"), single = groves("1");
  std::vector<std::uint32_t> trees;
  for (std::uint32_t row = 0; row < single.instances.size(); ++row) {
    if (single.instances.kind[row] == ItemKind::curve) trees.push_back(row);
  }
  REQUIRE(trees.size() == 3000);
  std::size_t next = 0;
  for (std::uint32_t row = 0; row < grouped.instances.size(); ++row) {
    if (grouped.instances.kind[row] != ItemKind::curve) continue;
    CAPTURE(row);
    const double count = grouped.types[index(grouped.instances.type[row])].levels[0].draws;
    glm::dvec3 low(1e300), high(-1e300);
    for (double i = 0; i < count; ++i) {
      REQUIRE(next < trees.size());
      const glm::dvec3 centre = single.instances.centre[trees[next++]];
      low = glm::min(low, centre - glm::dvec3(15, 30, 15));
      high = glm::max(high, centre + glm::dvec3(15, 30, 15));
    }
    const glm::dvec3 middle = (low + high) * 0.5;
    CHECK(glm::length(middle - grouped.instances.centre[row]) < 1e-9);
    CHECK(static_cast<double>(grouped.instances.radius_m[row]) == Approx(glm::length(high - low) / 2).epsilon(1e-6));
  }
  CHECK(next == trees.size());
}

TEST_CASE("groves refuse more trees than cells and a grid that is no power of two") {
  CHECK(refusal(scene_with({}), "groves", {{"count", "257"}, {"grid", "16"}}) != "");
  CHECK(refusal(scene_with({}), "groves", {{"count", "10"}, {"grid", "24"}}) != "");
}

TEST_CASE("instances beside a tree are roots of their own") {
  Scene scene = scene_with({"a"});
  run(scene, "scatter", {{"types", "a"}, {"count", "5"}});
  run(scene, "terrain", {{"side", "33"}, {"patch", "16"}});
  run(scene, "scatter", {{"types", "a"}, {"count", "2"}});
  check_columns(scene);
  CHECK(scene.instances.size() == 5 + 5 + 2);
  CHECK(scene.instances.subtree_end == std::vector<std::uint32_t>{1, 2, 3, 4, 5, 10, 7, 8, 9, 10, 11, 12});
}

TEST_CASE("museum from a map: cells, openings and statues") {
  Scene scene = scene_with({"statue"});
  run(scene, "museum",
      {{"map", "..#\n#..\n"}, {"types", "statue@1"}, {"statues", "16"}, {"tile", "4"}, {"samples", "100"}});
  check_columns(scene);
  REQUIRE(scene.cells.size() == 4);  // tiles (0,0) (1,0) (1,1) (2,1)
  CHECK(scene.cells[2].name == "tile-1-1");
  CHECK(scene.portals.size() == 3);     // (0,0)-(1,0), (1,0)-(1,1), (1,1)-(2,1)
  CHECK(scene.instances.size() == 16);  // every place is taken: four a tile
  for (std::size_t row = 0; row < 16; ++row) {
    const Box& box = scene.cells[scene.instances.cell[row]].box;
    CHECK(glm::clamp(scene.instances.centre[row], box.low, box.high) == scene.instances.centre[row]);
  }
  for (const Portal& portal : scene.portals) {
    for (const glm::dvec3& corner : portal.corners) {
      for (const std::uint16_t cell : {portal.from, portal.to}) {
        CHECK(glm::clamp(corner, scene.cells[cell].box.low, scene.cells[cell].box.high) == corner);
      }
    }
  }
  CHECK(scene.cell_visibility.samples == 100);
  CHECK(scene.cell_visibility.seen.size() == 4);
}

TEST_CASE("museum without a map: every tile can be reached, for any seed and share of openings") {
  for (int seed = 1; seed <= 20; ++seed) {
    for (const char* open : {"0", "0.5", "1"}) {
      CAPTURE(seed, open);
      Scene scene = scene_with({});
      run(scene, "museum",
          {{"columns", "6"},
           {"rows", "5"},
           {"open", open},
           {"seed", std::to_string(seed)},
           {"statues", "0"},
           {"samples", "0"}});
      CHECK(scene.cell_visibility.seen.empty());
      REQUIRE(scene.cells.size() == 30);
      if (open == std::string("0")) CHECK(scene.portals.size() == 29);  // a spanning tree
      if (open == std::string("1")) CHECK(scene.portals.size() == 6 * 4 + 5 * 5);
      std::vector<char> reached(30, 0);
      reached[0] = 1;
      for (bool more = true; more;) {
        more = false;
        for (const Portal& portal : scene.portals) {
          if (reached[portal.from] != reached[portal.to]) reached[portal.from] = reached[portal.to] = 1, more = true;
        }
      }
      CHECK(std::count(reached.begin(), reached.end(), 1) == 30);
    }
  }
}

TEST_CASE("museum refuses a bad map") {
  const Scene scene = scene_with({"statue"});
  for (const char* map : {"..\n.", "#", ".x", "\n\n"}) {
    CAPTURE(map);
    CHECK(refusal(scene, "museum", {{"map", map}, {"types", "statue"}, {"statues", "0"}}) != "");
  }
  CHECK(refusal(scene, "museum", {{"map", "."}, {"types", "statue"}, {"statues", "5"}}) != "");  // four places
}

TEST_CASE("a smooth field lies in (0,1), agrees with itself at other steps, and is smooth") {
  const SmoothField field(4, "test", 4, 5);
  const std::vector<float> coarse = field.sample(65, 0, 1.0 / 64), fine = field.sample(129, 0, 1.0 / 128);
  for (const float value : fine) CHECK((value > 0 && value < 1));
  for (std::size_t j = 0; j < 65; ++j) {
    for (std::size_t i = 0; i < 65; ++i) REQUIRE(coarse[j * 65 + i] == fine[2 * j * 129 + 2 * i]);
  }
  // Octave k moves by at most (weight 2^-k / 1.9375) * 1.875 (the steepest slope of the quintic) * 4 * 2^k a unit of
  // length along an axis: 3.87 an octave, 19.4 in all; a step of 1/128 is at most 0.152.
  for (std::size_t i = 1; i < fine.size(); ++i) {
    if (i % 129 != 0) REQUIRE(std::abs(fine[i] - fine[i - 1]) < 0.152f);
  }
}
