// PORT: an effect: something a scene or machine may call for and that costs nothing where it is not called for.
// To add one: copy effects/vsync.cpp, add a line to effects/registry.cpp and a test.
//
// An effect names the hooks it uses, and is called at those and nowhere else. A run composes its active effects once, at
// load, into one short list a hook (`ActiveEffects`); an empty list costs one comparison a frame, and the engine has no
// branch for any of them. An effect that cannot change the result of this run says why (`inert`) and is then left out;
// leaving it out changes no bit. Effects apply in the order of the registry, whatever the order of declaration.
#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "sim/estimator.h"
#include "sim/frame_record.h"
#include "sim/machine.h"
#include "sim/policy.h"
#include "sim/random_stream.h"
#include "sim/registry.h"
#include "sim/stage_graph.h"

namespace framesim {

// Where an effect acts, in the order of a frame.
enum class Hook : std::uint16_t {
  machine = 1,   // once, at load: the machine is another one
  frame = 2,     // before a frame: its logic time, its vertical blanks
  workload = 4,  // after the benefit model: what things are worth (perception)
  commands = 8,  // after the machine has priced the drawn commands: whole columns, or further commands
  outcome = 16,  // what policy and estimator are told of a frame
  after = 32,    // after the frame: the effect's own state (heat)
};
constexpr Hook operator|(Hook a, Hook b) { return static_cast<Hook>(static_cast<int>(a) | static_cast<int>(b)); }
constexpr bool has(Hook set, Hook hook) { return (static_cast<int>(set) & static_cast<int>(hook)) != 0; }

// What another seed changes of what an effect does. Where it changes times at most, many seeds can share a frame
// (replications.h).
enum class SeedUse : std::uint8_t {
  none,   // nothing
  times,  // at Hook::frame the settings, at Hook::commands both GPU stages of the commands that are there; nothing else
  any,
};

// What is known of the run when an effect is asked whether it is inert.
struct EffectContext {
  const MachineProfile& machine;  // with the effects of Hook::machine before this one applied
  const SceneFacts& scene;
  const LogicLoad& logic;
};

// What effects may change of one frame before it runs.
struct FrameSettings {
  std::int64_t frame = 0;
  Picoseconds logic{0};
  Picoseconds vsync_period{0};  // 0 = shown at once
};

// The frame as it is drawn. `commands` rows name their items.
struct DrawnFrame {
  std::int64_t frame = 0;
  const Workload& workload;
  const Selection& selection;
  const Machine& machine;
};

class Effect {
 public:
  virtual ~Effect() = default;
  virtual Hook hooks() const = 0;
  // Why this effect cannot change any frame of the run, or nothing if it can.
  virtual std::optional<std::string> inert(const EffectContext& context) const = 0;
  virtual SeedUse seed_use() const { return SeedUse::any; }
  // Workload columns that the effect reads beside those of the policy.
  virtual Columns columns() const { return Columns::none; }
  // Once before the first frame; forgets all frames seen.
  virtual void prepare(const EffectContext&) {}

  virtual void on_machine(MachineProfile&) const {}
  virtual void on_frame(FrameSettings&) {}
  // May change `benefit` and nothing else.
  virtual void on_workload(std::int64_t /*frame*/, Workload&) {}
  // May change durations and append rows; row 0 stays the clear.
  virtual void on_commands(const DrawnFrame&, CommandColumns&) {}
  // May change both in place. False: nothing is told after this frame.
  virtual bool on_outcome(FrameOutcome&, EstimateOutcome&) { return true; }
  virtual void after_frame(const FrameRecord&) {}
};

// Registered in effects/registry.cpp. `seed` is the run's master seed; each effect derives its own stream from it.
using EffectEntry = RegistryEntry<Effect, std::uint64_t>;
std::span<const EffectEntry> effects();

// The active effects of a run, composed once: a list a hook.
class ActiveEffects {
 public:
  ActiveEffects() = default;
  // In the order in which they apply; they must outlive this.
  explicit ActiveEffects(const std::vector<Effect*>& effects);

  void prepare(const EffectContext& context) const;
  // Union of what the effects read.
  Columns columns() const { return columns_; }

  std::vector<Effect*> frame, workload, commands, outcome, after;

 private:
  std::vector<Effect*> all_;
  Columns columns_ = Columns::none;
};

}  // namespace framesim
