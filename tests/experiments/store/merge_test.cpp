// Shards merged are the single run; what does not belong together is refused.
#include <fmt/format.h>

#include "experiments/store/sweep_spec.h"
#include "tests/experiments/store/store_files.h"

namespace framesim {
namespace {

bool has(const std::string& text, const std::string& part) { return text.find(part) != std::string::npos; }

void make(const TestFolder& folder, const std::string& store, const std::string& shard) {
  const ProgramRun run =
      run_program({"sweep", folder.path("sweep.toml"), "--store", folder.path(store), "--shard", shard, "--quiet"});
  CAPTURE(run.err);
  REQUIRE(run.exit_code == 0);
}

ProgramRun merge(const TestFolder& folder, const std::string& out, const std::vector<std::string>& in) {
  std::vector<std::string> arguments = {"merge", folder.path(out)};
  for (const std::string& name : in) arguments.push_back(name.starts_with("--") ? name : folder.path(name));
  return run_program(arguments);
}

}  // namespace

TEST_CASE("shards are written i/n, from 0 or from 1") {
  // 10 runs in 4 parts: 0 4 8 | 1 5 9 | 2 6 | 3 7.
  for (const auto& [text, index, runs] : {std::tuple{"0/4", 0, 3}, {"1/4", 1, 3}, {"3/4", 3, 2}, {"4/4", 0, 3}}) {
    const Shard shard = parse_shard(text);
    CHECK(shard.index == index);
    CHECK(shard.count == 4);
    CHECK(shard.runs_of(10) == runs);
  }
  CHECK(parse_shard("1/1").index == 0);
  CHECK(Shard{2, 4}.runs_of(2) == 0);
  for (const char* wrong : {"", "1", "1/", "/4", "5/4", "-1/4", "0/0", "1/4x", "a/b", "1/-4", "0/1000001"}) {
    CAPTURE(wrong);
    CHECK_THROWS_WITH(parse_shard(wrong), Catch::Contains("is not i/n"));
  }
}

TEST_CASE("merge: shards counted from 0 or from 1 give the single run's store, in any order") {
  const TestFolder folder;
  folder.write("sweep.toml", kSmallSweep);
  make(folder, "whole.sqlite", "0/1");
  for (const int first : {0, 1}) {
    std::vector<std::string> parts;
    for (int i = first; i < first + 5; ++i) {
      parts.insert(parts.begin(), fmt::format("{}-{}.sqlite", first, i));
      make(folder, parts.front(), fmt::format("{}/5", i));
    }
    parts.push_back(parts.front());  // the same one twice does no harm
    const std::string out = fmt::format("merged-{}.sqlite", first);
    const ProgramRun merged = merge(folder, out, parts);
    CAPTURE(merged.err);
    REQUIRE(merged.exit_code == 0);
    CHECK(has(merged.err, "12 of 12 runs"));
    CHECK(content_of_store(folder.path(out)) == content_of_store(folder.path("whole.sqlite")));
    CHECK(run_program({"query", folder.path(out), "--format", "csv"}).out ==
          run_program({"query", folder.path("whole.sqlite"), "--format", "csv"}).out);
  }
}

TEST_CASE("merge: missing runs are named by their shard, and nothing is made") {
  const TestFolder folder;
  folder.write("sweep.toml", kSmallSweep);
  make(folder, "0.sqlite", "0/3");
  make(folder, "1.sqlite", "1/3");
  Database(folder.path("1.sqlite"), Database::Open::existing)
      .run("DELETE FROM frame WHERE run = 4; DELETE FROM run WHERE id = 4");
  const ProgramRun refused = merge(folder, "all.sqlite", {"0.sqlite", "1.sqlite"});
  CHECK(refused.exit_code == 3);
  CAPTURE(refused.err);
  CHECK(has(refused.err, "1.sqlite) has 3 of 4 runs"));
  CHECK(has(refused.err, "shard 2/3 (no file given) has 0 of 4 runs"));
  CHECK(folder.names() == std::vector<std::string>{"0.sqlite", "1.sqlite", "sweep.toml"});
  const ProgramRun partial = merge(folder, "all.sqlite", {"--partial", "0.sqlite", "1.sqlite"});
  CHECK(partial.exit_code == 0);
  CHECK(has(partial.err, "7 of 12 runs"));
  CHECK(count_in_store(folder.path("all.sqlite"), "frame") == 7 * 20);
}

TEST_CASE("merge: stores that contradict each other, or are of other sweeps, are refused") {
  const TestFolder folder;
  folder.write("sweep.toml", kSmallSweep);
  for (const char* name : {"a.sqlite", "b.sqlite", "c.sqlite"}) make(folder, name, "0/1");
  Database(folder.path("b.sqlite"), Database::Open::existing).run("UPDATE run SET p95_s = p95_s * 2 WHERE id = 5");
  Database(folder.path("c.sqlite"), Database::Open::existing).run("UPDATE manifest SET version = '9.9'");
  folder.write("sweep.toml", fmt::format("{}# another\n", kSmallSweep));
  make(folder, "d.sqlite", "0/1");
  folder.write("e.sqlite", "");
  const auto refused = [&](const std::vector<std::string>& in, const std::string& out, const std::string& words) {
    const ProgramRun run = merge(folder, out, in);
    CAPTURE(run.err, words);
    CHECK(run.exit_code == 3);
    CHECK(has(run.err, words));
  };
  refused({"a.sqlite", "b.sqlite"}, "o.sqlite", "run 5 (scene street");
  refused({"a.sqlite", "c.sqlite"}, "o.sqlite", "9.9");
  refused({"a.sqlite", "d.sqlite"}, "o.sqlite", "does not belong");
  refused({"a.sqlite", "e.sqlite"}, "o.sqlite", "no sweep has begun");
  refused({"a.sqlite", "gone.sqlite"}, "o.sqlite", "no such file");
  refused({"a.sqlite"}, "b.sqlite", "is there already");
  for (const std::string& name : folder.names()) CHECK_FALSE(has(name, "o.sqlite"));
}

}  // namespace framesim
