// framesim report through the binary, and the rows of frames that it reads.
#include <filesystem>

#include "experiments/report/embedded.h"
#include "experiments/store/store.h"
#include "tests/experiments/store/store_files.h"

namespace framesim {
namespace {

ProgramRun report(const TestFolder& folder, std::vector<std::string> more = {}) {
  std::vector<std::string> arguments = {"report", folder.path("s.sqlite"), "-o", folder.path("r.html")};
  arguments.insert(arguments.end(), more.begin(), more.end());
  return run_program(arguments);
}

bool has(const std::string& text, const std::string& part) { return text.find(part) != std::string::npos; }

}  // namespace

TEST_CASE("report: the frames that a store gives back have the hash of those that were run") {
  const TestFolder folder;
  folder.write("sweep.toml", kSmallSweep);
  REQUIRE(run_program({"sweep", folder.path("sweep.toml"), "--store", folder.path("s.sqlite"), "-q"}).exit_code == 0);
  const Store store = Store::open(folder.path("s.sqlite"));
  REQUIRE(store.runs().size() == 12);
  for (const StoredRun& run : store.runs()) {
    CAPTURE(run.id);
    CHECK(store.records(run.id).size() == 20);
    CHECK(hash(store.records(run.id)) == run.result.records_hash);
  }
}

TEST_CASE("report: a store becomes one page; what is wrong leaves none behind") {
  const TestFolder folder;
  folder.write("sweep.toml", kSmallSweep);
  folder.write("s.sqlite", "no database");
  const ProgramRun foreign = report(folder);
  CHECK(foreign.exit_code == 3);
  CHECK(has(foreign.err, "s.sqlite"));
  std::filesystem::remove(folder.path("s.sqlite"));
  REQUIRE(run_program({"sweep", folder.path("sweep.toml"), "--store", folder.path("s.sqlite"), "-q"}).exit_code == 0);
  if (report_library().empty()) return;
  const ProgramRun unknown = report(folder, {"--view", "certified"});
  CHECK(unknown.exit_code == 2);
  CHECK(has(unknown.err, "no run of the store is of policy 'certified'"));
  CHECK_FALSE(std::filesystem::exists(folder.path("r.html")));
  const ProgramRun made = report(folder, {"--view", "robin-hood"});
  CAPTURE(made.err);
  REQUIRE(made.exit_code == 0);
  const std::string page = folder.read("r.html");
  CHECK(has(page, "12 runs, 240 rows of frames"));
  CHECK(has(page, "under robin-hood"));
  CHECK(has(page, "sha256 of "));
}

}  // namespace framesim
