// What framesim reproduce prints, kept: DOCUMENT.csv beside this file, below a line that says which command makes it.
// After a change that is meant to move figures, run that command from the top of the source tree and see what moved.
#include <algorithm>
#include <filesystem>
#include <fstream>
#include <sstream>
#include <string>
#include <vector>

#include "experiments/reproduce/reproduce.h"
#include "tests/catch.h"
#include "tests/paths.h"

using namespace framesim;

namespace {

std::string folder() { return std::string(kSourceFolder) + "/tests/experiments/reproduce/"; }

std::string read_file(const std::string& path) {
  std::ifstream in(path, std::ios::binary);
  CAPTURE(path);
  REQUIRE(in.good());
  std::ostringstream text;
  text << in.rdbuf();
  return text.str();
}

std::vector<std::string> lines_of(const std::string& text) {
  std::vector<std::string> lines;
  std::istringstream in(text);
  for (std::string line; std::getline(in, line);) lines.push_back(line);
  return lines;
}

std::string first_line(std::string_view name) {
  const std::string make = "build/framesim reproduce " + std::string(name) + " --format csv";
  const std::string file = "tests/experiments/reproduce/" + std::string(name) + ".csv";
  return "# { echo \"$(head -1 " + file + ")\"; " + make + "; } > new.csv && mv new.csv " + file;
}

// Every figure as text: a difference in the last bit shows.
void check_golden(std::string_view name) {
  const auto& documents = reproduced_documents();
  const auto document = std::find_if(documents.begin(), documents.end(),
                                     [&](const ReproducedDocument& each) { return each.name == name; });
  REQUIRE(document != documents.end());
  const std::vector<Reproduction> found = {reproduce(*document, {.jobs = 2, .quiet = true})};
  std::vector<std::string> rerun = {first_line(name)};
  for (std::string& line : lines_of(format_reproduction(found, ReproduceFormat::csv))) rerun.push_back(std::move(line));
  const std::vector<std::string> kept = lines_of(read_file(folder() + std::string(name) + ".csv"));
  for (std::size_t i = 0; i < std::min(kept.size(), rerun.size()); ++i) CHECK(rerun[i] == kept[i]);
  CHECK(rerun.size() == kept.size());
}

}  // namespace

TEST_CASE("reproduce: every document has its kept table, and every kept table its document") {
  std::vector<std::string> kept, due;
  for (const auto& entry : std::filesystem::directory_iterator(folder())) {
    if (entry.path().extension() == ".csv") kept.push_back(entry.path().stem().string());
  }
  for (const ReproducedDocument& document : reproduced_documents()) due.push_back(std::string(document.name));
  std::sort(kept.begin(), kept.end());
  std::sort(due.begin(), due.end());
  CHECK(kept == due);
}

TEST_CASE("reproduce: dong's figures are those that are kept") { check_golden("dong"); }
TEST_CASE("reproduce: funkhouser's figures are those that are kept") { check_golden("funkhouser"); }
TEST_CASE("reproduce: srgge's figures are those that are kept") { check_golden("srgge"); }

// The sanitizers would take minutes for its runs; what they would see, tests of policies and scenes show them.
#if !defined(__SANITIZE_ADDRESS__)
TEST_CASE("reproduce: robin-hood's figures are those that are kept") { check_golden("robin-hood"); }
TEST_CASE("reproduce: zach's figures are those that are kept") { check_golden("zach"); }
#endif
