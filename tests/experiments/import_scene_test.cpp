// framesim import scene, from outside: what it writes runs.
#include "tests/experiments/program.h"
#include "tests/experiments/shared_data.h"

using namespace framesim;

namespace {

bool has(const std::string& text, const std::string& part) { return text.find(part) != std::string::npos; }

constexpr const char* kModel = R"({"asset":{"version":"2.0"},
  "accessors":[{"count":24,"type":"VEC3","componentType":5126,"min":[-1,0,-1],"max":[1,4,1]},
               {"count":36,"type":"SCALAR","componentType":5123},{"count":12,"type":"SCALAR","componentType":5123}],
  "meshes":[{"primitives":[{"attributes":{"POSITION":0},"indices":1}]},{"primitives":[{"attributes":{"POSITION":0},"indices":2}]}],
  "nodes":[{"name":"tower","mesh":0,"extensions":{"MSFT_lod":{"ids":[1]}}},{"mesh":1}],"scenes":[{"nodes":[0]}]})";

}  // namespace

TEST_CASE("import scene writes a scene file that run accepts") {
  const TestFolder folder;
  const std::string model = folder.write("model.gltf", kModel), out = folder.path("town.toml");
  const ProgramRun import = run_program({"import", "scene", model, "--output", out});
  CAPTURE(import.out, import.err);
  REQUIRE(import.exit_code == 0);
  CHECK(has(import.out, "1 types, 1 instances"));
  CHECK(has(import.out, "primitives 4 12"));
  CHECK(folder.names() == std::vector<std::string>{"model.gltf", "town-instances.csv", "town.toml"});
  const ProgramRun run = run_program({"run", out, "--policy", "full-detail", "--frames", "5", "--quiet"});
  CAPTURE(run.err);
  CHECK(run.exit_code == 0);
  CHECK(has(run.out, "town.toml: model.gltf"));
}

TEST_CASE("import scene refuses what it cannot read or write, and leaves nothing behind") {
  const TestFolder folder;
  const std::string model = folder.write("model.gltf", kModel), toml = folder.path("x.toml");
  CHECK(run_program({"import", "scene", folder.path("none.gltf"), "-o", toml}).exit_code == 3);
  CHECK(run_program({"import", "scene", folder.path(), "-o", toml}).exit_code == 3);
  CHECK(run_program({"import", "scene", model, "-o", folder.path("x.txt")}).exit_code == 2);
  CHECK(run_program({"import", "scene", model, "-o", folder.path("none/x.toml")}).exit_code == 2);
  const std::string other = folder.write("other.json", "{}");
  const ProgramRun neither = run_program({"import", "scene", other, "-o", toml});
  CHECK(neither.exit_code == 3);
  CHECK(has(neither.err, "other.json: neither glTF 2.0 nor a 3D Tiles tileset"));
  // A link that leads out of the file's folder is a way out, too.
  const TestFolder elsewhere;
  elsewhere.write("b.bin", std::string(24, '\0'));
  std::filesystem::create_symlink(elsewhere.path("b.bin"), folder.path("b.bin"));
  const std::string linked =
      folder.write("linked.gltf", R"({"asset":{"version":"2.0"},"buffers":[{"uri":"b.bin","byteLength":24}],
    "bufferViews":[{"buffer":0,"byteLength":24}],"accessors":[{"count":2,"type":"VEC3","componentType":5126,"bufferView":0,"min":[0,0,0],
    "max":[1,1,1]}],"meshes":[{"primitives":[{"attributes":{"POSITION":0},"mode":0}]}],
    "nodes":[{"mesh":0,"extensions":{"EXT_mesh_gpu_instancing":{"attributes":{"TRANSLATION":0}}}}]})");
  const ProgramRun out = run_program({"import", "scene", linked, "-o", toml});
  CHECK(out.exit_code == 3);
  CHECK(has(out.err, "linked.gltf: /buffers/0/uri: 'b.bin' leads out of the folder"));
  CHECK(folder.names() == std::vector<std::string>{"b.bin", "linked.gltf", "model.gltf", "other.json"});
}

TEST_CASE(
    "real tilesets: 25 trees of 2,076 and of 2 triangles, and a chain of three tiles whose contents are not there") {
  const auto samples = shared_data("scenes/3dtiles-samples");
  if (!samples) return;
  const TestFolder folder;
  namespace fs = std::filesystem;
  const std::string trees = *samples + "/1.0_TilesetWithTreeBillboards_";  // stored under a longer name each
  fs::copy(trees + "tileset.json", folder.path("tileset.json"));
  fs::copy(trees + "tree.i3dm", folder.path("tree.i3dm"));
  fs::copy(trees + "tree_billboard.i3dm", folder.path("tree_billboard.i3dm"));
  const ProgramRun import =
      run_program({"import", "scene", folder.path("tileset.json"), "-o", folder.path("trees.toml")});
  CAPTURE(import.out, import.err);
  REQUIRE(import.exit_code == 0);
  CHECK(has(import.out, "1 types, 25 instances"));
  CHECK(has(import.out, "primitives 2 2076"));
  CHECK(
      run_program({"run", folder.path("trees.toml"), "--policy", "funkhouser", "--frames", "3", "--quiet"}).exit_code ==
      0);
  const ProgramRun dragon = run_program({"import", "scene", *samples + "/1.0_TilesetWithDiscreteLOD_tileset.json"});
  CHECK(dragon.exit_code == 0);
  CHECK(has(dragon.out, "contents that are not there: polygons assumed from geometricError and bounds (3 times)"));
}
