#include "sim/replications.h"

#include <fmt/format.h>

#include <algorithm>

#include "sim/check.h"
#include "sim/record_times.h"

namespace framesim {
namespace {

bool has_bus_or_client(const MachineProfile& machine) {
  return machine.bus.chunk.count() > 0 || machine.client.period.count() > 0;
}

// An effect that each seed has for itself: it acts on the frame's settings, or varies times by its seed. All others act
// once.
bool is_own(const Effect& effect) { return has(effect.hooks(), Hook::frame) || effect.seed_use() == SeedUse::times; }

std::optional<std::string> obstacle(const Effect& effect) {
  const Hook hooks = effect.hooks();
  if (has(hooks, Hook::after)) return "an effect keeps a state of what the frames took";
  if (effect.seed_use() == SeedUse::any) return "an effect uses its seed for more than times";
  if (effect.seed_use() == SeedUse::times &&
      (has(hooks, Hook::machine) || has(hooks, Hook::workload) || has(hooks, Hook::outcome))) {
    return "an effect uses its seed at hooks that do not change times";
  }
  if (has(hooks, Hook::frame) && effect.seed_use() == SeedUse::none && hooks != Hook::frame &&
      hooks != (Hook::frame | Hook::machine)) {
    return "an effect acts on the frame's settings and elsewhere too";
  }
  return std::nullopt;
}

}  // namespace

std::optional<std::string> sharing_obstacle(const PolicyTraits& policy, const Estimator& estimator,
                                            std::span<Effect* const> effects, const MachineProfile& machine) {
  if (policy.uses_feedback) return "the policy learns from outcomes";
  if (estimator.learns()) return "the estimator learns from outcomes";
  if (has_bus_or_client(machine)) return "the GPU is shared with uploads or another client";
  bool varied = false;
  for (const Effect* effect : effects) {
    if (auto why = obstacle(*effect)) return why;
    if (!has(effect->hooks(), Hook::commands)) continue;
    if (varied && !is_own(*effect)) return "an effect changes commands after one that uses its seed";
    varied = varied || is_own(*effect);
  }
  return std::nullopt;
}

// Stands last among the shared simulation's effects, and keeps what the seeds start from.
class Replications::Probe final : public Effect {
 public:
  Hook hooks() const override { return Hook::frame | Hook::commands; }
  SeedUse seed_use() const override { return SeedUse::none; }
  std::optional<std::string> inert(const EffectContext&) const override { return std::nullopt; }
  void on_frame(FrameSettings& settings) override { settings_ = settings; }
  void on_commands(const DrawnFrame& drawn, CommandColumns&) override { drawn_.emplace(drawn); }

  const FrameSettings& settings() const { return settings_; }
  const DrawnFrame& drawn() const { return *drawn_; }

 private:
  FrameSettings settings_;
  std::optional<DrawnFrame> drawn_;
};

// The shared simulation's engine: it times all seeds, and tells the simulation of the first.
class Replications::SharedFrame final : public Engine {
 public:
  explicit SharedFrame(Replications& replications) : replications_(replications) {}
  EngineKind kind() const override { return replications_.kind_; }
  FrameTimes run(const FrameWork& work) override { return replications_.time_frame(work); }

