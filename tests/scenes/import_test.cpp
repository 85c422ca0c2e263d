// glTF 2.0 and 3D Tiles into scene files: numbers derived by hand, and hostile files refused with file, JSON pointer
// and reason.
#include <fmt/format.h>

#include <cmath>
#include <cstring>
#include <map>

#include "scenes/importers/importer.h"
#include "scenes/scene_file.h"
#include "tests/catch.h"

using namespace framesim;

namespace {

// Files in memory; counts what is asked for.
class MemoryFiles : public FilesBeside {
 public:
  std::optional<std::string> read(const std::string& uri, const std::function<void(std::string)>& refuse) override {
    const auto path = path_of_uri(uri);
    if (!path) refuse("outside: " + uri);
    const auto found = files.find(*path);
    return found == files.end() ? std::nullopt : std::optional(found->second);
  }
  std::map<std::string, std::string> files;
};

template <class T>
void put(std::string& bytes, T value) {
  bytes.append(reinterpret_cast<const char*>(&value), sizeof value);
}
std::string floats(const std::vector<float>& values) {
  std::string bytes;
  for (const float v : values) put(bytes, v);
  return bytes;
}

// Accessor 0: positions of a 2 x 4 x 6 box at (1,2,3) of 24 vertices; 1: 36 indices; 2: 12 indices; 3 to 5: buffer
// data.
const std::string kAccessors = R"("accessors":[
  {"count":24,"type":"VEC3","componentType":5126,"min":[0,0,0],"max":[2,4,6]},
  {"count":36,"type":"SCALAR","componentType":5123},{"count":12,"type":"SCALAR","componentType":5123},
  {"bufferView":0,"count":2,"type":"VEC3","componentType":5126},{"bufferView":0,"count":2,"type":"SCALAR","componentType":5126},
  {"bufferView":1,"count":2,"type":"VEC3","componentType":5126}],
  "bufferViews":[{"buffer":0,"byteLength":24},{"buffer":0,"byteOffset":24,"byteLength":24}],
  "buffers":[{"uri":"b.bin","byteLength":48}],
  "meshes":[{"primitives":[{"attributes":{"POSITION":0},"indices":1}]},{"primitives":[{"attributes":{"POSITION":0},"indices":2}]}])";

std::string gltf(const std::string& rest) { return R"({"asset":{"version":"2.0"},)" + kAccessors + "," + rest + "}"; }

ImportedScene read_gltf(const std::string& rest, MemoryFiles files = {}) {
  return import_gltf(gltf(rest), "m.gltf", files);
}

std::string error_of(const std::string& text, ImportScene import = import_gltf, MemoryFiles files = {}) {
  try {
    import(text, "m", files);
  } catch (const InputError& error) {
    return error.what();
  }
  return "no error";
}

std::string tileset(const std::string& root) {
  return R"({"asset":{"version":"1.0"},"geometricError":100,"root":)" + root + "}";
}
const std::string kBox = R"("boundingVolume":{"box":[0,0,0,5,0,0,0,5,0,0,0,5]})";

// An i3dm of a model of `triangles` in a 2 m cube at the origin.
std::string i3dm(const std::vector<float>& positions, int triangles) {
  std::string json = fmt::format(R"({{"INSTANCES_LENGTH":{},"POSITION":{{"byteOffset":0}}}})", positions.size() / 3);
  while (json.size() % 8 != 0) json += ' ';
  const std::string model =
      fmt::format(R"({{"asset":{{"version":"2.0"}},"accessors":[{{"count":8,"type":"VEC3","componentType":5126,
    "min":[-1,-1,-1],"max":[1,1,1]}},{{"count":{},"type":"SCALAR","componentType":5123}}],
    "meshes":[{{"primitives":[{{"attributes":{{"POSITION":0}},"indices":1}}]}}]}})",
                  triangles * 3);
  const std::string binary = floats(positions);
  std::string bytes = "i3dm";
  put(bytes, std::uint32_t{1});
  put(bytes, static_cast<std::uint32_t>(32 + json.size() + binary.size() + model.size()));
  put(bytes, static_cast<std::uint32_t>(json.size()));
  put(bytes, static_cast<std::uint32_t>(binary.size()));
  put(bytes, std::uint32_t{0});
  put(bytes, std::uint32_t{0});
  put(bytes, std::uint32_t{1});
  return bytes + json + binary + model;
}

}  // namespace

