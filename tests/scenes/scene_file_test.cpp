#include "scenes/scene_file.h"

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <glm/vec3.hpp>
#include <numbers>
#include <string>
#include <vector>

#include "scenes/registry.h"
#include "sim/random_stream.h"
#include "tests/catch.h"
#include "tests/scenes/refusal.h"
#include "tests/scenes/temp_folder.h"

using namespace framesim;

namespace {

// The smallest scene, a line each, so that a test can say "line 8 is now ...".
const std::vector<std::string> kScene = {
    "framesim = 1",                      // 1
    "name = 't'",                        // 2
    "title = 'a title'",                 // 3
    "source = 'a source'",               // 4
    "assumptions = 'none'",              // 5
    "targets = ['16ms', '25fps']",       // 6
    "[screen]",                          // 7
    "width = 800",                       // 8
    "far = '1km'",                       // 9
    "[machine]",                         // 10
    "use = 'street'",                    // 11
    "[[type]]",                          // 12
    "name = 'house'",                    // 13
    "radius = '6m'",                     // 14
    "area = 40.0",                       // 15
    "[[type.level]]",                    // 16
    "polygons = 12",                     // 17
    "vertices = 24",                     // 18
    "[[instance]]",                      // 19
    "type = 'house'",                    // 20
    "position = [0, 1.5, -20]",          // 21
    "[camera]",                          // 22
    "[[camera.path]]",                   // 23
    "name = 'walk'",                     // 24
    "[[camera.path.leg]]",               // 25
    "kind = 'polyline'",                 // 26
    "points = [[0, 0, 0], [0, 0, -9]]",  // 27
    "frames = 10",                       // 28
};

// The scene with `text` (one line or more) for line `line`, counted from 1; beyond the last line it is appended.
std::string with(std::size_t line, const std::string& text) {
  std::string all;
  for (std::size_t i = 1; i <= std::max(kScene.size(), line); ++i) {
    all += (i == line ? text : i <= kScene.size() ? kScene[i - 1] : "") + "\n";
  }
  return all;
}
std::string added(const std::string& text) { return with(29, text); }

std::string refused(const std::string& text, const std::string& folder = ".", const Settings& settings = {}) {
  return refusal([&] { parse_scene(text, "t.toml", folder, settings); });
}

Scene parse(const std::string& text, const Settings& settings = {}) {
  return parse_scene(text, "t.toml", ".", settings);
}

struct Case {
  std::string text, where, words;
};
void check_all(const std::vector<Case>& cases) {
  for (const Case& c : cases) CHECK(says(refused(c.text), c.where, c.words));
}

Setting setting(const std::string& key, const std::string& value) { return {key, value, {"command line"}}; }

}  // namespace

TEST_CASE("the smallest scene is read, with defaults", "[scene_file]") {
  const Scene scene = parse(with(28, kScene[27]));
  CHECK(scene.name == "t");
  CHECK(scene.title == "a title");
  REQUIRE(scene.targets_s.size() == 2);
  CHECK(scene.targets_s[0] == 0.016);
  CHECK(scene.targets_s[1] == 0.04);
  CHECK(scene.screen.width == 800);
  CHECK(scene.screen.height == 720);
  CHECK(scene.screen.far_m == 1000);
  CHECK(scene.machine.name == "street");
  REQUIRE(scene.types.size() == 1);
  REQUIRE(scene.types[0].levels.size() == 1);
  CHECK(scene.types[0].levels[0].polygons == 12);
  CHECK(scene.types[0].levels[0].vertices == 24);
  CHECK(scene.types[0].levels[0].algorithm == Algorithm::gouraud);
  CHECK(scene.types[0].levels[0].coverage == 1);
  REQUIRE(scene.instances.size() == 1);
  CHECK(scene.instances.centre[0] == glm::dvec3(0, 1.5, -20));
  CHECK(scene.instances.radius_m[0] == 6.0f);
  CHECK(scene.instances.area_m2[0] == 40.0f);
  CHECK(scene.instances.cell.empty());
  CHECK(scene.camera.poses.size() == 10);
  CHECK(scene.visibility == VisibilityMethod::frustum);
  CHECK(scene.logic.base_s == 0);
  CHECK(scene.effects.empty());
}

TEST_CASE("what is not TOML is refused with line and column", "[scene_file]") {
  check_all({{with(8, "width ="), "t.toml:8:8", "not TOML"},
             {with(8, "width = 800\nwidth = 801"), "t.toml:9:9", "redefine"},
             {with(3, "title = '\u00e9a\xff'"), "t.toml:3:12", "not UTF-8"},
             {with(8, "width = 99999999999999999999"), "t.toml:8:29", "64 bits"}});
}

