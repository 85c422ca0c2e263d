// Results that survive: one SQLite file, in WAL mode, one transaction for each run. A run is in it whole or not at all, at
// whatever moment the program ends, so that what is missing can be run later (--resume) and the content is then that of
// an undisturbed sweep. The tables and views are documented in schema.cpp, and in the store itself (table `about`).
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "experiments/run.h"
#include "experiments/store/manifest.h"
#include "experiments/store/sqlite.h"
#include "experiments/store/sweep_spec.h"

namespace framesim {

// "fsim": in the file's header, so that `file` and other programs can tell whose it is.
inline constexpr std::int64_t kStoreApplication = 0x6673696d;
inline constexpr std::int64_t kStoreVersion = 1;  // of the schema; a store of another one is refused

// What a store is of. Results of two stores belong together if all but `shard` agree.
struct StoreIdentity {
  std::string plan_hash;
  std::int64_t runs = 0;  // of the whole sweep
  Shard shard;            // the part of it that this store is for
  bool frame_rows = false;
  Yardstick yardstick = Yardstick::bound;
  std::vector<InputFile> inputs;
};
StoreIdentity identity_of(const Sweep& sweep, const Shard& shard);
// Why the two cannot be put together, in words, or nothing.
std::optional<std::string> why_different(const StoreIdentity& store, const StoreIdentity& other);

struct StoredRun {
  std::int64_t id = 0;        // its number in the sweep
  std::int64_t manifest = 0;  // which program made it
  RunResult result;           // without records
};

class Store {
 public:
  // Makes a store, or, with `resume`, goes on with the one that is there. Throws InputError at `path` if there is one and
  // not `resume`; if it is of another sweep, shard, input or program; if it is foreign, locked or cannot be written.
  static Store begin(const std::string& path, const StoreIdentity& identity, const Manifest& manifest, bool resume);
  // For reading. Throws InputError if it is no store of this version.
  static Store open(const std::string& path);

  StoreIdentity identity() const;
  std::vector<std::pair<std::int64_t, Manifest>> manifests() const;
  std::vector<std::int64_t> run_ids() const;  // ascending
  std::vector<StoredRun> runs() const;        // by id
  // The frames of a run, in order; none if the sweep did not keep them.
  std::vector<FrameRecord> records(std::int64_t run) const;

  // One transaction. A run that is there already stays: equal sweeps give equal runs.
  void add(std::int64_t id, const RunResult& result);

  Database& database() { return database_; }
  const std::string& path() const { return database_.path(); }

 private:
  explicit Store(Database database) : database_(std::move(database)) {}
  void create(const StoreIdentity& identity);
  std::int64_t manifest_id(const Manifest& manifest);
  void add_frames(std::int64_t id, const RunResult& result);

  Database database_;
  std::int64_t manifest_ = 0;
  bool frame_rows_ = false;
};

// Refuses a file that is no store, in words that say what it is. `database` is not empty.
void check_is_store(const Database& database);

}  // namespace framesim