TEST_CASE("glTF nodes become instances with their parents' transforms, and meshes their counts and bounds") {
  // Node 0 moves by (10,0,0) and doubles; node 1 below it moves by (0,1,0): the middle (1,2,3) of the mesh comes to
  // 10 + 2 * (1, 3, 3) = (12, 6, 6). Radius sqrt(4 + 16 + 36) / 2, area (8 + 24 + 12) / 2 = 22.
  const ImportedScene s = read_gltf(R"("nodes":[{"translation":[10,0,0],"scale":[2,2,2],"children":[1]},
    {"translation":[0,1,0],"mesh":0,"name":"box"},{"mesh":0}])");
  REQUIRE(s.types.size() == 1);  // the same numbers are the same type
  REQUIRE(s.instances.size() == 2);
  CHECK(s.types[0].name == "box");
  CHECK(s.types[0].radius_m == Approx(std::sqrt(56.0) / 2));
  CHECK(s.types[0].area_m2 == Approx(22));
  CHECK(s.types[0].levels == std::vector<ImportedFacts>{{.polygons = 12, .vertices = 24, .draws = 1}});
  CHECK(s.instances[0].centre == glm::dvec3(12, 6, 6));
  CHECK(s.instances[0].scale == Approx(2));
  CHECK(s.instances[1].centre == glm::dvec3(1, 2, 3));
}

TEST_CASE("MSFT_lod gives levels from coarse to fine, and its nodes stand nowhere by themselves") {
  const ImportedScene s = read_gltf(R"("nodes":[{"mesh":0,"extensions":{"MSFT_lod":{"ids":[1]}}},{"mesh":1}])");
  REQUIRE(s.instances.size() == 1);
  REQUIRE(s.types[0].levels.size() == 2);
  CHECK(s.types[0].levels[0].polygons == 4);
  CHECK(s.types[0].levels[1].polygons == 12);
}

TEST_CASE("EXT_mesh_gpu_instancing gives as many instances as its accessors hold, from the buffer beside the file") {
  MemoryFiles files;
  files.files["b.bin"] = floats({0, 0, 0, 100, 0, 0, 1, 1, 1, 3, 3, 3});
  const ImportedScene s = read_gltf(
      R"("nodes":[{"mesh":0,"extensions":{"EXT_mesh_gpu_instancing":{"attributes":{"TRANSLATION":3,"SCALE":5}}}}])",
      files);
  REQUIRE(s.instances.size() == 2);
  CHECK(s.instances[0].centre == glm::dvec3(1, 2, 3));
  CHECK(s.instances[1].centre == glm::dvec3(103, 6, 9));  // 3 * (1,2,3) + (100,0,0)
  CHECK(s.instances[1].scale == Approx(3));
}

TEST_CASE("an animated camera of a glTF file becomes one pose for each thirtieth of a second") {
  MemoryFiles files;  // times 0 and 0.1 s come from the first two floats of view 0; from (0, 0, 0) to (3, 3, 3)
  files.files["b.bin"] = floats({0, 0.1f, 0, 0, 0, 0, 0, 0, 0, 3, 3, 3});
  const ImportedScene s = read_gltf(
      R"("nodes":[{"mesh":0},{"camera":0}],"cameras":[{"type":"perspective","perspective":{"yfov":1,"znear":1}}],
    "animations":[{"channels":[{"sampler":0,"target":{"node":1,"path":"translation"}}],"samplers":[{"input":4,"output":5}]}])",
      files);
  REQUIRE(s.poses.size() == 4);  // 0, 1/30, 2/30, 3/30 s
  CHECK(s.fov_y_rad == 1);
  CHECK(s.poses[1].eye.x == Approx(1).epsilon(1e-6));
  CHECK(s.poses[3].eye.x == Approx(3).epsilon(1e-6));
  CHECK(s.poses[3].forward == glm::dvec3(0, 0, -1));
}

