#include "sim/benchmark.h"

#include <fmt/format.h>

#include "sim/engine.h"
#include "sim/policy.h"

namespace framesim {

namespace {

// When the last of `commands` leaves the per-pixel stage of an idle machine. The recurrence runs whatever overlap the
// profile has: closed forms say how a frame overlaps with the CPU, not how the GPU's stages do.
double run_s(const Machine& machine, const CommandColumns& commands) {
  const auto engine = make_engine(machine.profile(), {.kind = EngineKind::recurrence});
  return to_seconds(engine->run({.commands = commands}).drawn);
}

double batch_s(const Machine& machine, const Facts& facts, double area_px, int draws) {
  machine.count_benchmark_draws(draws);
  const Machine::StageTimes times = machine.draw_time(facts, area_px, 1, false);
  const auto n = static_cast<std::size_t>(draws);
  CommandColumns commands;
  commands.submit_ps.assign(n, 0);
  commands.primitive_ps.assign(n, ceil_picoseconds(times.primitive_s).count());
  commands.pixel_ps.assign(n, ceil_picoseconds(times.pixel_s).count());
  commands.item.assign(n, 0);
  return run_s(machine, commands);
}

}  // namespace

double measure_draw_s(const Machine& machine, const Facts& facts, double area_px, int draws) {
  FRAMESIM_CHECK(draws >= 1 && draws <= 1'000'000, fmt::format("{} draws", draws));
  return (batch_s(machine, facts, area_px, 2 * draws) - batch_s(machine, facts, area_px, draws)) / draws;
}

double measure_empty_frame_s(const Machine& machine) {
  CommandColumns commands;
  machine.command(Workload{}, Selection{}, commands);
  return run_s(machine, commands);
}

LogicBenchmark::LogicBenchmark(const LogicLoad& load)
    : base_s_(load.base_s), per_item_s_(load.per_item_s), tasks_s_(to_seconds(StageGraph(load.tasks).task_time())) {}

double LogicBenchmark::measure_s(std::int64_t visible) const {
  FRAMESIM_CHECK(visible >= 0, fmt::format("{} visible items", visible));
  return base_s_ + per_item_s_ * static_cast<double>(visible) + tasks_s_;
}

}  // namespace framesim
