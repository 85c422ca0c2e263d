// Options that `run` and `compare` share, and how their words are read. CLI11 fills plain strings; framesim's own
// parsers read them, so that command line, scene file and golden tables take the same words and answer with the same
// messages.
#pragma once

#include <span>
#include <string>
#include <vector>

#include "experiments/run.h"

namespace CLI {
class App;
}

namespace framesim {

struct SharedOptions {
  std::string estimator{kDefaultEstimator};
  std::string machine, overlap, planner;  // empty: not given
  std::vector<std::string> effects, no_effects;
  std::string frames = "all";  // or a count
  std::string fidelity = "auto";
  std::string seed = "1";
  std::string limit_instances;  // empty: not given
  bool outside_paths = false;
  bool verify = false;
  bool force_inert = false;
};

void add_shared_options(CLI::App& app, SharedOptions& options);
void add_jobs_option(CLI::App& app, int& jobs);
void add_quiet_option(CLI::App& app, bool& quiet);

// A RunSpec without scene, policy and target. Throws InputError at `where` for a word that cannot be taken.
RunSpec read_shared(const SharedOptions& options, const InputLocation& where);

// One line on stderr for each different thing that an engine asked for leaves out of these runs; nothing where it is
// exact.
void note_left_out(EngineKind asked, std::span<const RunResult> results);

// Commas separate specs, except that a piece of the form key=value (no ':' before the '=') belongs to the spec before
// it: "distance,robin-hood:value=8,levels=no,static" is three specs. Texts are read in order.
std::vector<Spec> read_specs(const std::vector<std::string>& texts, const InputLocation& where);

// "all" is 0, for the whole camera path; or a count.
std::int64_t read_frames(const std::string& text, const InputLocation& where);

// A wanted frame time: "25ms", "60fps"; more than 0.
double read_target_s(const std::string& text, const InputLocation& where);

// Splits at commas; an empty piece is refused.
std::vector<std::string> split_list(const std::vector<std::string>& texts, const InputLocation& where);

}  // namespace framesim