TEST_CASE("an imported scene that no scene file can say is refused before it is written") {
  // Found by fuzzing: a camera that an animation leads beyond 1e9 m was written, and then refused when it was read.
  MemoryFiles files;
  files.files["b.bin"] = floats({0, 0.1f, 0, 0, 0, 0, 0, 0, 0, 3, 3, -5e11f});
  const ImportedScene far_camera = read_gltf(
      R"("nodes":[{"mesh":0},{"camera":0}],"cameras":[{"type":"perspective","perspective":{"yfov":1,"znear":1}}],
    "animations":[{"channels":[{"sampler":0,"target":{"node":1,"path":"translation"}}],"samplers":[{"input":4,"output":5}]}])",
      files);
  const auto refused = [](const ImportedScene& scene, const std::string& message) {
    try {
      write_scene(scene, "s");
      FAIL("written");
    } catch (const InputError& error) {
      INFO(error.what());
      CHECK(std::string(error.what()).find(message) != std::string::npos);
    }
  };
  refused(far_camera, "m.gltf: the camera at 0.99");
  ImportedScene scene;
  scene.title = "t";
  scene.instances.push_back({scene.type("a", 1, 1, {{.polygons = 1}}), {0, 0, 0}, 1});
  CHECK_FALSE(write_scene(scene, "s").scene.empty());
  scene.instances[0].centre.z = 999'999'999;
  refused(scene, "t: the assumed path of the camera leads to 0, 0.21650635094610965, 1000000002.46");
  scene.instances[0].centre.z = 0;
  scene.types[0].radius_m = 1e9;  // a cube around it has a half diagonal of sqrt(3) times that
  refused(scene, "t: a scene of 1732050807.568877");
  scene.types[0].radius_m = 0;
  refused(scene, "t: 'a': a radius of 0; allowed: above 0 and up to 1e+09");
  scene.types[0].radius_m = 1;
  scene.types[0].levels[0].vertices = 2e12;
  refused(scene, "t: 'a': a level of 2000000000000; allowed: from 0 to 1e+12");
}

TEST_CASE("a chain of 3D Tiles with equally many i3dm instances becomes those instances with the tiles as levels") {
  MemoryFiles files;
  files.files["far.i3dm"] = i3dm({0, 0, 0, 10, 0, 0}, 2);
  files.files["near.i3dm"] = i3dm({0, 0, 0, 10, 0, 5}, 2076);
  const std::string text = tileset("{" + kBox + R"(,"geometricError":10,"refine":"REPLACE","content":{"uri":"far.i3dm"},
    "transform":[1,0,0,0,0,1,0,0,0,0,1,0,0,100,0,1],
    "children":[{)" + kBox + R"(,"geometricError":0,"content":{"url":"near.i3dm"}}]})");
  const ImportedScene s = import_tiles(text, "tileset.json", files);
  REQUIRE(s.types.size() == 1);
  REQUIRE(s.types[0].levels.size() == 2);
  CHECK(s.types[0].levels[0].polygons == 2);
  CHECK(s.types[0].levels[1].polygons == 2076);
  CHECK(s.types[0].radius_m == Approx(std::sqrt(3.0)));
  REQUIRE(s.instances.size() == 2);
  // z is up in a tileset, y in a scene: (10, 100, 5) becomes (10, 5, -100).
  CHECK(s.instances[1].centre == glm::dvec3(10, 5, -100));
}

