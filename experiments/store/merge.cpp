#include "experiments/store/merge.h"

#include <fmt/format.h>
#include <unistd.h>

#include <cerrno>
#include <cstdio>
#include <cstring>
#include <filesystem>

#include "experiments/store/schema.h"
#include "experiments/store/store.h"
#include "sim/words.h"

namespace framesim {
namespace {

std::string shard_text(const StoreIdentity& identity) {
  return identity.shard.count > 1 ? fmt::format("shard {}", to_string(identity.shard)) : std::string("the sweep");
}

// Every input opened once before anything is written, so that what can be refused is refused early.
struct Part {
  std::string path;
  StoreIdentity identity;
  Manifest manifest;
};

Part examine(const std::string& path) {
  const Store store = Store::open(path);
  const auto manifests = store.manifests();
  if (manifests.empty()) throw InputError({path}, "has no manifest: its sweep was ended before its first run");
  return {path, store.identity(), manifests.front().second};
}

std::vector<Part> examine_all(const std::vector<std::string>& paths) {
  std::vector<Part> parts;
  for (const std::string& path : paths) {
    parts.push_back(examine(path));
    const Part &first = parts.front(), &part = parts.back();
    if (const auto why = why_different(first.identity, part.identity)) {
      throw InputError({path}, fmt::format("does not belong to {}: {}", framesim::quoted(first.path), *why));
    }
    if (part.manifest.same_program(first.manifest)) continue;
    const auto show = [](const Manifest& m) {
      return fmt::format("framesim {}, commit {}, {}, {}", m.version, m.commit, m.compiler, m.flags);
    };
    throw InputError({path}, fmt::format("was made by {}, but {} by {}", show(part.manifest),
                                         framesim::quoted(first.path), show(first.manifest)));
  }
  return parts;
}

std::string column_names(const Database& database, const std::string& table) {
  std::string names;
  Statement columns = database.prepare(fmt::format("SELECT name FROM pragma_table_info('{}')", table));
  while (columns.step()) names += (names.empty() ? "" : ", ") + columns.text(0);
  return names;
}

class Merger {
 public:
  explicit Merger(Database& out) : out_(out) {}

  // Runs that are in `out` already must be equal, but for the CPU that made them.
  void add(const std::string& path) {
    Statement attach = out_.prepare("ATTACH DATABASE ? AS part");
    attach.bind(1, path);
    attach.run();
    {
      Transaction all(out_);
      out_.run(
          "INSERT INTO manifest (version, commit_id, compiler, flags, cpu, command) "
          "SELECT version, commit_id, compiler, flags, cpu, command FROM part.manifest p WHERE NOT EXISTS "
          "(SELECT 1 FROM main.manifest m WHERE m.cpu = p.cpu) ORDER BY p.id");
      refuse_conflicts(path);
      out_.run(fmt::format("INSERT INTO main.run SELECT {} FROM part.run r WHERE id NOT IN (SELECT id FROM main.run)",
                           run_values()));
      out_.run("INSERT OR IGNORE INTO main.frame SELECT * FROM part.frame");  // equal runs have equal frames
      all.commit();
    }
    out_.run("DETACH DATABASE part");
  }

 private:
  // The columns of a run of the part, with the number that its program and CPU have in `out`.
  std::string run_values() const {
    std::string values;
    Statement columns = out_.prepare("SELECT name FROM pragma_table_info('run')");
    while (columns.step()) {
      const std::string name = columns.text(0);
      values += values.empty() ? "" : ", ";
      values += name == "manifest" ? "(SELECT m.id FROM main.manifest m JOIN part.manifest p ON m.cpu = p.cpu "
                                     "WHERE p.id = r.manifest)"
                                   : "r." + name;
    }
    return values;
  }

  void refuse_conflicts(const std::string& path) const {
    std::string names = column_names(out_, "run");
    names.replace(names.find(" manifest,"), std::strlen(" manifest,"), "");
    Statement conflict = out_.prepare(
        fmt::format("SELECT id, scene, policy FROM (SELECT {0} FROM part.run WHERE id IN (SELECT id FROM main.run) "
                    "EXCEPT SELECT {0} FROM main.run) ORDER BY id LIMIT 1",
                    names));
    if (!conflict.step()) return;
    throw InputError({path},
                     fmt::format("run {} (scene {}, policy {}) has other results here than in a store before it; "
                                 "equal sweeps give equal runs, so one of the two is not what it says",
                                 conflict.whole(0), conflict.text(1), conflict.text(2)));
  }

  Database& out_;
};

// Which parts have not all their runs, and which shards are not there at all.
std::string what_is_missing(const Database& out, const std::vector<Part>& parts) {
  std::string text;
  const StoreIdentity& sweep = parts.front().identity;
  const std::int64_t count = sweep.shard.count;
  for (std::int64_t index = 0; index < count; ++index) {
    const Shard shard{index, count};
    const std::int64_t there = out.whole(fmt::format("SELECT count(*) FROM run WHERE id % {} = {}", count, index)),
                       due = shard.runs_of(sweep.runs);
    if (there == due) continue;
    std::string file = "no file given";
    for (const Part& part : parts) {
      if (to_string(part.identity.shard) == to_string(shard)) file = part.path;
    }
    StoreIdentity named = sweep;
    named.shard = shard;
    text += fmt::format("{}{} ({}) has {} of {} runs", text.empty() ? "" : "; ", shard_text(named), file, there, due);
  }
  return text;
}

class Unfinished {
 public:
  explicit Unfinished(std::string path) : path_(std::move(path)) {}
  ~Unfinished() {
    for (const char* ending : {"", "-wal", "-shm"}) ::unlink((path_ + ending).c_str());
  }
  Unfinished(const Unfinished&) = delete;
  Unfinished& operator=(const Unfinished&) = delete;
  const std::string& path() const { return path_; }

 private:
  std::string path_;
};

}  // namespace

MergeOutcome merge_stores(const std::string& out, const std::vector<std::string>& in, bool partial) {
  if (std::filesystem::exists(out)) throw InputError({out}, "is there already; name a new file");
  const std::vector<Part> parts = examine_all(in);
  StoreIdentity whole = parts.front().identity;
  whole.shard = {};
  MergeOutcome outcome{0, whole.runs};
  const Unfinished unfinished(fmt::format("{}.{}.part", out, ::getpid()));
  {
    Store store = Store::begin(unfinished.path(), whole, parts.front().manifest, false);
    Merger merger(store.database());
    for (const Part& part : parts) merger.add(part.path);
    outcome.runs = store.database().whole("SELECT count(*) FROM run");
    if (outcome.runs < outcome.of && !partial) {
      throw InputError({out}, fmt::format("not made, as runs are missing: {}. Run those shards again with --resume, or "
                                          "join what there is with --partial",
                                          what_is_missing(store.database(), parts)));
    }
  }
  if (::rename(unfinished.path().c_str(), out.c_str()) != 0) throw InputError({out}, std::strerror(errno));
  return outcome;
}

}  // namespace framesim
