#include "experiments/store/store.h"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>

#include "experiments/store/schema.h"
#include "sim/words.h"

namespace framesim {
namespace {

// Between the entries of a list in one cell: what no entry holds.
constexpr std::string_view kEffectSeparator = ", ", kLossSeparator = "\n";

std::string joined(const std::vector<std::string>& words, std::string_view separator) {
  return fmt::format("{}", fmt::join(words, separator));
}

std::vector<std::string> split(const std::string& text, std::string_view separator) {
  std::vector<std::string> words;
  for (std::size_t begin = 0; begin < text.size();) {
    const std::size_t end = std::min(text.find(separator, begin), text.size());
    words.push_back(text.substr(begin, end - begin));
    begin = end + separator.size();
  }
  return words;
}

bool is_empty(const Database& database) {
  return database.whole("SELECT count(*) FROM sqlite_master") == 0 && database.whole("PRAGMA application_id") == 0;
}

Yardstick yardstick_named(const Database& database, const std::string& name) {
  const auto at = std::find(kYardstickNames.begin(), kYardstickNames.end(), name);
  if (at == kYardstickNames.end())
    throw InputError({database.path()}, fmt::format("unknown yardstick {}", framesim::quoted(name)));
  return static_cast<Yardstick>(at - kYardstickNames.begin());
}

std::string show_program(const Manifest& m) {
  return fmt::format("framesim {}, commit {}, {}, {}", m.version, m.commit, m.compiler, m.flags);
}

std::uint64_t read_hash(const std::string& text) {
  std::uint64_t hash = 0;
  std::from_chars(text.data(), text.data() + text.size(), hash, 16);
  return hash;
}

void read_cell(const Statement& row, int column, std::int64_t& value) { value = row.whole(column); }
void read_cell(const Statement& row, int column, double& value) { value = row.number(column); }

void read_inputs(const Database& database, StoreIdentity& identity) {
  Statement rows = database.prepare("SELECT name, sha256 FROM input ORDER BY name");
  while (rows.step()) identity.inputs.push_back({rows.text(0), rows.text(1)});
}

}  // namespace

void check_is_store(const Database& database) {
  const std::int64_t application = database.whole("PRAGMA application_id");
  const std::int64_t version = database.whole("PRAGMA user_version");
  if (application != kStoreApplication) {
    throw InputError({database.path()}, "is an SQLite database of another program, not a store; name another file");
  }
  if (version == kStoreVersion) return;
  throw InputError(
      {database.path()},
      fmt::format("its tables have version {}; this framesim reads and writes version {}", version, kStoreVersion));
}

StoreIdentity identity_of(const Sweep& sweep, const Shard& shard) {
  StoreIdentity identity{.plan_hash = sweep.plan_hash,
                         .runs = static_cast<std::int64_t>(sweep.runs.size()),
                         .shard = shard,
                         .frame_rows = sweep.frame_rows,
                         .yardstick = sweep.yardstick,
                         .inputs = sweep.inputs};
  std::sort(identity.inputs.begin(), identity.inputs.end(),
            [](const InputFile& a, const InputFile& b) { return a.name < b.name; });
  return identity;
}

std::optional<std::string> why_different(const StoreIdentity& store, const StoreIdentity& other) {
  for (const InputFile& input : other.inputs) {
    const auto same = std::find_if(store.inputs.begin(), store.inputs.end(),
                                   [&](const InputFile& mine) { return mine.name == input.name; });
    if (same == store.inputs.end())
      return fmt::format("it was made without the input {}", framesim::quoted(input.name));
    if (!(*same == input)) {
      return fmt::format("the input {} is not the one it was made with (sha256 {}..., then {}...)",
                         framesim::quoted(input.name), input.sha256.substr(0, 12), same->sha256.substr(0, 12));
    }
  }
  if (store.inputs.size() != other.inputs.size()) return "it was made with more input files";
  if (store.plan_hash != other.plan_hash || store.runs != other.runs) {
    return fmt::format("it is of another sweep, of {} runs where this one has {}", store.runs, other.runs);
  }
  return std::nullopt;
}

void Store::create(const StoreIdentity& identity) {
  Transaction all(database_);
  database_.run(schema_sql());
  Statement sweep = database_.prepare("INSERT INTO sweep VALUES (1, ?, ?, ?, ?, ?, ?)");
  sweep.bind(1, identity.plan_hash);
  sweep.bind(2, identity.runs);
  sweep.bind(3, identity.shard.index);
  sweep.bind(4, identity.shard.count);
  sweep.bind(5, std::int64_t{identity.frame_rows});
  sweep.bind(6, kYardstickNames[static_cast<std::size_t>(identity.yardstick)]);
  sweep.run();
  Statement row = database_.prepare("INSERT INTO input VALUES (?, ?)");
  for (const InputFile& input : identity.inputs) {
    row.bind(1, input.name);
    row.bind(2, input.sha256);
    row.run();
  }
  all.commit();
}

Store Store::begin(const std::string& path, const StoreIdentity& identity, const Manifest& manifest, bool resume) {
  Store store(Database(path, Database::Open::create));
  const bool fresh = is_empty(store.database_);
  if (!fresh) check_is_store(store.database_);
  if (!fresh && !resume) {
    throw InputError({path}, fmt::format("there is a store with {} runs already; --resume goes on with it, or name "
                                         "another file",
                                         store.database_.whole("SELECT count(*) FROM run")));
  }
  // WAL: a run is appended by one write, readers do not wait, and a killed program leaves nothing half written. NORMAL:
  // after a loss of power the last runs may be missing, never damaged; --resume makes them again.
  store.database_.run("PRAGMA journal_mode = WAL; PRAGMA synchronous = NORMAL; PRAGMA foreign_keys = ON");
  if (fresh) store.create(identity);
  const StoreIdentity there = store.identity();
  if (const auto why = why_different(there, identity)) {
    throw InputError({path}, fmt::format("cannot go on: {}; name another file for this sweep", *why));
  }
  if (to_string(there.shard) != to_string(identity.shard)) {
    throw InputError({path}, fmt::format("cannot go on: it is for shard {}, not {}; give each shard a file of its own",
                                         to_string(there.shard), to_string(identity.shard)));
  }
  for (const auto& [id, program] : store.manifests()) {
    if (program.same_program(manifest)) continue;
    throw InputError({path}, fmt::format("cannot go on: it was made by {}; this is {}", show_program(program),
                                         show_program(manifest)));
  }
  store.manifest_ = store.manifest_id(manifest);
  store.frame_rows_ = identity.frame_rows;
  store.database_.wait_for_locks(Database::kWorkingWait_ms);
  return store;
}

Store Store::open(const std::string& path) {
  Store store(Database(path, Database::Open::read_only));
  if (is_empty(store.database_)) throw InputError({path}, "is empty: no sweep has begun in it");
  check_is_store(store.database_);
  return store;
}

std::int64_t Store::manifest_id(const Manifest& manifest) {
  for (const auto& [id, other] : manifests()) {
    if (manifest.same_program(other) && manifest.cpu == other.cpu) return id;
  }
  Transaction all(database_);
  Statement row = database_.prepare(
      "INSERT INTO manifest (version, commit_id, compiler, flags, cpu, command) VALUES (?, ?, ?, ?, ?, ?) RETURNING "
      "id");
  const std::string* texts[] = {&manifest.version, &manifest.commit, &manifest.compiler,
                                &manifest.flags,   &manifest.cpu,    &manifest.command};
  for (int i = 0; i < 6; ++i) row.bind(i + 1, *texts[i]);
  row.step();
  const std::int64_t id = row.whole(0);
  row.run();
  all.commit();
  return id;
}

StoreIdentity Store::identity() const {
  Statement row = database_.prepare(
      "SELECT plan_hash, runs, shard_index, shard_count, frame_rows, yardstick FROM sweep WHERE id = 1");
  if (!row.step()) throw InputError({path()}, "is damaged: it does not say what it is of");
  StoreIdentity identity{.plan_hash = row.text(0),
                         .runs = row.whole(1),
                         .shard = {row.whole(2), row.whole(3)},
                         .frame_rows = row.whole(4) != 0,
                         .yardstick = yardstick_named(database_, row.text(5))};
  read_inputs(database_, identity);
  return identity;
}

std::vector<std::pair<std::int64_t, Manifest>> Store::manifests() const {
  std::vector<std::pair<std::int64_t, Manifest>> list;
  Statement rows =
      database_.prepare("SELECT id, version, commit_id, compiler, flags, cpu, command FROM manifest ORDER BY id");
  while (rows.step()) {
    list.push_back(
        {rows.whole(0), {rows.text(1), rows.text(2), rows.text(3), rows.text(4), rows.text(5), rows.text(6)}});
  }
  return list;
}

std::vector<std::int64_t> Store::run_ids() const {
  std::vector<std::int64_t> ids;
  Statement rows = database_.prepare("SELECT id FROM run ORDER BY id");
  while (rows.step()) ids.push_back(rows.whole(0));
  return ids;
}

std::vector<StoredRun> Store::runs() const {
  std::vector<StoredRun> list;
  Statement rows = database_.prepare(run_select_sql());
  while (rows.step()) {
    int at = 0;
    StoredRun& run = list.emplace_back();
    run.id = rows.whole(at++);
    run.manifest = rows.whole(at++);
    RunResult& r = run.result;
    for (std::string* text : {&r.scene, &r.title, &r.policy, &r.machine, &r.overlap, &r.planner, &r.estimator}) {
      *text = rows.text(at++);
    }
    r.effects = split(rows.text(at++), kEffectSeparator);
    r.left_out = split(rows.text(at++), kLossSeparator);
    r.target_s = rows.number(at++);
    r.seed = static_cast<std::uint64_t>(rows.whole(at++));
    for (const SummaryColumn& column : summary_columns()) r.summary.*column.value = rows.number(at++);
    r.records_hash = read_hash(rows.text(at));
  }
  return list;
}

std::vector<FrameRecord> Store::records(std::int64_t run) const {
  std::vector<FrameRecord> list;
  Statement rows = database_.prepare("SELECT * FROM frame WHERE run = ? ORDER BY frame");
  rows.bind(1, run);
  while (rows.step()) {
    FrameRecord& record = list.emplace_back();
    int at = 1;  // behind the run's number
#define X(type, name, unit, meaning) read_cell(rows, at++, record.name);
    FRAMESIM_FRAME_COLUMNS(X)
#undef X
  }
  return list;
}

void Store::add_frames(std::int64_t id, const RunResult& result) {
  Statement row = database_.prepare(frame_insert_sql());
  for (const FrameRecord& record : result.records) {
    int at = 1;
    row.bind(at++, id);
#define X(type, name, unit, meaning) row.bind(at++, record.name);
    FRAMESIM_FRAME_COLUMNS(X)
#undef X
    row.run();
  }
}

void Store::add(std::int64_t id, const RunResult& r) {
  Transaction all(database_);
  Statement row = database_.prepare(run_insert_sql());
  int at = 1;
  row.bind(at++, id);
  row.bind(at++, manifest_);
  for (const std::string* text : {&r.scene, &r.title, &r.policy, &r.machine, &r.overlap, &r.planner, &r.estimator}) {
    row.bind(at++, *text);
  }
  row.bind(at++, joined(r.effects, kEffectSeparator));
  row.bind(at++, joined(r.left_out, kLossSeparator));
  row.bind(at++, r.target_s);
  row.bind(at++, static_cast<std::int64_t>(r.seed));
  for (const SummaryColumn& column : summary_columns()) row.bind(at++, r.summary.*column.value);
  row.bind(at, fmt::format("{:016x}", r.records_hash));
  row.run();
  const bool is_new = database_.whole("SELECT changes()") > 0;
  if (is_new && frame_rows_) add_frames(id, r);
  all.commit();
}

}  // namespace framesim