TEST_CASE("tiles that ADD stay beside their children; what several tiles replace is left out, and said") {
  MemoryFiles files;
  for (const char* name : {"a", "b", "c", "r"})
    files.files[std::string(name) + ".i3dm"] = i3dm({0, 0, 0}, 10 + name[0] - 'a');
  const auto leaf = [](const std::string& name) {
    return "{" + kBox + R"(,"geometricError":0,"content":{"uri":")" + name + R"(.i3dm"}})";
  };
  const std::string children = ",\"children\":[" + leaf("a") + "," + leaf("b") + "]}";
  const std::string root = "{" + kBox + R"(,"geometricError":10,"content":{"uri":"r.i3dm"},"refine":)";
  const ImportedScene adds = import_tiles(tileset(root + "\"ADD\"" + children), "t", files);
  CHECK(adds.instances.size() == 3);
  CHECK(adds.notes().empty());
  const ImportedScene replaces = import_tiles(tileset(root + "\"REPLACE\"" + children), "t", files);
  CHECK(replaces.instances.size() == 2);
  CHECK(replaces.notes().count("content that several tiles replace is left out") == 1);
}

TEST_CASE("a tileset names others by URI, each once, and contents that are not there are assumed and said") {
  MemoryFiles files;
  files.files["sub/inner.json"] = tileset("{" + kBox + R"(,"geometricError":1,"content":{"uri":"x.i3dm"}})");
  files.files["sub/x.i3dm"] = i3dm({0, 0, 0}, 7);  // found from the inner tileset's own folder
  const auto outer = [](const std::string& tiles) {
    return tileset("{" + kBox + R"(,"geometricError":10,"refine":"ADD","children":[)" + tiles + "]}");
  };
  const std::string inner = "{" + kBox + R"(,"geometricError":5,"content":{"uri":"sub/inner.json"}})";
  const ImportedScene s = import_tiles(outer(inner), "t", files);
  REQUIRE(s.instances.size() == 1);
  CHECK(s.types[0].levels[0].polygons == 7);
  CHECK(error_of(outer(inner + "," + inner), import_tiles, files) ==
        "m: /root/children/1/content/uri: a tileset that is there already");
  // 10 m cube: mean projected area 150 m2; squares of 5 m: 4 * 150 / 25 = 24 polygons.
  const ImportedScene missing =
      import_tiles(outer("{" + kBox + R"(,"geometricError":5,"content":{"uri":"no.b3dm"}})"), "t", files);
  CHECK(missing.types[0].levels[0].polygons == 24);
  CHECK(missing.notes().size() == 1);
}

TEST_CASE("hostile glTF files are refused with JSON pointer and reason") {
  const auto refused = [](const std::string& rest, const std::string& message) {
    CAPTURE(rest);
    CHECK(error_of(gltf(rest)) == "m: " + message);
  };
  CHECK(error_of("{\"asset\":\n {\"version\" 2}}") == "m:2:13: not JSON");
  CHECK(error_of("{\"asset\":{\"version\":\"1.0\"}}") == "m: /asset/version: found '1.0'; expected 2.0");
  CHECK(error_of("[1]") == "m: /: found an array of 1; expected an object");
  refused(R"("nodes":[{"mesh":9}])", "/nodes/0/mesh: found 9; expected an index of one of 2 meshes");
  refused(R"("nodes":[{"mesh":-1}])", "/nodes/0/mesh: found -1; expected an index of one of 2 meshes");
  refused(R"("nodes":[{"mesh":0.5}])", "/nodes/0/mesh: found 0.5; expected an index of one of 2 meshes");
  refused(R"("nodes":[{"children":[1]},{"children":[0]}])", "/nodes/0/children: the node is above itself");
  refused(R"("nodes":[{"children":[2]},{"children":[2]},{}])", "/nodes/1/children/0: node 2 has two parents");
  refused(R"("nodes":[{"mesh":0,"extensions":{"MSFT_lod":{"ids":[0]}}}])",
          "/nodes/0/extensions/MSFT_lod/ids/0: a level of detail of itself");
  refused(R"("nodes":[{"mesh":0,"translation":[1,2]}])", "/nodes/0/translation: found 2 elements; expected 3");
  refused(R"("nodes":[{"mesh":0,"scale":[1e8,1,1]}])", "/nodes/0: stands at 100000000, 2, 3 with a scale of 100000000");
  refused(R"("nodes":[{}])", "/: no node of the scene has a mesh");
  const std::string many =
      R"("nodes":[{"mesh":0,"extensions":{"EXT_mesh_gpu_instancing":{"attributes":{"TRANSLATION":3}}}}])";
  refused(many, "/accessors/3: needs the buffer 'b.bin', which is not there");
  MemoryFiles shorter;
  shorter.files["b.bin"] = "12345678";
  CHECK(error_of(gltf(many), import_gltf, shorter) == "m: /accessors/3: reaches byte 24 of a buffer of 8");
  MemoryFiles huge;
  huge.files["b.bin"] = std::string(48, '\x7f');
  CHECK(error_of(gltf(many), import_gltf, huge) == "m: /accessors/3: value 0 of element 0 is 3.3961513649220713e+38");
  huge.files["b.bin"] = floats({0, std::nanf(""), 0, 0, 0, 0});
  CHECK(error_of(gltf(many), import_gltf, huge) == "m: /accessors/3: value 1 of element 0 is nan");
  std::string out = gltf(many);
  out.replace(out.find("b.bin"), 5, "../b.bin");
  CHECK(error_of(out) == "m: /buffers/0/uri: outside: ../b.bin");
  CHECK(error_of("glTF") == "m: not a binary glTF: 4 bytes; its headers take 20");
}

