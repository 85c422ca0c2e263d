#include "experiments/store/schema.h"

#include <fmt/format.h>

#include "experiments/store/store.h"
#include "sim/frame_record.h"
#include "sim/metrics.h"

namespace framesim {
namespace {

// One row each: what the store is of. Made first, never changed.
constexpr std::string_view kFixedTables = R"(
CREATE TABLE sweep (
  id INTEGER PRIMARY KEY CHECK (id = 1),
  plan_hash TEXT NOT NULL,       -- SHA-256 of all runs, written out
  runs INTEGER NOT NULL,         -- of the whole sweep
  shard_index INTEGER NOT NULL,  -- this store is for the runs with id % shard_count = shard_index
  shard_count INTEGER NOT NULL,
  frame_rows INTEGER NOT NULL,   -- 1: table frame has every frame of every run
  yardstick TEXT NOT NULL
) STRICT;
CREATE TABLE input (
  name TEXT PRIMARY KEY,         -- file as the sweep names it, or what is built in
  sha256 TEXT NOT NULL
) STRICT, WITHOUT ROWID;
CREATE TABLE manifest (
  id INTEGER PRIMARY KEY,
  version TEXT NOT NULL,
  commit_id TEXT NOT NULL,
  compiler TEXT NOT NULL,
  flags TEXT NOT NULL,
  cpu TEXT NOT NULL,
  command TEXT NOT NULL
) STRICT;
CREATE TABLE about (name TEXT PRIMARY KEY, meaning TEXT NOT NULL) STRICT, WITHOUT ROWID;
)";

constexpr std::string_view kRunTexts[] = {"scene",   "title",     "policy",  "machine", "overlap",
                                          "planner", "estimator", "effects", "left_out"};

std::string sql_text(std::string_view text) {
  std::string quoted = "'";
  for (const char c : text) quoted += c == '\'' ? std::string("''") : std::string(1, c);
  return quoted + "'";
}

std::string summary_names() {
  std::string names;
  for (const SummaryColumn& column : summary_columns()) names += fmt::format(", {}", column.name);
  return names;
}

std::string run_names() {
  std::string names = "id, manifest";
  for (const std::string_view text : kRunTexts) names += fmt::format(", {}", text);
  return names + ", target_s, seed" + summary_names() + ", hash";
}

std::string marks(std::size_t count) {
  std::string marks = "?";
  for (std::size_t i = 1; i < count; ++i) marks += ", ?";
  return marks;
}

std::string run_table() {
  std::string sql =
      "CREATE TABLE run (\n  id INTEGER PRIMARY KEY,\n  manifest INTEGER NOT NULL REFERENCES manifest (id)";
  for (const std::string_view text : kRunTexts) sql += fmt::format(",\n  {} TEXT NOT NULL", text);
  sql += ",\n  target_s REAL NOT NULL,\n  seed INTEGER NOT NULL";
  for (const SummaryColumn& column : summary_columns()) sql += fmt::format(",\n  {} REAL", column.name);
  return sql + ",\n  hash TEXT NOT NULL\n) STRICT;\n";
}

// X of FRAMESIM_FRAME_COLUMNS: the C++ type as SQLite's.
constexpr std::string_view sql_type(double) { return "REAL"; }
constexpr std::string_view sql_type(std::int64_t) { return "INTEGER NOT NULL"; }

std::string frame_table() {
  std::string sql = "CREATE TABLE frame (\n  run INTEGER NOT NULL REFERENCES run (id)";
#define X(type, name, unit, meaning) sql += fmt::format(",\n  " #name " {}", sql_type(type{}));
  FRAMESIM_FRAME_COLUMNS(X)
#undef X
  return sql + ",\n  PRIMARY KEY (run, frame)\n) STRICT, WITHOUT ROWID;\n";
}

std::string views() {
  std::string sql =
      "CREATE VIEW error_table AS SELECT scene, policy, target_s" + summary_names() + ", hash FROM run ORDER BY id;\n";
  sql += fmt::format(
      "CREATE VIEW runs AS SELECT id, scene, policy, target_s, machine, overlap, planner, estimator, "
      "effects, seed{}, p95_s <= {} * target_s AS holds, hash FROM run ORDER BY id;\n",
      summary_names(), kHoldTolerance);
  sql +=
      "CREATE VIEW frames AS SELECT r.scene, r.policy, r.target_s, r.seed, f.* FROM frame f JOIN run r ON r.id = f.run "
      "ORDER BY f.run, f.frame;\n";
  sql +=
      "CREATE VIEW manifests AS SELECT m.*, count(r.id) AS runs FROM manifest m LEFT JOIN run r ON r.manifest = m.id "
      "GROUP BY m.id ORDER BY m.id;\n";
  sql += "CREATE VIEW inputs AS SELECT name, sha256 FROM input ORDER BY name;\n";
  sql +=
      "CREATE VIEW progress AS SELECT runs AS of_sweep, shard_index, shard_count, "
      "(runs - shard_index + shard_count - 1) / shard_count AS of_shard, (SELECT count(*) FROM run) AS done "
      "FROM sweep;\n";
  return sql;
}

std::string documentation() {
  std::string sql;
  const auto add = [&](std::string_view name, std::string_view meaning) {
    sql += fmt::format("INSERT INTO about VALUES ({}, {});\n", sql_text(name), sql_text(meaning));
  };
  for (const StoreView& view : store_views()) add(view.name, view.meaning);
  const auto with_unit = [](std::string_view meaning, std::string_view unit) {
    return unit.empty() ? std::string(meaning) : fmt::format("{} ({})", meaning, unit);
  };
  for (const SummaryColumn& column : summary_columns()) {
    add(fmt::format("runs.{}", column.name), with_unit(column.meaning, column.unit));
  }
  for (const FrameColumn& column : frame_columns()) {
    add(fmt::format("frames.{}", column.name), with_unit(column.meaning, column.unit));
  }
  return sql;
}

}  // namespace

const std::vector<StoreView>& store_views() {
  static const std::vector<StoreView> views = {
      {"error_table",
       "the ordinary error table: what 'framesim compare --format csv' prints, in the order of the sweep"},
      {"runs", "one row a run: what was run, with its seed, machine, planner, estimator and effects, and its figures"},
      {"frames",
       "one row a frame, if the sweep kept frame rows; its run's scene, policy, target and seed before it. The "
       "critical path is not traced in a sweep: its columns are 0"},
      {"manifests", "the programs and CPUs that made the runs, and how many each"},
      {"inputs", "every file that went in, with its SHA-256"},
      {"progress", "how many runs the sweep and this shard have, and how many are done"},
      {"about", "what the views and the columns of runs and frames mean"}};
  return views;
}

std::string schema_sql() {
  return std::string(kFixedTables) + run_table() + frame_table() + views() + documentation() +
         fmt::format("PRAGMA application_id = {};\nPRAGMA user_version = {};\n", kStoreApplication, kStoreVersion);
}

std::string run_insert_sql() {
  const std::size_t columns = 2 + std::size(kRunTexts) + 2 + summary_columns().size() + 1;
  return fmt::format("INSERT INTO run ({}) VALUES ({}) ON CONFLICT (id) DO NOTHING", run_names(), marks(columns));
}

std::string run_select_sql() { return fmt::format("SELECT {} FROM run ORDER BY id", run_names()); }

std::string frame_insert_sql() {
  return fmt::format("INSERT INTO frame VALUES ({})", marks(1 + frame_columns().size()));
}

}  // namespace framesim
