// CATALOGUE.md names tests and scene files: they must be there, and every hard scene and test must be in it.
#include <filesystem>
#include <fstream>
#include <map>
#include <set>
#include <sstream>
#include <string>
#include <vector>

#include "tests/catch.h"
#include "tests/paths.h"

namespace {

namespace fs = std::filesystem;

const fs::path kHere = fs::path(framesim::kSourceFolder) / "tests/hard_cases";

std::string text_of(const fs::path& path) {
  std::ifstream file(path);
  std::stringstream text;
  text << file.rdbuf();
  return text.str();
}

struct Row {
  std::string group, name, hard, tests, scenes;
};

// The cells of a line "| a | b | ... |", without blanks around them; none for another line or for the rule below a
// heading.
std::vector<std::string> cells_of(const std::string& line) {
  std::vector<std::string> cells;
  if (line.rfind("| ", 0) != 0) return cells;
  std::size_t at = 1;
  for (std::size_t bar = line.find('|', at); bar != std::string::npos; bar = line.find('|', at)) {
    const std::size_t first = line.find_first_not_of(' ', at), last = line.find_last_not_of(' ', bar - 1);
    cells.push_back(first < bar ? line.substr(first, last - first + 1) : "");
    at = bar + 1;
  }
  return cells;
}

std::vector<Row> catalogue() {
  std::vector<Row> rows;
  std::stringstream text(text_of(kHere / "CATALOGUE.md"));
  bool heading = true;
  for (std::string line; std::getline(text, line);) {
    const std::vector<std::string> cells = cells_of(line);
    if (cells.empty()) continue;
    CAPTURE(line);
    REQUIRE(cells.size() == 5);
    if (!heading) rows.push_back({cells[0], cells[1], cells[2], cells[3], cells[4]});
    heading = false;
  }
  return rows;
}

// What stands between back quotes.
std::vector<std::string> quoted(const std::string& cell) {
  std::vector<std::string> words;
  for (std::size_t at = cell.find('`'); at != std::string::npos; at = cell.find('`', at)) {
    const std::size_t end = cell.find('`', at + 1);
    if (end == std::string::npos) break;
    words.push_back(cell.substr(at + 1, end - at - 1));
    at = end + 1;
  }
  return words;
}

// The names of all test cases below tests/, and the file of each.
std::map<std::string, fs::path> test_names() {
  const std::string begin = std::string("TEST_") + "CASE(\"";  // in two parts: this is none
  std::map<std::string, fs::path> names;
  for (const auto& entry : fs::recursive_directory_iterator(fs::path(framesim::kSourceFolder) / "tests")) {
    if (entry.path().extension() != ".cpp") continue;
    const std::string text = text_of(entry.path());
    for (std::size_t at = text.find(begin); at != std::string::npos; at = text.find(begin, at)) {
      at += begin.size();
      names[text.substr(at, text.find('"', at) - at)] = entry.path();
    }
  }
  return names;
}

}  // namespace

TEST_CASE("catalogue: every row has a group, a case, a reason, a test that exists and a scene that exists or none") {
  const std::vector<Row> rows = catalogue();
  const std::map<std::string, fs::path> names = test_names();
  REQUIRE(names.size() > 500);
  REQUIRE(rows.size() >= 60);
  std::set<std::string> cases, groups;
  for (const Row& row : rows) {
    CAPTURE(row.group, row.name);
    CHECK(row.hard.size() > 10);
    CHECK(cases.insert(row.group + ": " + row.name).second);
    groups.insert(row.group);
    const std::vector<std::string> tests = quoted(row.tests), scenes = quoted(row.scenes);
    CHECK(!tests.empty());
    for (const std::string& test : tests) {
      CAPTURE(test);
      CHECK(names.count(test) == 1);
    }
    CHECK((row.scenes == "-" || !scenes.empty()));
    for (const std::string& scene : scenes) {
      CAPTURE(scene);
      CHECK(fs::is_regular_file(kHere / "scenes" / scene));
    }
  }
  CHECK(groups == std::set<std::string>{"continuous", "control", "estimators", "geometry", "ratios", "statistics",
                                        "sums", "time"});
}

TEST_CASE("catalogue: every scene file and every test of the groups is in it") {
  std::set<std::string> tests, scenes, files;
  for (const Row& row : catalogue()) {
    files.insert(row.group + "_test.cpp");
    for (const std::string& test : quoted(row.tests)) tests.insert(test);
    for (const std::string& scene : quoted(row.scenes)) scenes.insert(scene);
  }
  for (const auto& entry : fs::directory_iterator(kHere / "scenes")) {
    const std::string file = entry.path().filename().string();
    CAPTURE(file);
    CHECK(scenes.count(file) == 1);
    CHECK(text_of(entry.path()).rfind("# Hard: ", 0) == 0);
  }
  for (const auto& [name, path] : test_names()) {
    if (path.parent_path() != kHere || files.count(path.filename().string()) == 0) continue;
    CAPTURE(name);
    CHECK(tests.count(name) == 1);
  }
}