TEST_CASE("hostile tilesets are refused with JSON pointer and reason") {
  const auto refused = [](const std::string& root, const std::string& message, MemoryFiles files = {}) {
    CAPTURE(root);
    CHECK(error_of(tileset(root), import_tiles, std::move(files)) == "m: " + message);
  };
  refused("{}", "/root: has no member 'boundingVolume'");
  refused("{" + kBox + "}", "/root: has no member 'geometricError'");
  refused("{" + kBox + R"(,"geometricError":-1})", "/root/geometricError: found -1; expected a number in 0 .. 1e+300");
  refused("{" + kBox + R"(,"geometricError":1,"refine":"SWAP"})", "/root/refine: expected ADD or REPLACE");
  refused("{" + kBox + R"(,"geometricError":1,"content":{"uri":"../../etc/passwd"}})",
          "/root/content/uri: outside: ../../etc/passwd");
  refused("{" + kBox + R"(,"geometricError":1,"content":{"uri":"%2e%2e/x"}})", "/root/content/uri: outside: %2e%2e/x");
  refused("{" + kBox + R"(,"geometricError":1})", "/root: no tile has anything to draw");
  MemoryFiles files;
  files.files["x.i3dm"] = i3dm({0, 0, 0}, 5).substr(0, 40);
  const std::string root = "{" + kBox + R"(,"geometricError":1,"content":{"uri":"x.i3dm"}})";
  CHECK(error_of(tileset(root), import_tiles, files).starts_with("x.i3dm: it says "));
  std::string liar = i3dm({0, 0, 0}, 5);
  liar.replace(liar.find("LENGTH\":1"), 9, "LENGTH\":9");
  files.files["x.i3dm"] = liar;  // 9 instances in 12 bytes
  CHECK(error_of(tileset(root), import_tiles, files) ==
        "x.i3dm: /INSTANCES_LENGTH: found 9; expected a whole number in 0 .. 2");
  // A chain of 200 tiles: their pointers would take the square of the file's size.
  std::string deep = root;
  for (int i = 0; i < 200; ++i) deep = "{" + kBox + R"(,"geometricError":1,"children":[)" + deep + "]}";
  CHECK(error_of(tileset(deep), import_tiles).find("more than 100 tiles below each other") != std::string::npos);
}

