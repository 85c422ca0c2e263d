// What a sweep runs: scenes x parameters x targets x policies x seeds, read from a TOML file such as
//
//     framesim = 1
//     scenes = ["street", "yard.toml"]          # a file is taken from this file's folder
//     policies = ["robin-hood", "funkhouser:rule=repaired", "static"]
//     targets = ["16ms", "33ms"]                # left out: each scene's first; ["all"]: each scene's own list
//     effects = ["jitter:sigma=0.1"]            # added to the scenes' own
//     seeds = 10                                # replications, from first_seed up
//     frame_rows = true                         # keep every frame record too
//
//     [[vary]]                                  # one run more for each value; several [[vary]] multiply
//     of = "policy"                             # scene, policy, estimator, planner or effect
//     name = "robin-hood"                       # those of this name; the others are left as they are
//     key = "value"
//     values = [8, 11]
//
// Also: estimators, planners and overlaps (lists), machine, no_effects, first_seed, frames, fidelity, yardstick.
// Every policy meets the same seeds, so that differences between policies are paired (common random numbers).
#pragma once

#include <cstdint>
#include <memory>
#include <string>
#include <vector>

#include "experiments/batch.h"
#include "experiments/store/manifest.h"
#include "experiments/yardstick.h"

namespace framesim {

inline constexpr std::int64_t kMostRuns = 1'000'000;

// One of `count` parts of a sweep: the runs whose number leaves the remainder `index`.
struct Shard {
  std::int64_t index = 0, count = 1;
  bool has(std::int64_t run) const { return run % count == index; }
  std::int64_t runs_of(std::int64_t all) const { return (all - index + count - 1) / count; }
};
std::string to_string(const Shard& shard);  // "0/4"
// "i/n" with i from 0 to n, where n stands for 0, so that job arrays counted from 0 or from 1 both cover every part.
// Throws InputError ("command line").
Shard parse_shard(const std::string& text);

struct Sweep {
  std::string path;
  std::vector<Job> runs;  // numbered by their place: by scene, target, parameters, policy, seed
  Yardstick yardstick = Yardstick::bound;
  bool frame_rows = false;
  std::string machine;            // as results name it: the file's word for it; empty: each scene's own
  std::vector<InputFile> inputs;  // the sweep's file and all that it names
  std::string plan_hash;          // SHA-256 of all runs, written out: equal sweeps, equal hashes
};

// Reads and checks everything, down to every run's parts, before the first run. Throws InputError with file:line:column.
Sweep read_sweep(const std::string& path);

}  // namespace framesim
