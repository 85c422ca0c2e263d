// Scene files that are wrong: exit code 3 with file and line, at once, and nothing written.
#include <filesystem>
#include <string>

#include "scenes/registry.h"
#include "tests/catch.h"
#include "tests/experiments/program.h"

namespace framesim {
namespace {

bool has(const std::string& text, const std::string& part) { return text.find(part) != std::string::npos; }

std::string street() {
  for (const BuiltIn& scene : built_in_scenes()) {
    if (scene.name == "street") return std::string(scene.text);
  }
  FAIL("there is no scene 'street'");
  return {};
}

// The street with `from` replaced by `to`, once.
std::string street_with(const std::string& from, const std::string& to) {
  std::string text = street();
  const std::size_t at = text.find(from);
  REQUIRE(at != std::string::npos);
  return text.replace(at, from.size(), to);
}

// 1-based line of the first `word` in `text`.
long line_of(const std::string& text, const std::string& word) {
  const std::size_t at = text.find(word);
  REQUIRE(at != std::string::npos);
  return 1 + std::count(text.begin(), text.begin() + static_cast<long>(at), '\n');
}

// Runs the scene at `path`: refused with exit code 3, `where` is named, the frames file is not there.
void check_refused(const TestFolder& folder, const std::string& path, const std::string& where) {
  const std::vector<std::string> before = folder.names();
  const ProgramRun run =
      run_program({"run", path, "--policy", "static", "--target", "16ms", "--frames-out", folder.path("frames.csv")});
  CAPTURE(path, where, run.out, run.err);
  CHECK(run.exit_code == 3);
  CHECK(run.out.empty());
  CHECK(has(run.err, where));
  CHECK(folder.names() == before);
}

}  // namespace

TEST_CASE("scene input: the street from a file is the built-in street") {
  const TestFolder folder;
  const std::string path = folder.write("s.toml", street());
  const auto frames = [&](const std::string& scene) {
    const ProgramRun run =
        run_program({"run", scene, "--policy", "robin-hood", "--frames-out", folder.path("frames.csv")});
    REQUIRE(run.exit_code == 0);
    return folder.read("frames.csv");
  };
  CHECK(frames(path) == frames("street"));
}

TEST_CASE("scene input: an unknown key is refused at its line") {
  const TestFolder folder;
  const std::string text = street_with("fov_y =", "colour = 3\nfov_y =");
  const std::string path = folder.write("s.toml", text);
  check_refused(folder, path, path + ":" + std::to_string(line_of(text, "colour = 3")) + ":");
}

TEST_CASE("scene input: NaN is refused at its line") {
  const TestFolder folder;
  const std::string text = street_with("importance = 0.9", "importance = nan");
  const std::string path = folder.write("s.toml", text);
  check_refused(folder, path, path + ":" + std::to_string(line_of(text, "= nan")) + ":");
}

TEST_CASE("scene input: a missing CSV is refused where it is named") {
  const TestFolder folder;
  const std::string text = street() + "\n[instances]\ncsv = \"missing.csv\"\n";
  const std::string path = folder.write("s.toml", text);
  check_refused(folder, path, path + ":" + std::to_string(line_of(text, "missing.csv")) + ":");
}

TEST_CASE("scene input: a wrong number in a CSV is refused at the CSV's line") {
  const TestFolder folder;
  folder.write("i.csv", "type,x,y,z\nlamp,1,2,-5\nlamp,1,oops,-6\n");
  const std::string path = folder.write("s.toml", street() + "\n[instances]\ncsv = \"i.csv\"\n");
  check_refused(folder, path, "i.csv:3:");
}

TEST_CASE("scene input: a line beyond the limit is refused without being read to its end") {
  const TestFolder folder;
  const std::string path = folder.write("s.toml", "x = \"" + std::string(2'000'000, 'a') + "\"\n");
  check_refused(folder, path, path + ":1");
}

TEST_CASE("scene input: a file of 1 GB is refused by its size") {
  const TestFolder folder;
  const std::string path = folder.write("s.toml", "x = \"");
  std::filesystem::resize_file(path, 1'000'000'000);  // sparse: takes no space
  check_refused(folder, path, path + ":1");
}

TEST_CASE("scene input: a folder, a missing file and an empty file are refused") {
  const TestFolder folder;
  check_refused(folder, folder.path(""), folder.path(""));
  check_refused(folder, folder.path("none.toml"), folder.path("none.toml"));
  const std::string empty = folder.write("s.toml", "");
  check_refused(folder, empty, empty);
}

TEST_CASE("scene input: a machine file that is wrong is refused the same way") {
  const TestFolder folder;
  const std::string path = folder.write("m.toml", "[machine]\nname = \"m\"\nspeed = 3\n");
  const ProgramRun run = run_program({"run", "street", "--policy", "static", "--machine", path});
  CAPTURE(run.err);
  CHECK(run.exit_code == 3);
  CHECK(has(run.err, path + ":"));
}

TEST_CASE("scene input: the limit on instances and the bounds of the folder are options of run, compare and explain") {
  const TestFolder folder, outside;
  outside.write("a.csv", "type,x,y,z\nhouse,0,2,-30\n");
  const std::string csv =
      "../" + std::filesystem::path(outside.path("a.csv")).parent_path().filename().string() + "/a.csv";
  const std::string named =
      folder.write("named.toml", street_with("[[generator]]", "[instances]\ncsv = '" + csv + "'\n[[generator]]"));
  const std::string many = folder.write("many.toml", street_with("step_x = 8", "step_x = 8\nrows = 500000000000"));
  for (const std::string verb : {"run", "compare", "explain"}) {
    const auto call = [&](const std::vector<std::string>& more) {
      std::vector<std::string> words{verb};
      if (verb == "compare") words.push_back("--scenes");
      words.insert(words.end(), more.begin(), more.end());
      if (verb == "run") words.insert(words.end(), {"--policy", "static"});
      if (verb == "compare") words.insert(words.end(), {"--policies", "static"});
      const ProgramRun run = run_program(words);
      return run.exit_code == 0 ? "" : fmt::format("{}: {}", run.exit_code, run.err);
    };
    CAPTURE(verb);
    // 4 inline and 2 lamps.
    CHECK(call({"street", "--limit-instances", "6"}).empty());
    CHECK(has(call({"street", "--limit-instances", "5"}), "3: framesim: data/street.toml"));
    CHECK(has(call({"street", "--limit-instances", "5"}), "2 instances beside 4; allowed are 5"));
    CHECK(has(call({"street", "--limit-instances", "many"}), "2: framesim: command line"));
    CHECK(has(call({many}), "1000000000000 instances beside 4; allowed are 4000000"));
    CHECK(has(call({named}), "leads out of the scene's folder"));
    CHECK(call({named, "--allow-outside-paths"}).empty());
  }
}

}  // namespace framesim