TEST_CASE("deeply nested JSON and every cut of a good file are refused or read, never a crash") {
  CHECK(error_of(std::string(100'000, '[')).find("not JSON") != std::string::npos);
  const std::string nested =
      R"({"asset":{"version":"2.0"},"extras":)" + std::string(50'000, '[') + std::string(50'000, ']') + "}";
  CHECK(error_of(nested) == "m: /: no node of the scene has a mesh");
  const std::string good = gltf(R"("nodes":[{"mesh":0}])");
  for (std::size_t cut = 0; cut < good.size(); ++cut)
    CHECK(error_of(good.substr(0, cut)).find("not JSON") != std::string::npos);
  MemoryFiles files;
  const std::string whole = i3dm({0, 0, 0, 1, 1, 1}, 5);
  for (std::size_t cut = 0; cut < whole.size(); ++cut) {
    files.files["x.i3dm"] = whole.substr(0, cut);
    CHECK(error_of(tileset("{" + kBox + R"(,"geometricError":1,"content":{"uri":"x.i3dm"}})"), import_tiles, files) !=
          "no error");
  }
}

TEST_CASE("a small file cannot ask for more instances than it has bytes") {
  // 60 nodes that share an accessor of 4096 instances: 245,760 from a file of 50 kB beside 3 kB of JSON.
  std::string text = gltf("");
  const auto replace = [&](const std::string& from, const std::string& to) {
    text.replace(text.find(from), from.size(), to);
  };
  replace(R"({"bufferView":0,"count":2,"type":"VEC3")", R"({"bufferView":0,"count":4096,"type":"VEC3")");
  std::string nodes = R"("nodes":[)";
  for (int i = 0; i < 60; ++i)
    nodes += R"({"mesh":0,"extensions":{"EXT_mesh_gpu_instancing":{"attributes":{"TRANSLATION":3}}}},)";
  nodes.back() = ']';
  text.insert(text.size() - 1, nodes);
  MemoryFiles files;
  files.files["b.bin"] = std::string(4096 * 12, '\0');
  const std::string error = error_of(text, import_gltf, files);
  CAPTURE(error);
  CHECK(error.starts_with("m: /nodes/"));
  CHECK(error.ends_with("the file has more instances than bytes"));
}

TEST_CASE("what is imported is written as a scene file that reads back with the same instances") {
  MemoryFiles files;
  files.files["b.bin"] = floats({0, 0.1f, 0, 0, 0, 0, 0, 0, 0, 3, 3, 3});
  const ImportedScene s = read_gltf(
      R"("nodes":[{"mesh":0,"name":"it's \"a\" box\n"},{"mesh":1,"name":"x","translation":[0,0,-50]}])", files);
  const SceneFiles written = write_scene(s, "made");
  // The CSV beside it is put in as [[instance]] tables, so that no file is needed here.
  std::string toml = written.scene;
  const std::string from = "\n[instances]\ncsv = \"made-instances.csv\"\n";
  REQUIRE(toml.find(from) != std::string::npos);
  std::string inline_tables;
  for (const ImportedInstance& i : s.instances) {
    inline_tables += fmt::format("\n[[instance]]\ntype = \"{}\"\nposition = [{}, {}, {}]\nscale = {}\n",
                                 s.types[i.type].name, i.centre.x, i.centre.y, i.centre.z, i.scale);
  }
  toml.replace(toml.find(from), from.size(), inline_tables);
  const Scene scene = parse_scene(toml, "made.toml", "");
  CHECK(scene.instances.size() == 2);
  CHECK(scene.types[0].name == "it-s-a-box");
  CHECK(scene.types[0].levels[0].polygons == 12);
  CHECK(scene.camera.poses.size() > 300);
}

TEST_CASE("URIs: what leads out of the folder is no path") {
  CHECK(path_of_uri("a%20b/c.bin?x=1#y") == "a b/c.bin");
  for (const char* uri :
       {"", "/etc/passwd", "../x", "a/../../x", "%2e%2e/x", "http://x/y", "file:x", "a%00b", "a\\..\\x", "%zz", "a%2"})
    CHECK_FALSE(path_of_uri(uri));
}
