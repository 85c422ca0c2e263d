// --plot, through the binary: the pictures that are promised, whole, and nothing else.
#include <string>

#include "tests/catch.h"
#include "tests/experiments/program.h"

namespace framesim {

TEST_CASE("plot: two pictures for each scene and target") {
  const TestFolder folder;
  const ProgramRun run = run_program({"compare", "--scenes", "street", "--targets", "16ms,30fps", "--policies",
                                      "static,robin-hood", "--plot", folder.path("p"), "--quiet"});
  CAPTURE(run.err);
  REQUIRE(run.exit_code == 0);
  std::vector<std::string> names;
  for (const auto& entry : std::filesystem::directory_iterator(folder.path("p"))) {
    names.push_back(entry.path().filename().string());
  }
  std::sort(names.begin(), names.end());
  CHECK(names == std::vector<std::string>{"street-16ms-frame-time.svg", "street-16ms-levels.svg",
                                          "street-30fps-frame-time.svg", "street-30fps-levels.svg"});
  const std::string picture = folder.read("p/street-16ms-frame-time.svg");
  CHECK(picture.find("<svg") != std::string::npos);
  CHECK(picture.find("robin-hood") != std::string::npos);
  CHECK(picture.find("target 16ms") != std::string::npos);
  CHECK(picture.find("</svg>") != std::string::npos);
}

TEST_CASE("plot: a scene given as a path is no path in the picture's name") {
  const TestFolder folder;
  const ProgramRun run = run_program({"run", "graphicon-forest:trees=3,path=zigzag", "--policy", "static", "--frames",
                                      "3", "--target", "25ms", "--plot", folder.path(), "--quiet"});
  CAPTURE(run.err);
  REQUIRE(run.exit_code == 0);
  CHECK(folder.names() == std::vector<std::string>{"graphicon-forest-trees-3-path-zigzag-25ms-frame-time.svg",
                                                   "graphicon-forest-trees-3-path-zigzag-25ms-levels.svg"});
}

TEST_CASE("plot: a file in place of the folder is refused before the run") {
  const TestFolder folder;
  folder.write("file", "x");
  const ProgramRun run = run_program({"run", "street", "--policy", "static", "--plot", folder.path("file")});
  CHECK(run.exit_code == 2);
  CHECK(run.out.empty());
}

}  // namespace framesim
