// The tree keeps its layers: who may include whom, and which folder a third-party library may show in.
#include <algorithm>
#include <filesystem>
#include <fstream>
#include <set>
#include <string>
#include <string_view>
#include <vector>

#include "tests/catch.h"
#include "tests/paths.h"

namespace {
namespace fs = std::filesystem;

const fs::path kRoot = framesim::kSourceFolder;

struct Include {
  std::string file;    // from the root: "sim/machine.cpp"
  std::string target;  // what stands between the quotes or brackets
  bool quoted = false;
};

bool starts_with_any(std::string_view text, const std::vector<std::string_view>& beginnings) {
  return std::any_of(beginnings.begin(), beginnings.end(), [&](std::string_view b) { return text.starts_with(b); });
}

void read_includes(const fs::path& path, std::vector<Include>& includes) {
  std::ifstream in(path);
  for (std::string line; std::getline(in, line);) {
    const std::size_t hash = line.find_first_not_of(" \t");
    if (hash == std::string::npos || line[hash] != '#') continue;
    const std::size_t word = line.find_first_not_of(" \t", hash + 1);
    if (word == std::string::npos || line.compare(word, 7, "include") != 0) continue;
    const std::size_t open = line.find_first_of("\"<", word);
    if (open == std::string::npos) continue;
    const bool quoted = line[open] == '"';
    const std::size_t close = line.find(quoted ? '"' : '>', open + 1);
    if (close == std::string::npos) continue;
    includes.push_back({fs::relative(path, kRoot).generic_string(), line.substr(open + 1, close - open - 1), quoted});
  }
}

std::vector<Include> all_includes() {
  std::vector<Include> includes;
  for (const char* folder : {"sim", "policies", "scenes", "experiments", "tests"}) {
    for (const fs::directory_entry& entry : fs::recursive_directory_iterator(kRoot / folder)) {
      const std::string extension = entry.path().extension().string();
      if (entry.is_regular_file() && (extension == ".h" || extension == ".cpp")) read_includes(entry.path(), includes);
    }
  }
  return includes;
}

// Included by `folder`, from this project, but from none of `allowed`.
std::vector<std::string> strangers(std::string_view folder, const std::vector<std::string_view>& allowed) {
  std::vector<std::string> found;
  for (const Include& include : all_includes()) {
    if (!include.file.starts_with(folder) || !include.quoted) continue;
    if (!starts_with_any(include.target, allowed)) found.push_back(include.file + " includes " + include.target);
  }
  return found;
}

// Files that include a header whose name begins with `library`, outside of `allowed`.
std::vector<std::string> leaks(std::string_view library, const std::vector<std::string_view>& allowed) {
  std::vector<std::string> found;
  for (const Include& include : all_includes()) {
    if (!include.target.starts_with(library)) continue;
    if (!starts_with_any(include.file, allowed)) found.push_back(include.file + " includes " + include.target);
  }
  return found;
}

const std::vector<std::string> kNone;

}  // namespace

TEST_CASE("the layering test sees the includes it judges") {
  // If the reader above found nothing, every case below would pass. This file includes <fstream> and "tests/catch.h".
  const auto includes = all_includes();
  const auto here = [&](std::string_view target, bool quoted) {
    return std::any_of(includes.begin(), includes.end(), [&](const Include& i) {
      return i.file == "tests/layering_test.cpp" && i.target == target && i.quoted == quoted;
    });
  };
  CHECK(here("fstream", false));
  CHECK(here("tests/catch.h", true));
  CHECK_FALSE(strangers("tests/layering_test.cpp", {"sim/"}).empty());
  CHECK_FALSE(leaks("fstream", {"sim/"}).empty());
}

TEST_CASE("sim includes nothing but sim") { CHECK(strangers("sim/", {"sim/"}) == kNone); }

TEST_CASE("policies include only sim and policies") { CHECK(strangers("policies/", {"sim/", "policies/"}) == kNone); }

TEST_CASE("scenes include only sim and scenes") { CHECK(strangers("scenes/", {"sim/", "scenes/"}) == kNone); }

TEST_CASE("no program code includes tests") {
  CHECK(strangers("experiments/", {"sim/", "policies/", "scenes/", "experiments/"}) == kNone);
}

TEST_CASE("third-party libraries show in their folders only") {
  CHECK(leaks("glm/", {"scenes/", "tests/scenes/"}) == kNone);
  CHECK(leaks("toml++/", {"scenes/"}) == kNone);
  CHECK(leaks("boost/graph", {"sim/stage_graph.cpp", "scenes/"}) == kNone);
  CHECK(leaks("boost/multiprecision", {"tests/", "experiments/stability/"}) == kNone);
  CHECK(leaks("boost/", {"sim/stage_graph.cpp", "scenes/", "experiments/stability/", "tests/"}) == kNone);
  CHECK(leaks("nlohmann/", {"scenes/importers/", "experiments/", "tests/"}) == kNone);
  CHECK(leaks("sqlite3", {"experiments/store/", "tests/experiments/"}) == kNone);
  CHECK(leaks("coin/", {"tests/policies/"}) == kNone);
  CHECK(leaks("CLI/", {"experiments/", "tests/experiments/"}) == kNone);
  CHECK(leaks("catch2/", {"tests/"}) == kNone);
  CHECK(leaks("benchmark/", {"experiments/bench/"}) == kNone);
  CHECK(leaks("systemc", {"experiments/bench/"}) == kNone);
  CHECK(leaks("ns3/", {"experiments/bench/"}) == kNone);
  CHECK(leaks("Random123/", {"sim/random_stream.cpp", "tests/sim/"}) == kNone);
}

TEST_CASE("unordered containers and the standard generators are used nowhere") {
  // Their order, or their numbers, differ between standard libraries; results must not depend on either.
  CHECK(leaks("unordered_map", {"tests/"}) == kNone);
  CHECK(leaks("unordered_set", {"tests/"}) == kNone);
  CHECK(leaks("random", {"tests/"}) == kNone);
}

TEST_CASE("the top level has the seven agreed names") {
  std::set<std::string> names;
  for (const fs::directory_entry& entry : fs::directory_iterator(kRoot)) {
    const std::string name = entry.path().filename().string();
    const bool made_by_builds = entry.is_directory() && (name.starts_with("build") || name == "results");
    if (!name.starts_with(".") && !made_by_builds) names.insert(name);
  }
  CHECK(names ==
        std::set<std::string>{"CMakeLists.txt", "README.md", "experiments", "policies", "scenes", "sim", "tests"});
}