TEST_CASE("a key of a hundred thousand parts does not overflow the stack", "[scene_file]") {
  std::string key = "a";
  for (int i = 0; i < 100'000; ++i) key += ".a";
  CHECK(says(refused(with(8, key + " = 1")), "t.toml:8", "a key of more than 256 parts"));
  // Dots in prose and in numbers are not counted as one key.
  CHECK(refused(with(5, "assumptions = '" + std::string(1000, '.') + "'")).empty());
}

TEST_CASE("what the TOML library only asserts is refused too", "[scene_file]") {
  // A table header that begins with no key, and a list whose item begins with the end of a value.
  check_all({{with(7, "[=]"), "t.toml:7:2", "not TOML"},
             {with(12, "[[ #type]]"), "t.toml:12:4", "not TOML"},
             {with(21, "position = [ }"), "t.toml:21:14", "not TOML"}});
}

TEST_CASE("lists nested without end are refused", "[scene_file]") {
  const std::string message = refused(with(8, "width = " + std::string(100'000, '[')));
  CHECK(message.rfind("t.toml:8:", 0) == 0);
}

TEST_CASE("unknown keys and tables are refused with the legal set", "[scene_file]") {
  check_all(
      {{with(8, "widht = 800"), "t.toml:8:1",
        "unknown key 'widht' in [screen]; allowed: width, height, fov_y, near, far"},
       {with(8, "widht = 800"), "t.toml:8:1", "did you mean 'width'?"},
       {with(7, "[scren]"), "t.toml:7:2", "unknown key 'scren' in the file"},
       {with(13, "name = 'house'\ncolour = 'red'"), "t.toml:14:1", "unknown key 'colour' in [[type]] 'house'"},
       {with(17, "polygons = 12\nmesh = 'a.obj'"), "t.toml:18:1", "unknown key 'mesh' in [[type.level]]"},
       {with(21, "pos = [0, 0, 0]"), "t.toml:21:1", "unknown key 'pos' in [[instance]]"},
       {with(24, "nam = 'walk'"), "t.toml:24:1", "unknown key 'nam' in [[camera.path]]"},
       {with(28, "frames = 10\nangle = '3deg'"), "t.toml:29:1",
        "unknown key 'angle' in [[camera.path.leg]] of kind 'polyline'"},
       {with(28, "frames = 10\nspeed = 3"), "t.toml:29:1", "unknown key 'speed'"},
       {with(11, "use = 'street'\nsubmit = '1us'"), "t.toml:12:1", "unknown key 'submit' in [machine] with 'use'"},
       {added("[logic]\nbas = '1ms'"), "t.toml:30:1", "unknown key 'bas' in [logic]"},
       {added("[[logic.task]]\nname = 'a'\ntim = '1ms'"), "t.toml:31:1", "unknown key 'tim' in [[logic.task]]"},
       {added("[visibility]\nmode = 'frustum'"), "t.toml:30:1", "unknown key 'mode' in [visibility]"},
       {added("[[cell]]\nnam = 'a'"), "t.toml:30:1", "unknown key 'nam' in [[cell]]"},
       {added("[[portal]]\nfro = 'a'"), "t.toml:30:1", "unknown key 'fro' in [[portal]]"},
       {added("[instances]\nfile = 'a.csv'"), "t.toml:30:1", "unknown key 'file' in [instances]"},
       {added("[parameters.p]\nmin = 3"), "t.toml:30:1", "unknown key 'min' in [parameters.p]"}});
}

TEST_CASE("wrong types, units and ranges are refused at the value", "[scene_file]") {
  check_all({{with(1, "framesim = 2"), "t.toml:1:12", "found 2"},
             {with(1, "framesim = '1'"), "t.toml:1:12", "found '1'"},
             {with(2, "name = 'a b'"), "t.toml:2:8", "a name of 1 to 64 letters"},
             {with(3, "title = ''"), "t.toml:3:9", "not empty"},
             {with(3, "title = \"a\\u0007\""), "t.toml:3:9", "control characters"},
             {with(6, "targets = []"), "t.toml:6:11", "at least one duration"},
             {with(6, "targets = ['16ms', '0ms']"), "t.toml:6:20", "above 0s"},
             {with(6, "targets = ['16']"), "t.toml:6:12", "'16' has no unit"},
             {with(6, "targets = ['16mm']"), "t.toml:6:12", "unknown unit 'mm'"},
             {with(6, "targets = [16]"), "t.toml:6:12", "'16' has no unit"},
             {with(6, "targets = ['0fps']"), "t.toml:6:12", "rate above 0"},
             {with(6, "targets = [2024-01-01]"), "t.toml:6:12", "a date or time"},
             {with(6, "targets = ['16ms']\nlogic = 3"), "t.toml:7:9", "found 3; allowed: a table [logic]"},
             {with(8, "width = '800'"), "t.toml:8:9", "found '800'; allowed: a whole number from 1 to 65536"},
             {with(8, "width = -3"), "t.toml:8:9", "found -3"},
             {with(8, "width = 800.0"), "t.toml:8:9", "a whole number"},
             {with(8, "fov_y = 60"), "t.toml:8:9", "'60' has no unit; allowed: deg, rad"},
             {with(8, "fov_y = '180deg'"), "t.toml:8:9", "above 0deg and up to 179.5deg"},
             {with(9, "far = '1mile'"), "t.toml:9:7", "unknown unit 'mile'; allowed: mm, cm, m, km"},
             {with(9, "far = '5cm'"), "t.toml:9:7", "not beyond 'near'"},
             {with(9, "far = true"), "t.toml:9:7", "found true; allowed: a length"},
             {with(12, "[type]"), "t.toml:12:1", "found a table; allowed: tables [[type]]"},
             {with(14, "radius = '-6m'"), "t.toml:14:10", "above 0m"},
             {with(14, "radius = inf"), "t.toml:14:10", "inf"},
             {with(15, "area = nan"), "t.toml:15:8", "found nan; allowed: a finite number"},
             {with(15, "area = inf"), "t.toml:15:8", "found inf"},
             {with(15, "area = 0"), "t.toml:15:8", "above 0"},
             {with(15, "area = 40\nimportance = 1.5"), "t.toml:16:14", "from 0 to 1"},
             {with(15, "area = 40\nbenefit = 'size'"), "t.toml:16:11", "allowed: funkhouser, zach-terrain, zach-trees"},
             {with(17, "polygons = -1"), "t.toml:17:12", "from 0 to"},
             {with(17, "polygons = 0"), "t.toml:16:1", "nothing to draw"},
             {with(17, "polygons = 12\ncoverage = 1.01"), "t.toml:18:12", "from 0 to 1"},
             {with(17, "polygons = 12\nalgorithm = 'phong'"), "t.toml:18:13", "allowed: flat, gouraud, textured"},
             {with(21, "position = [0, 0]"), "t.toml:21:12", "three numbers [x, y, z]"},
             {with(21, "position = [0, nan, 0]"), "t.toml:21:16", "found nan"},
             {with(21, "position = [0, 2e9, 0]"), "t.toml:21:16", "from -1e+09 to 1e+09"},
             {with(21, "position = [0, 0, 0]\nscale = 0"), "t.toml:22:9", "above 0"},
             {with(27, "points = [[0, 0, 0]]"), "t.toml:27:10", "found 1 points; allowed: 2 or more"},
             {with(27, "points = [[0, 0, 0], [0, 0, 0]]"), "t.toml:27:10", "points 1 and 2 coincide"},
             {with(28, "frames = 0"), "t.toml:28:10", "from 1 to 1000000"},
             {with(28, "step = '0m'"), "t.toml:28:8", "above 0m"},
             {with(28, "step = '3deg'"), "t.toml:28:8", "unknown unit 'deg'"},
             {added("[visibility]\nsmallest_px = -1"), "t.toml:30:15", "from 0 to"},
             {added("[logic]\nbase = '-1ms'"), "t.toml:30:8", "negative duration"}});
}

TEST_CASE("what is needed and missing is said at its table", "[scene_file]") {
  check_all({{with(1, ""), "t.toml:1:1", "the file has no 'framesim'"},
             {with(2, ""), "t.toml:1:1", "the file has no 'name'"},
             {with(6, ""), "t.toml:1:1", "the file has no 'targets'"},
             {with(11, ""), "t.toml:10:1", "[machine] has no 'name'"},
             {with(14, ""), "t.toml:12:1", "[[type]] 'house' has no 'radius'"},
             {with(18, ""), "t.toml:16:1", "has no 'vertices'"},
             {with(20, ""), "t.toml:19:1", "[[instance]] has no 'type'"},
             {with(24, ""), "t.toml:23:1", "[[camera.path]] has no 'name'"},
             {with(28, ""), "t.toml:25:1", "needs either 'frames' or 'step'"},
             {with(28, "frames = 3\nstep = '1m'"), "t.toml:25:1", "needs either 'frames' or 'step'"}});
  std::string text;
  for (std::size_t i = 0; i < 21; ++i) text += kScene[i] + "\n";
  CHECK(says(refused(text), "t.toml:1:1", "no table [camera]"));
  CHECK(says(refused(text + "[camera]\n"), "t.toml:22:1", "no [[camera.path]]"));
  CHECK(says(refused(text + "[camera]\n[[camera.path]]\nname = 'a'\n"), "t.toml:23:1",
             "path 'a' has no [[camera.path.leg]]"));
}

TEST_CASE("names that are unknown or there twice", "[scene_file]") {
  check_all(
      {{with(11, "use = 'stret'"), "t.toml:11:7", "unknown machine 'stret'; allowed: street, vgx320"},
       {with(20, "type = 'hose'"), "t.toml:20:8", "unknown type 'hose'; allowed: house; did you mean 'house'?"},
       {with(21, "position = [0, 0, 0]\ncell = 'hall'"), "t.toml:22:8", "unknown cell 'hall'; allowed: none"},
       {with(22, "[camera]\nuse = 'run'"), "t.toml:23:7", "found 'run'; allowed: walk"},
       {with(26, "kind = 'line'"), "t.toml:26:8", "allowed: polyline, spline, turn, csv"},
       {added("[[effect]]\nname = 'vsinc'"), "t.toml:30:8", "unknown effect 'vsinc'; allowed: "},
       {added("[[effect]]\nname = 'vsync'\nspeed = 3"), "t.toml:31:1", "unknown parameter 'speed'"},
       {added("[[effect]]\nname = 'vsync'\nrate = nan"), "t.toml:31:8", "found nan"},
       {added("[[effect]]\nname = 'vsync'\nrate = [1]"), "t.toml:31:8", "found a list"},
       {added("[[effect]]\nname = 'vsync'\n[[effect]]\nname = 'vsync'"), "t.toml:32:8",
        "effect 'vsync' is there twice"},
       {added("[[generator]]\nkind = 'scater'"), "t.toml:30:8", "unknown generator 'scater'; allowed: scatter"},
       {added("[[generator]]\nkind = 'scatter'\ncuont = 3"), "t.toml:31:1", "unknown parameter 'cuont'"},
       {added("[[type]]\nname = 'house'\nradius = 1\narea = 1\n[[type.level]]\npolygons = 1\nvertices = 1"),
        "t.toml:30:8", "there are two types 'house'"},
       {added("[[camera.path]]\nname = 'walk'\n[[camera.path.leg]]\nkind = 'polyline'\npoints = "
              "[[0,0,0],[1,0,0]]\nframes = 2"),
        "t.toml:29:1", "there are two paths 'walk'"},
       {added(
            "[[cell]]\nname = 'a'\nlow = [0,0,0]\nhigh = [1,1,1]\n[[cell]]\nname = 'a'\nlow = [0,0,0]\nhigh = [1,1,1]"),
        "t.toml:34:8", "there are two cells 'a'"},
       {added("[[logic.task]]\nname = 'a'\ntime = '1ms'\n[[logic.task]]\nname = 'a'\ntime = '1ms'"), "t.toml:33:8",
        "'a'"},
       {added("[[logic.task]]\nname = 'a'\ntime = '1ms'\nafter = ['a']"), "t.toml:30:8", "'a'"},
       {added("[visibility]\nmethod = 'octree'"), "t.toml:30:10", "allowed: frustum, portals, cells"},
       {added("[visibility]\nmethod = 'portals'"), "t.toml:30:10", "needs cells"},
       {added("[visibility]\nmethod = 'cells'"), "t.toml:30:10", "needs sampled cell visibility"}});
}

TEST_CASE("cells and portals are checked", "[scene_file]") {
  const std::string cells =
      "[[cell]]\nname = 'a'\nlow = [0,0,0]\nhigh = [1,1,1]\n[[cell]]\nname = 'b'\nlow = [1,0,0]\nhigh = [2,1,1]\n";
  const auto portal = [&](const std::string& to, const std::string& corners) {
    return added(cells + "[[portal]]\nfrom = 'a'\nto = '" + to + "'\ncorners = " + corners);
  };
  const std::string square = "[[1,0,0],[1,1,0],[1,1,1],[1,0,1]]";
  check_all({{added("[[cell]]\nname = 'a'\nlow = [0,0,0]\nhigh = [1,-1,1]"), "t.toml:32:8",
              "y = -1 is not above that of 'low', 0"},
             {added("[[cell]]\nname = 'a'\nlow = [0,0,0]\nhigh = [1,1,0]"), "t.toml:32:8", "z = 0"},
             {portal("c", square), "t.toml:39:6", "unknown cell 'c'; allowed: a, b"},
             {portal("a", square), "t.toml:39:6", "leads to another cell"},
             {portal("b", "[[1,0,0],[1,1,0]]"), "t.toml:40:11", "found 2 points; allowed: 3 or more"},
             {portal("b", "[[1,0,0],[1,1,0],[1,2,0]]"), "t.toml:40:11", "on one line"}});
  const Scene scene = parse(portal("b", square));
  REQUIRE(scene.cells.size() == 2);
  REQUIRE(scene.portals.size() == 1);
  CHECK(scene.portals[0].to == 1);
  CHECK(scene.portals[0].corners.size() == 4);
  REQUIRE(scene.instances.cell.size() == 1);
  CHECK(scene.instances.cell[0] == kNoCell);
}

TEST_CASE("types have 1 to 255 levels, coarse to fine, or are continuous", "[scene_file]") {
  const auto levels = [](int count) {
    std::string text = "[[type.level]]\npolygons = 12";
    for (int i = 1; i < count; ++i) text = "[[type.level]]\npolygons = 1\nvertices = 1\n" + text;
    return with(16, text.substr(0, text.size() - 14));  // line 17 has the last one's polygons
  };
  CHECK(parse(levels(255)).types[0].levels.size() == 255);
  CHECK(says(refused(levels(256)), "t.toml:16:1", "found 256 levels; allowed: 1 to 255"));
  const std::string stated = "[[type.level]]\ncost = '0.5ms'\nbenefit = 100";
  const std::string continuous = "[type.continuous]\npolygons = 12\nvertices = 24\nshape = 'linear'";
  check_all({{with(16, "[[type.level]]\npolygons = 13\nvertices = 1\n[[type.level]]"), "t.toml:19:1", "coarse to fine"},
             {with(18, "vertices = 24\n" + continuous), "t.toml:19:1",
              "either [[type.level]] or [type.continuous], not both"},
             {with(16, stated + "\npolygons = 1\n[[type.level]]"), "t.toml:19:1", "unknown key 'polygons'"},
             {with(16, "[[type.level]]\ncost = '1ms'\n[[type.level]]"), "t.toml:16:1", "has no 'benefit'"},
             {with(16, "[[type.level]]\ncost = '0ms'\nbenefit = 1\n[[type.level]]"), "t.toml:17:8", "above 0s"},
             {with(16, "[[type.level]]\ncost = '1ms'\nbenefit = -1\n[[type.level]]"), "t.toml:18:11", "from 0 to"},
             {with(16, "[[type.level]]\ncost = '1ms'\nbenefit = 1\n" + stated + "\n[[type.level]]"), "t.toml:19:1",
              "coarse to fine"}});
  const Scene both = parse(with(16, stated + "\n[[type.level]]"));
  CHECK(*both.types[0].levels[0].stated_cost_s == 0.5e-3);
  CHECK(*both.types[0].levels[0].stated_benefit == 100);
  CHECK_FALSE(both.types[0].levels[1].stated_cost_s);
  const Scene curve =
      parse(with(16, "[type.continuous]\nshape = 'linear'\ndraws_scale_below_knee = true\nstand_in_levels = 3"));
  CHECK(curve.types[0].continuous);
  CHECK(curve.types[0].shape == CurveShape::linear);
  CHECK(curve.types[0].draws_scale_below_knee);
  CHECK(curve.types[0].stand_in_levels == 3);
  CHECK(curve.instances.kind[0] == ItemKind::curve);
}

TEST_CASE("view levels count only where the scene asks for them", "[scene_file]") {
  const std::string trunk =
      "vertices = 24\n[type.view_levels]\npart = 'trunk'\nsmallest_px = 2\nlargest_px = 5\ncylinders = 3\nthickest = "
      "'40cm'\n"
      "thinnest = '10cm'";
  CHECK(parse(with(18, trunk)).view_levels[0].part == ViewPart::none);
  std::string switched = with(18, trunk);
  switched.insert(switched.find("[screen]"), "representation = 'view-levels'\n");
  const ViewLevels levels = parse(switched).view_levels[0];
  CHECK(levels.part == ViewPart::trunk);
  CHECK(levels.smallest_px == 2);
  CHECK(levels.largest_px == 5);
  // A geometric series from 10 cm to 40 cm in 3: the ratio is 2.
  REQUIRE(levels.cylinder_diameter_m.size() == 3);
  CHECK(levels.cylinder_diameter_m[0] == Approx(0.1));
  CHECK(levels.cylinder_diameter_m[1] == Approx(0.2));
  CHECK(levels.cylinder_diameter_m[2] == Approx(0.4));
  const std::string part = "vertices = 24\n[type.view_levels]\npart = ";
  check_all(
      {{with(18, part + "'root'"), "t.toml:20:8", "allowed: trunk, leaves"},
       {with(18, part + "'leaves'\ncylinders = 3"), "t.toml:21:1", "unknown key 'cylinders'"},
       {with(18, part + "'leaves'\nsmallest_px = 3\nlargest_px = 2"), "t.toml:22:14", "from 3 to 200"},
       {with(18, part + "'leaves'\nleaf_area = 0"), "t.toml:21:13", "above 0"},
       {with(18, part + "'trunk'\ncylinders = 3\nthickest = '1m'\nthinnest = '2m'"), "t.toml:23:12", "thicker than"}});
}

TEST_CASE("an algorithm without costs on the machine is refused", "[scene_file]") {
  const std::string machine = "name = 'm'\nsource = 's'\n[machine.algorithm.flat]\npolygon = '1us'";
  CHECK(says(refused(with(11, machine)), "t.toml:10:1",
             "machine 'm' has no costs of the algorithm 'gouraud', which type 'house' uses"));
  CHECK(parse(with(11, machine + "\n[machine.algorithm.default]\npolygon = '2us'")).machine.name == "m");
}

TEST_CASE("parameters replace values at their paths", "[scene_file]") {
  const std::string text = added(
      "[parameters.count]\ndefault = 20\nlow = 2\nhigh = 100\nhelp = 'frames'\nsets = 'camera.path.0.leg.0.frames'\n"
      "[parameters.where]\ndefault = 1.5\nhelp = 'height'\nsets = ['instance.0.position.1', 'instance.0.scale']\n"
      "[parameters.part]\ndefault = 'flat'\nchoices = ['flat', 'gouraud']\nhelp = 'how'\nsets = "
      "'type.0.level.0.algorithm'\n"
      "[parameters.far]\ndefault = '2km'\nhelp = 'far plane'\nsets = 'screen.far'\n");
  // instance.0.scale and type.0.level.0.algorithm have to be there to be set.
  std::string full = text;
  full.replace(full.find("vertices = 24"), 13, "vertices = 24\nalgorithm = 'splats'");
  full.replace(full.find("[camera]"), 8, "scale = 9\n[camera]");
  const Scene plain = parse(full);  // the defaults
  CHECK(plain.camera.poses.size() == 20);
  CHECK(plain.instances.centre[0].y == 1.5);
  CHECK(plain.instances.radius_m[0] == 9.0f);  // 6 m * 1.5
  CHECK(plain.types[0].levels[0].algorithm == Algorithm::flat);
  CHECK(plain.screen.far_m == 2000);
  const Scene set =
      parse(full, {setting("count", "30"), setting("where", "2.5"), setting("part", "gouraud"), setting("far", "3km")});
  CHECK(set.camera.poses.size() == 30);
  CHECK(set.instances.centre[0].y == 2.5);
  CHECK(set.instances.radius_m[0] == 15.0f);
  CHECK(set.types[0].levels[0].algorithm == Algorithm::gouraud);
  CHECK(set.screen.far_m == 3000);

  const auto refuse = [&](const std::string& key, const std::string& value) {
    return refused(full, ".", {setting(key, value)});
  };
  CHECK(says(refuse("cuont", "3"), "command line", "unknown parameter 'cuont'; allowed: count, where, part, far"));
  CHECK(says(refuse("count", "1"), "command line", "whole number 2 .. 100"));
  CHECK(says(refuse("count", "2.5"), "command line", "not a whole number"));
  CHECK(says(refuse("where", "nan"), "command line", "not a finite number"));
  CHECK(says(refuse("part", "phong"), "command line", "allowed: flat, gouraud"));
  // A free text is judged where it lands, and the message says that it came from the command line.
  CHECK(says(refuse("far", "3miles"), "command line", "far: '3miles' has the unknown unit"));
  CHECK(says(refused(full, ".", {setting("far", "1km"), setting("far", "2km")}), "command line", "given twice"));
  CHECK(
      says(refused(text), "t.toml:35:1", "parameter 'where' sets 'instance.0.scale': there is no 'scale' in the file"));
  CHECK(says(refused(with(1, kScene[0]), ".", {setting("x", "1")}), "command line",
             "unknown parameter 'x'; allowed: none"));
}

TEST_CASE("declarations of parameters are checked", "[scene_file]") {
  const auto declared = [](const std::string& text) { return added("[parameters.p]\n" + text); };
  check_all(
      {{declared("help = 'h'\nsets = 'name'"), "t.toml:29:1", "[parameters.p] has no 'default'"},
       {declared("default = nan\nhelp = 'h'\nsets = 'name'"), "t.toml:30:11", "found nan"},
       {declared("default = [1]\nhelp = 'h'\nsets = 'name'"), "t.toml:30:11", "found a list"},
       {declared("default = 'a'\nlow = 1\nhelp = 'h'\nsets = 'name'"), "t.toml:31:7", "only numbers have limits"},
       {declared("default = 1\nchoices = ['1']\nhelp = 'h'\nsets = 'name'"), "t.toml:31:11", "only texts have choices"},
       {declared("default = 1\nlow = 3\nhigh = 2\nhelp = 'h'\nsets = 'name'"), "t.toml:32:8", "below 'low'"},
       {declared("default = 1\nlow = 3\nhelp = 'h'\nsets = 'name'"), "t.toml:30:11", "out of range"},
       {declared("default = 'c'\nchoices = ['a', 'b']\nhelp = 'h'\nsets = 'name'"), "t.toml:30:11", "allowed: a, b"},
       {declared("default = 1\nhelp = 'h'"), "t.toml:29:1", "has no 'sets'"},
       {declared("default = 1\nhelp = 'h'\nsets = []"), "t.toml:32:8", "no path"},
       {declared("default = 1\nhelp = 'h'\nsets = 'screen.depth'"), "t.toml:29:1", "there is no 'depth' in the file"},
       {declared("default = 1\nhelp = 'h'\nsets = 'instance.1.scale'"), "t.toml:29:1", "there is no '1' in the file"},
       {declared("default = 1\nhelp = 'h'\nsets = 'screen'"), "t.toml:29:1", "found a table there"},
       {declared("default = 1\nhelp = 'h'\nsets = 'parameters.p.low'"), "t.toml:29:1", "cannot set a parameter"},
       {added("[parameters]\np = 3"), "t.toml:30:5", "no table [parameters.p]"}});
}

TEST_CASE("a scene is described with its parameters", "[scene_file]") {
  const std::string text = added(
      "[parameters.count]\ndefault = 10\nlow = 2\nhigh = 100\nhelp = 'frames'\nsets = 'name'\n"
      "[parameters.far]\ndefault = '1km'\nhelp = 'far plane'\nsets = 'screen.far'");
  const SceneDescription description = describe_scene(text, "t.toml");
  CHECK(description.name == "t");
  CHECK(description.source == "a source");
  REQUIRE(description.parameters.size() == 2);
  CHECK(description.parameters[0].name == "count");
  CHECK(description.parameters[0].default_text == "10");
  CHECK(description.parameters[0].allowed == "whole number 2 .. 100");
  CHECK(description.parameters[1].allowed == "any text");
  CHECK(description.parameters[1].help == "far plane");
}

TEST_CASE("instances come from a CSV beside the scene", "[scene_file]") {
  const TempFolder folder;
  const std::string scene = added("[instances]\ncsv = 'a.csv'");
  const auto refused_csv = [&](const std::string& csv) {
    folder.write("a.csv", csv);
    return refused(scene, folder.path());
  };
  folder.write("a.csv", "type,x,y,z,scale\nhouse,1,2,3,2\nhouse,4,5,6,0.5\n");
  const Scene read = parse_scene(scene, "t.toml", folder.path(), {});
  REQUIRE(read.instances.size() == 3);  // one is inline
  CHECK(read.instances.centre[1] == glm::dvec3(1, 2, 3));
  CHECK(read.instances.radius_m[1] == 12.0f);
  CHECK(read.instances.area_m2[2] == 10.0f);  // 40 m^2 * 0.5^2
  const std::string csv = folder.path("a.csv");
  CHECK(says(refused_csv("type,x,y,z\nhose,1,2,3\n"), csv + ":2:1", "unknown type 'hose'; allowed: house"));
  CHECK(says(refused_csv("type,x,y,z\nhouse,1,nan,3\n"), csv + ":2:9", "y: 'nan'"));
  CHECK(says(refused_csv("type,x,y,z\nhouse,1,2e9,3\n"), csv + ":2:9", "from -1e+09 to 1e+09"));
  CHECK(says(refused_csv("type,x,y,z,scale\nhouse,1,2,3,-1\n"), csv + ":2:13", "scale: '-1' is out of range"));
  CHECK(says(refused_csv("type,x,y,z,cell\nhouse,1,2,3,hall\n"), csv + ":2:13", "unknown cell 'hall'"));
  CHECK(says(refused_csv("type,x,y\n"), csv + ":1", "no column 'z'"));
}

TEST_CASE("files beside the scene stay in its folder", "[scene_file]") {
  const TempFolder folder;
  std::filesystem::create_directory(folder.path("sub"));
  const auto named = [&](const std::string& name, const std::string& in) {
    return refused(added("[instances]\ncsv = '" + name + "'"), in);
  };
  CHECK(says(named("none.csv", folder.path()), "t.toml:30:7", "no such file"));
  CHECK(says(named("sub", folder.path()), "t.toml:30:7", "is a folder, not a file"));
  CHECK(says(named("../a.csv", folder.path()), "t.toml:30:7", "leads out of the scene's folder"));
  CHECK(says(named("sub/../../a.csv", folder.path()), "t.toml:30:7", "leads out of the scene's folder"));
  CHECK(says(named("/etc/passwd", folder.path()), "t.toml:30:7", "leads out of the scene's folder"));
  CHECK(says(named("a.csv", ""), "t.toml:30:7", "a built-in scene has no files beside it"));
  CHECK(says(refused(with(11, "use = 'none.toml'"), folder.path()), "t.toml:11:7", "no such file"));
  CHECK(says(refused(with(11, "use = '../m.toml'"), folder.path()), "t.toml:11:7", "leads out of the scene's folder"));
  folder.write("m.toml",
               "framesim = 1\n[machine]\nname = 'mine'\nsource = 's'\n[machine.algorithm.default]\npolygon = '1us'\n");
  CHECK(parse_scene(with(11, "use = 'm.toml'"), "t.toml", folder.path(), {}).machine.name == "mine");
}

TEST_CASE("recorded poses are one a row, in time", "[scene_file]") {
  const TempFolder folder;
  const auto scene = with(26, "kind = 'csv'\nfile = 'p.csv'\n[[camera.path.leg]]\nkind = 'polyline'");
  folder.write("p.csv", "t,x,y,z,fx,fy,fz\n0,1,2,3,0,0,-2\n0.5,4,5,6,3,0,0\n");
  const Scene read = parse_scene(scene, "t.toml", folder.path(), {});
  REQUIRE(read.camera.poses.size() == 12);  // 2 rows and 10 frames
  CHECK(read.camera.poses[0].eye == glm::dvec3(1, 2, 3));
  CHECK(read.camera.poses[0].forward == glm::dvec3(0, 0, -1));
  CHECK(read.camera.poses[1].forward == glm::dvec3(1, 0, 0));
  const std::string header = "t,x,y,z,fx,fy,fz\n", csv = folder.path("p.csv");
  const auto refused_poses = [&](const std::string& text) {
    folder.write("p.csv", text);
    return refused(scene, folder.path());
  };
  CHECK(says(refused_poses(header + "0,0,0,0,0,0,-1\n0,0,0,0,0,0,-1\n"), csv + ":3:1", "t: 0 s is not after 0 s"));
  CHECK(says(refused_poses(header + "1,0,0,0,0,0,-1\n0.5,0,0,0,0,0,-1\n"), csv + ":3:1", "0.5 s is not after 1 s"));
  CHECK(says(refused_poses(header + "0,0,0,0,0,0,0\n"), csv + ":2:9", "length 0"));
  CHECK(says(refused_poses(header + "0,0,inf,0,0,0,-1\n"), csv + ":2:5", "y: 'inf'"));
  CHECK(says(refused_poses(header), "t.toml:27:8", "has no poses"));
}

// Found by fuzzing: the TOML library's test for blanks was undefined for most of these. Two bytes each in UTF-8.
TEST_CASE("letters beyond ASCII in a key are refused at their place", "[scene_file]") {
  for (unsigned letter = 0xa1; letter <= 0x49a; ++letter) {
    const std::string bytes{static_cast<char>(0xc0 | (letter >> 6)), static_cast<char>(0x80 | (letter & 0x3f))};
    CAPTURE(letter);
    CHECK(says(refused(with(10, "[machine" + bytes + "x]")), "t.toml:10:9", "not TOML"));
  }
}

TEST_CASE("more instances than the limit are refused before they are made", "[scene_file]") {
  const std::string rows = "[[generator]]\nkind = 'rows'\ntype = 'house'\ncolumns = 100000\nrows = 161\n";
  CHECK(refused(added(rows)).rfind("t.toml:29:1: ", 0) == 0);
}

TEST_CASE("a scene file is refused before it is loaded", "[scene_file]") {
  const TempFolder folder;
  const auto load = [](const std::string& path) { return refusal([&] { load_scene_file(path); }); };
  CHECK(says(load(folder.path("none.toml")), folder.path("none.toml") + ":1", "no such file"));
  CHECK(says(load(folder.path()), folder.path() + ":1", "is a folder, not a file"));
  CHECK(says(load("/dev/zero"), "/dev/zero:1", "no regular file"));
  const std::string path = folder.write("big.toml", "");
  std::filesystem::resize_file(path, 1u << 30);  // a gigabyte without a line end, sparse
  CHECK(says(load(path), path + ":1", "has 1073741824 bytes; allowed: 16777216"));
  const std::string wide = folder.write("wide.toml", "framesim = 1\n# " + std::string(2 * kLongestLine, 'x') + "\n");
  CHECK(says(load(wide), wide + ":2", "a line of more than 1048576 bytes"));
}

TEST_CASE("a scene on disk is the scene in memory", "[scene_file]") {
  const TempFolder folder;
  const std::string path = folder.write("s.toml", with(28, kScene[27]));
  CHECK(load_scene({.name = path, .settings = {}, .where = {}}).camera.poses.size() == 10);
  // Windows line ends are line ends.
  std::string crlf;
  for (const std::string& line : kScene) crlf += line + "\r\n";
  CHECK(load_scene_file(folder.write("c.toml", crlf)).name == "t");
}

TEST_CASE("street has the numbers that its file states", "[scene_file][street]") {
  const Scene street = load_scene({.name = "street", .settings = {}, .where = {"here"}});
  CHECK(street.types.size() == 4);
  REQUIRE(street.instances.size() == 6);
  REQUIRE(street.camera.poses.size() == 40);
  CHECK(street.targets_s == std::vector<double>{0.016, 0.033});
  // Frame 0 at full detail: two houses as stated, shop and lamps by the machine's coefficients.
  const Machine machine(street.machine);
  const auto finest_ms = [&](std::size_t type) {
    return 1e3 * machine.draw_time(street.types[type].levels.back(), 0, 1, false).primitive_s;
  };
  CHECK(finest_ms(0) == Approx(8));
  CHECK(finest_ms(1) == Approx(2.3));
  CHECK(finest_ms(2) == Approx(0.31));
  CHECK(2 * finest_ms(0) + finest_ms(1) + 2 * finest_ms(2) == Approx(18.92));
  // 1 ms + 5 items of 0.1 ms, and beside it input, then physics: 0.4 + 0.6 ms.
  CHECK(street.logic.base_s + 5 * street.logic.per_item_s == Approx(1.5e-3));
  CHECK(to_seconds(StageGraph(street.logic.tasks).task_time()) == Approx(1e-3));
  // 30 frames forward at 1 m a frame, then 9 degrees a frame to the left.
  CHECK(street.camera.poses[12].eye.z == Approx(-12));
  CHECK(street.camera.poses[29].eye.z == Approx(-29));
  CHECK(street.camera.poses[29].forward.z == Approx(-1));
  CHECK(street.camera.poses[34].forward.x == Approx(-std::sqrt(0.5)));
  CHECK(street.camera.poses[39].forward.x == Approx(-1));
  // Lamps from the generator at x = -4 and 4; each instance stands in its cell.
  CHECK(street.instances.centre[4] == glm::dvec3(-4, 2, -40));
  CHECK(street.instances.centre[5] == glm::dvec3(4, 2, -40));
  CHECK(street.instances.cell == std::vector<std::uint16_t>{0, 0, 0, 1, 0, 0});
  CHECK(street.instances.kind[3] == ItemKind::curve);
  REQUIRE(street.effects.size() == 2);
  CHECK(to_string(street.effects[0]) == "vsync:rate=off");
  CHECK(to_string(street.effects[1]) == "semantics");
}

TEST_CASE("street takes its parameters", "[scene_file][street]") {
  const auto load = [](Settings settings) {
    return load_scene({.name = "street", .settings = std::move(settings), .where = {}});
  };
  CHECK(load({setting("lamps", "10")}).instances.size() == 14);
  CHECK(load({setting("path", "sweep")}).camera.poses.size() == 40);
  CHECK(load({setting("logic", "3ms")}).logic.base_s == 3e-3);
  CHECK(load({setting("vsync", "60Hz")}).effects[0].settings[0].value == "60Hz");
  CHECK(load({setting("visibility", "portals")}).visibility == VisibilityMethod::portals);
  const Scene points = load({setting("representation", "view-levels")});
  CHECK(points.view_levels[3].part == ViewPart::leaves);
  CHECK(points.instances.kind[3] == ItemKind::levels);
  CHECK(says(refusal([&] { load({setting("lamp", "10")}); }), "command line", "did you mean 'lamps'?"));
}

TEST_CASE("an unknown scene is answered with the legal set", "[scene_file]") {
  const auto load = [](const std::string& name) {
    return refusal([&] { load_scene({.name = name, .settings = {}, .where = {"command line"}}); });
  };
  CHECK(says(load("stret"), "command line", "unknown scene 'stret'; allowed: street, auditorium"));
  CHECK(says(load("none.toml"), "none.toml:1", "no such file"));
}

TEST_CASE("a scene file with any bytes changed is read or refused, never worse", "[scene_file][property]") {
  const BuiltIn& street = built_in_scenes().front();
  REQUIRE(street.name == "street");
  const RandomStream random(20250301, "scene-file-test");
  int refusals = 0;
  for (std::uint32_t round = 0; round < 400; ++round) {
    std::string text(street.text);
    for (std::uint32_t change = 0; change <= round % 3; ++change) {
      const std::size_t at = random.bits(0, round, 3 * change) % text.size();
      const auto byte = static_cast<char>(random.bits(0, round, 3 * change + 1) % 128);
      switch (random.bits(0, round, 3 * change + 2) % 3) {
        case 0:
          text[at] = byte;
          break;
        case 1:
          text.erase(at, 1);
          break;
        default:
          text.insert(at, 1, text[random.bits(1, round, change) % text.size()]);
          break;
      }
    }
    CAPTURE(round);
    std::string message;
    // refusal() lets everything but InputError through, which fails the test.
    REQUIRE_NOTHROW(message = refusal([&] { parse_scene(text, "s.toml", "", {}); }));
    if (message.empty()) continue;
    ++refusals;
    UNSCOPED_INFO(message);
    // Every refusal has file and line.
    CHECK((message.rfind("s.toml:", 0) == 0 && message.find_first_of("123456789", 7) == 7));
  }
  CHECK(refusals > 50);  // most changes hit a comment or a text
  CHECK(refusals < 400);
}
