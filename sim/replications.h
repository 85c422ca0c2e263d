// Many seeds of one run at once.
//
// Where nothing of a frame's times flows back into a decision, all seeds see, decide and submit the same in each frame. That
// part is then simulated once; what the seed changes (GPU times by jitter, logic times by spikes) is drawn for each seed, and
// the staged recurrence runs eight seeds side by side in vector registers (recurrence_lanes.h). Each seed's records are those
// of a run of its own, bit for bit.
#pragma once

#include <memory>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "sim/recurrence_lanes.h"
#include "sim/simulation.h"

namespace framesim {

// Why the seeds of a run cannot share its frames, in words, or nothing if they can: the policy or the estimator learns from
// outcomes; an effect keeps a state of the frame's times (Hook::after) or of more than one hook of which one is Hook::frame,
// uses its seed for more than times, or changes commands after one that uses its seed; the GPU has a shared bus or client.
// `effects` are the active ones of one seed, in the order in which they apply.
std::optional<std::string> sharing_obstacle(const PolicyTraits& policy, const Estimator& estimator,
                                            std::span<Effect* const> effects, const MachineProfile& machine);

class Replications {
 public:
  // parts.effects is not read: effects[s] are the active effects of seed s, the same ones in the same order for each seed. All
  // must outlive this, and sharing_obstacle() must find none. At least one seed.
  Replications(const SimulationParts& parts, const SimulationConfig& config, std::vector<std::vector<Effect*>> effects);
  ~Replications();
  Replications(const Replications&) = delete;
  Replications& operator=(const Replications&) = delete;

  std::int64_t frames() const;
  // Runs the next frame of all seeds; one record each.
  std::span<const FrameRecord> step();
  // Whether the engine runs eight seeds in one register: the recurrence, without a traced critical path.
  bool side_by_side() const { return side_by_side_; }

 private:
  class Probe;
  class SharedFrame;

  // One seed: its own effects, and what it made of this frame.
  struct Seed {
    std::vector<Effect*> frame, commands;
    FrameSettings settings;
    Picoseconds cpu_before{0};
    FrameTimes times;
  };

  FrameTimes time_frame(const FrameWork& shared);
  void settle(const FrameWork& shared, Seed& seed) const;
  const CommandColumns& vary(const FrameWork& shared, const Seed& seed, CommandColumns& room) const;
  void run_group(const FrameWork& shared, std::size_t first);

  MachineProfile machine_;
  EngineOptions options_;
  EngineKind kind_;
  bool side_by_side_;
  std::vector<Seed> seeds_;
  std::unique_ptr<Probe> probe_;
  std::vector<RecurrenceLanes> groups_;           // side by side, eight seeds each
  std::vector<std::unique_ptr<Engine>> engines_;  // else one a seed
  std::array<CommandColumns, kLanes> varied_;
  LaneCommands lanes_;
  std::vector<FrameRecord> records_;
  std::unique_ptr<Simulation> simulation_;  // of the shared frames
};

}  // namespace framesim
