// framesim sweep and query through the binary.
#include <fmt/format.h>

#include "experiments/store/store.h"
#include "tests/experiments/store/store_files.h"

namespace framesim {
namespace {

bool has(const std::string& text, const std::string& part) { return text.find(part) != std::string::npos; }

ProgramRun sweep(const TestFolder& folder, const std::string& store, std::vector<std::string> more = {}) {
  std::vector<std::string> arguments = {"sweep", folder.path("sweep.toml"), "--store", folder.path(store)};
  arguments.insert(arguments.end(), more.begin(), more.end());
  return run_program(arguments);
}

ProgramRun query(const TestFolder& folder, const std::string& store, std::vector<std::string> more = {}) {
  std::vector<std::string> arguments = {"query", folder.path(store)};
  arguments.insert(arguments.end(), more.begin(), more.end());
  return run_program(arguments);
}

void check_refused(const ProgramRun& run, int exit_code, const std::vector<std::string>& words) {
  CAPTURE(run.out, run.err);
  CHECK(run.exit_code == exit_code);
  CHECK(run.out.empty());
  for (const std::string& word : words) {
    CAPTURE(word);
    CHECK(has(run.err, word));
  }
}

}  // namespace

TEST_CASE("sweep: the store's error table is compare's, byte for byte") {
  const TestFolder folder;
  folder.write("sweep.toml",
               "framesim = 1\nscenes = [\"street\", \"graphicon-forest:trees=100\"]\npolicies = [\"robin-hood\", "
               "\"static\"]\ntargets = [\"16ms\", \"33ms\"]\nframes = 10\n");
  const ProgramRun made = sweep(folder, "s.sqlite");
  CAPTURE(made.err);
  REQUIRE(made.exit_code == 0);
  for (const char* format : {"csv", "table", "json", "markdown"}) {
    CAPTURE(format);
    const ProgramRun compared = run_program({"compare", "--scenes", "street,graphicon-forest:trees=100", "--policies",
                                             "robin-hood,static", "--targets", "16ms,33ms", "--frames", "10",
                                             "--yardstick", "bound", "--format", format, "--quiet"});
    const ProgramRun stored = query(folder, "s.sqlite", {"--format", format});
    CHECK(stored.exit_code == 0);
    CHECK(stored.out == compared.out);
  }
  // The view and the table made by the program are the same.
  const ProgramRun view = query(folder, "s.sqlite", {"SELECT * FROM error_table", "--format", "csv"});
  CHECK(view.out == query(folder, "s.sqlite", {"error_table", "--format", "csv"}).out);
}

TEST_CASE("sweep: each yardstick gives what compare gives with it") {
  for (const char* yardstick : {"none", "least", "parts"}) {
    CAPTURE(yardstick);
    const TestFolder folder;
    folder.write("sweep.toml", fmt::format("framesim = 1\nscenes = [\"street\"]\npolicies = [\"robin-hood\", "
                                           "\"static\"]\nframes = 10\nyardstick = \"{}\"\n",
                                           yardstick));
    REQUIRE(sweep(folder, "s.sqlite").exit_code == 0);
    CHECK(query(folder, "s.sqlite", {"--format", "csv"}).out ==
          run_program({"compare", "--scenes", "street", "--policies", "robin-hood,static", "--frames", "10",
                       "--yardstick", yardstick, "--format", "csv", "--quiet"})
              .out);
  }
}

TEST_CASE("sweep: the content does not depend on the number of jobs") {
  const TestFolder folder;
  folder.write("sweep.toml", kSmallSweep);
  REQUIRE(sweep(folder, "1.sqlite", {"--jobs", "1"}).exit_code == 0);
  REQUIRE(sweep(folder, "5.sqlite", {"--jobs", "5"}).exit_code == 0);
  CHECK(content_of_store(folder.path("1.sqlite")) == content_of_store(folder.path("5.sqlite")));
  CHECK(count_in_store(folder.path("1.sqlite"), "run") == 12);
  CHECK(count_in_store(folder.path("1.sqlite"), "frame") == 12 * 20);
  CHECK(folder.names() == std::vector<std::string>{"1.sqlite", "5.sqlite", "sweep.toml"});
}

TEST_CASE("sweep: the frames that a store keeps are those that the run had, bit for bit") {
  const TestFolder folder;
  folder.write("sweep.toml", kSmallSweep);
  REQUIRE(sweep(folder, "s.sqlite").exit_code == 0);
  const Store store = Store::open(folder.path("s.sqlite"));
  const std::vector<StoredRun> runs = store.runs();
  REQUIRE(runs.size() == 12);
  for (const StoredRun& run : runs) {
    CAPTURE(run.id);
    const std::vector<FrameRecord> records = store.records(run.id);
    CHECK(records.size() == 20);
    CHECK(hash(records) == run.result.records_hash);
  }
}

TEST_CASE("report: a store as a page, with curves where it has frames") {
  const TestFolder folder;
  folder.write("sweep.toml", kSmallSweep);
  REQUIRE(sweep(folder, "s.sqlite").exit_code == 0);
  const ProgramRun made = run_program({"report", folder.path("s.sqlite"), "-o", folder.path("r.html")});
  CAPTURE(made.err);
  if (has(made.err, "without dygraphs")) return;  // then there is no report at all
  REQUIRE(made.exit_code == 0);
  CHECK(made.out == folder.path("r.html") + "\n");
  const std::string page = folder.read("r.html");
  for (const char* word : {"robin-hood", "\"views\":[{", "sha256 of sweep.toml", "g++", "compiler"}) {
    CAPTURE(word);
    if (std::string(word) == "g++" && has(page, "clang++")) continue;
    CHECK(has(page, word));
  }
  // A damaged store gives no page.
  folder.write("bad.sqlite", "x");
  check_refused(run_program({"report", folder.path("bad.sqlite"), "-o", folder.path("b.html")}), 3, {"not an SQLite"});
  CHECK_FALSE(std::filesystem::exists(folder.path("b.html")));
}

TEST_CASE("sweep: [[vary]] multiplies what it names and leaves the others") {
  const TestFolder folder;
  folder.write("sweep.toml",
               std::string("framesim = 1\nscenes = [\"street\"]\npolicies = [\"pid\", \"static\"]\nframes = "
                           "5\neffects = [\"jitter:sigma=0.1\"]\n") +
                   "[[vary]]\nof = \"policy\"\nname = \"static\"\nkey = \"pixels-per-polygon\"\nvalues = "
                   "[16, 64, 256]\n[[vary]]\nof = \"effect\"\nname = \"jitter\"\nkey = \"sigma\"\nvalues = "
                   "[0.1, 0.2]\n");
  REQUIRE(sweep(folder, "s.sqlite").exit_code == 0);
  const ProgramRun rows = query(folder, "s.sqlite", {"SELECT policy, effects FROM runs", "--format", "csv"});
  // Two effects lists, each with pid and three static.
  std::string expected = "policy,effects\n";
  for (const char* sigma : {"0.1", "0.2"}) {
    for (const char* policy :
         {"pid", "static:pixels-per-polygon=16", "static:pixels-per-polygon=64", "static:pixels-per-polygon=256"}) {
      expected += fmt::format("{},\"semantics, jitter:sigma={}\"\n", policy, sigma);
    }
  }
  CHECK(rows.out == expected);
}

TEST_CASE("sweep: what is wrong in its file is refused at its place, before anything is made") {
  const TestFolder folder;
  const std::string start = "framesim = 1\nscenes = [\"street\"]\npolicies = [\"static\"]\n";
  const auto refused = [&](const std::string& text, const std::vector<std::string>& words) {
    folder.write("sweep.toml", text);
    check_refused(sweep(folder, "s.sqlite"), 3, words);
  };
  refused(start + "seed = 4\n", {"sweep.toml:4:1", "unknown key 'seed'", "did you mean 'seeds'"});
  refused("framesim = 1\nscenes = [\"street\"]\npolicies = [\"static\",\n \"robin-hod\"]\n",
          {"sweep.toml:4:2", "robin-hod", "did you mean 'robin-hood'"});
  refused("framesim = 1\nscenes = [\"gone.toml\"]\npolicies = [\"static\"]\n", {"sweep.toml:2:11", "no such file"});
  refused("framesim = 1\npolicies = [\"static\"]\n", {"'scenes' is missing"});
  refused("framesim = 1\nscenes = []\npolicies = [\"static\"]\n", {"sweep.toml:2", "empty list"});
  refused("framesim = 1\nscenes = [\"street\"]\npolicies = [\"static\", \"static\"]\n", {"sweep.toml:3:23", "twice"});
  refused(start + "seeds = 0\n", {"sweep.toml:4", "seeds"});
  refused(start + "first_seed = 9223372036854775807\nseeds = 2\n", {"sweep.toml:5", "passes the largest seed"});
  refused(start + "targets = [\"16\"]\n", {"sweep.toml:4:12", "unit"});
  refused(start + "estimators = [\"orcale\"]\n", {"sweep.toml:4:15", "oracle"});
  refused(start + "[[vary]]\nof = \"policy\"\nname = \"pid\"\nkey = \"gain\"\nvalues = [1]\n",
          {"sweep.toml:6:8", "no policy 'pid' in this file"});
  refused(start + "[[vary]]\nof = \"policy\"\nname = \"static\"\nkey = \"gain\"\nvalues = [1]\n",
          {"sweep.toml:8:11", "gain", "pixels-per-polygon"});
  refused(start + "yardstick = \"most\"\n", {"sweep.toml:4", "none, bound, least, parts"});
  CHECK(folder.names() == std::vector<std::string>{"sweep.toml"});
}

TEST_CASE("sweep: a store with content is not touched unless told to go on") {
  const TestFolder folder;
  folder.write("sweep.toml", kSmallSweep);
  REQUIRE(sweep(folder, "s.sqlite").exit_code == 0);
  const std::string before = folder.read("s.sqlite");
  check_refused(sweep(folder, "s.sqlite"), 3, {"12 runs", "--resume"});
  check_refused(sweep(folder, "s.sqlite", {"--resume", "--shard", "1/2"}), 3, {"shard 0/1", "1/2"});
  folder.write("sweep.toml", std::string(kSmallSweep) + "first_seed = 2\n");
  check_refused(sweep(folder, "s.sqlite", {"--resume"}), 3, {"cannot go on", "sweep.toml", "sha256"});
  CHECK(folder.read("s.sqlite") == before);
  folder.write("sweep.toml", kSmallSweep);
  const ProgramRun again = sweep(folder, "s.sqlite", {"--resume"});
  CHECK(again.exit_code == 0);
  CHECK(has(again.err, "12 runs, 12 were there before"));
  CHECK(folder.read("s.sqlite") == before);
}

TEST_CASE("sweep: a store that another program made is not gone on with") {
  const TestFolder folder;
  folder.write("sweep.toml", kSmallSweep);
  REQUIRE(sweep(folder, "s.sqlite").exit_code == 0);
  Database(folder.path("s.sqlite"), Database::Open::existing).run("UPDATE manifest SET compiler = 'tcc 0.9'");
  check_refused(sweep(folder, "s.sqlite", {"--resume"}), 3, {"made by", "tcc 0.9"});
  // Another CPU gives the same results: it is noted, and that is all.
  const TestFolder other;
  other.write("sweep.toml", kSmallSweep);
  REQUIRE(sweep(other, "s.sqlite").exit_code == 0);
  Database(other.path("s.sqlite"), Database::Open::existing)
      .run(
          "UPDATE manifest SET cpu = 'Z80'; DELETE FROM frame "
          "WHERE run = 7; DELETE FROM run WHERE id = 7");
  REQUIRE(sweep(other, "s.sqlite", {"--resume"}).exit_code == 0);
  CHECK(query(other, "s.sqlite", {"SELECT m.runs FROM manifests m", "--format", "csv"}).out == "runs\n11\n1\n");
}

TEST_CASE("query: only reads, and says what it can show") {
  const TestFolder folder;
  folder.write("sweep.toml", kSmallSweep);
  REQUIRE(sweep(folder, "s.sqlite").exit_code == 0);
  const std::string before = folder.read("s.sqlite");
  check_refused(query(folder, "s.sqlite", {"DELETE FROM run"}), 2, {"only reads"});
  check_refused(query(folder, "s.sqlite", {"runz"}), 2, {"no view", "error_table", "did you mean 'runs'"});
  check_refused(query(folder, "s.sqlite", {"SELECT nonsense FROM run"}), 3, {"no such column"});
  check_refused(query(folder, "s.sqlite", {"SELECT 1; SELECT 2"}), 3, {"more than one"});
  check_refused(query(folder, "none.sqlite"), 3, {"no such file"});
  check_refused(query(folder, "sweep.toml"), 3, {"not an SQLite database"});
  check_refused(query(folder, ""), 3, {"folder"});
  CHECK(folder.read("s.sqlite") == before);
  CHECK(query(folder, "s.sqlite",
              {"SELECT count(*) AS n, 'a,b' AS t, 1.5 AS x, NULL AS y FROM frames", "--format", "json"})
            .out == "[\n  {\"n\": 240, \"t\": \"a,b\", \"x\": 1.5, \"y\": null}\n]\n");
  CHECK(query(folder, "s.sqlite", {"progress", "--format", "csv"}).out ==
        "of_sweep,shard_index,shard_count,of_shard,done\n12,0,1,12,12\n");
}

TEST_CASE("sweep: every file that goes in is in the store with its SHA-256") {
  const TestFolder folder;
  folder.write("sweep.toml",
               "framesim = 1\nscenes = [\"street\"]\npolicies = [\"static\"]\nframes = 5\nmachine = \"m.toml\"\n");
  std::ifstream in(std::string(kSourceFolder) + "/scenes/data/machines/street.toml");
  const std::string machine((std::istreambuf_iterator<char>(in)), std::istreambuf_iterator<char>());
  folder.write("m.toml", machine);
  const ProgramRun made = sweep(folder, "s.sqlite");
  CAPTURE(made.err);
  REQUIRE(made.exit_code == 0);
  const ProgramRun inputs = query(folder, "s.sqlite", {"SELECT name FROM inputs", "--format", "csv"});
  CHECK(inputs.out == "name\nbuilt-in scene street\nm.toml\nsweep.toml\n");
  folder.write("m.toml", machine + "# changed\n");
  check_refused(sweep(folder, "s.sqlite", {"--resume"}), 3, {"'m.toml' is not the one"});
}

}  // namespace framesim