 private:
  Replications& replications_;
};

Replications::Replications(const SimulationParts& parts, const SimulationConfig& config,
                           std::vector<std::vector<Effect*>> effects)
    : machine_(parts.machine.profile()),
      options_(config.engine),
      kind_(make_engine(machine_, options_)->kind()),
      side_by_side_(kind_ == EngineKind::recurrence && !options_.critical_path),
      seeds_(effects.size()),
      probe_(std::make_unique<Probe>()),
      records_(effects.size()) {
  FRAMESIM_CHECK(!effects.empty(), "no seeds");
  const auto why = sharing_obstacle(parts.policy.traits(), parts.estimator, effects.front(), machine_);
  FRAMESIM_CHECK(!why, *why);
  const EffectContext context{.machine = machine_, .scene = parts.scene.scene(), .logic = parts.logic};
  for (std::size_t s = 0; s < seeds_.size(); ++s) {
    FRAMESIM_CHECK(effects[s].size() == effects.front().size(),
                   fmt::format("seed {} has {} effects, the first {}", s, effects[s].size(), effects.front().size()));
    for (Effect* effect : effects[s]) {
      if (!is_own(*effect)) continue;
      effect->prepare(context);
      if (has(effect->hooks(), Hook::frame)) seeds_[s].frame.push_back(effect);
      if (has(effect->hooks(), Hook::commands)) seeds_[s].commands.push_back(effect);
    }
  }
  if (side_by_side_) {
    groups_.assign((seeds_.size() + kLanes - 1) / kLanes, RecurrenceLanes(machine_));
  } else {
    for (std::size_t s = 0; s < seeds_.size(); ++s) engines_.push_back(make_engine(machine_, options_));
  }
  SimulationParts shared_parts = parts;
  shared_parts.effects.clear();
  for (Effect* effect : effects.front()) {
    if (!is_own(*effect)) shared_parts.effects.push_back(effect);
  }
  shared_parts.effects.push_back(probe_.get());
  SimulationConfig shared_config = config;
  shared_config.make_engine = [this] { return std::make_unique<SharedFrame>(*this); };
  simulation_ = std::make_unique<Simulation>(shared_parts, shared_config);
}

Replications::~Replications() = default;

std::int64_t Replications::frames() const { return simulation_->frames(); }

std::span<const FrameRecord> Replications::step() {
  const FrameRecord& shared = simulation_->step();
  for (std::size_t s = 0; s < seeds_.size(); ++s) {
    records_[s] = shared;
    records_[s].logic_ps = seeds_[s].settings.logic.count();
    record_times(seeds_[s].times, kind_, records_[s]);
  }
  return records_;
}

// `shared` has the frame's settings before any effect: the effects of Hook::frame are the seeds' own.
FrameTimes Replications::time_frame(const FrameWork& shared) {
  for (Seed& seed : seeds_) settle(shared, seed);
  if (side_by_side_) {
    if (seeds_.front().commands.empty()) {
      std::array<const CommandColumns*, kLanes> same;
      same.fill(&shared.commands);
      lanes_.resize(shared.commands.size());
      lanes_.interleave(same);
    }
    lanes_.submit_ps = shared.commands.submit_ps;
    for (std::size_t first = 0; first < seeds_.size(); first += kLanes) run_group(shared, first);
    return seeds_.front().times;
  }
  for (std::size_t s = 0; s < seeds_.size(); ++s) {
    Seed& seed = seeds_[s];
    seed.times = engines_[s]->run({.cpu_before = seed.cpu_before,
                                   .swap = shared.swap,
                                   .vsync_period = seed.settings.vsync_period,
                                   .commands = vary(shared, seed, varied_[0])});
  }
  return seeds_.front().times;
}

void Replications::settle(const FrameWork& shared, Seed& seed) const {
  seed.settings = probe_->settings();
  for (Effect* effect : seed.frame) effect->on_frame(seed.settings);
  seed.cpu_before = shared.cpu_before - probe_->settings().logic + seed.settings.logic;
}

// The frame's commands as the seed varies them, in `room` if it does.
const CommandColumns& Replications::vary(const FrameWork& shared, const Seed& seed, CommandColumns& room) const {
  if (seed.commands.empty()) return shared.commands;
  room = shared.commands;
  for (Effect* effect : seed.commands) effect->on_commands(probe_->drawn(), room);
  FRAMESIM_CHECK(room.submit_ps == shared.commands.submit_ps && room.primitive_ps.size() == room.submit_ps.size() &&
                     room.pixel_ps.size() == room.submit_ps.size(),
                 fmt::format("frame {}: an effect that uses its seed for times only changed the number of commands or "
                             "their submission",
                             probe_->drawn().frame));
  return room;
}

// Seeds first .. first + kLanes - 1; lanes without a seed repeat the first of them.
void Replications::run_group(const FrameWork& shared, std::size_t first) {
  const std::size_t count = std::min(kLanes, seeds_.size() - first);
  LaneWork work{.swap = shared.swap, .commands = lanes_};
  std::array<const CommandColumns*, kLanes> columns;
  for (std::size_t lane = 0; lane < kLanes; ++lane) {
    const Seed& seed = seeds_[first + (lane < count ? lane : 0)];
    columns[lane] = lane < count ? &vary(shared, seed, varied_[lane]) : columns[0];
    work.cpu_before[lane] = seed.cpu_before;
    work.vsync_period[lane] = seed.settings.vsync_period;
  }
  if (!seeds_[first].commands.empty()) {
    lanes_.resize(shared.commands.size());
    lanes_.interleave(columns);
  }
  std::array<FrameTimes, kLanes> times;
  groups_[first / kLanes].run(work, times);
  for (std::size_t lane = 0; lane < count; ++lane) seeds_[first + lane].times = times[lane];
}

}  // namespace framesim
