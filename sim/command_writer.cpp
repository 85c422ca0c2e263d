#include "sim/command_writer.h"

#include <algorithm>

#include "sim/policy.h"

namespace framesim {
namespace {

void resize(CommandColumns& commands, std::size_t rows, bool bus) {
  commands.submit_ps.resize(rows);
  commands.primitive_ps.resize(rows);
  commands.pixel_ps.resize(rows);
  commands.item.resize(rows);
  commands.facts.resize(bus ? rows : 0);
}

}  // namespace

void CommandWriter::prepare(const Machine& machine, const Workload& workload) {
  levels_.clear();
  if (workload.static_facts > workload.size()) return;
  for (std::uint32_t f = 0; f < workload.static_facts; ++f) {
    const Facts& facts = workload.facts[f];
    Level level{.costs = machine.level_costs(facts)};
    const double submit_s = machine.submit_s(facts.draws), primitive_s = level.costs.times(0, 1).primitive_s;
    level.known = std::max(submit_s, primitive_s) <= to_seconds(kLongestDuration);
    if (level.known) {
      level.submit_ps = ceil_picoseconds(submit_s).count();
      level.primitive_ps = ceil_picoseconds(primitive_s).count();
    }
    levels_.push_back(level);
  }
}

const CommandWriter::Level* CommandWriter::find(const Workload& workload, std::size_t item, std::size_t level) const {
  const std::size_t facts = workload.facts_begin[item] + level;
  if (facts >= levels_.size() || !levels_[facts].known) return nullptr;
  // The draw calls of a small curve depend on its resolution.
  if (workload.kind[item] == ItemKind::curve && workload.type_of(item).draws_scale_below_knee) return nullptr;
  return &levels_[facts];
}

void CommandWriter::write(const Machine& machine, const Workload& workload, const Selection& selection,
                          CommandColumns& commands) {
  prepare(machine, workload);
  const std::size_t items = workload.size();
  const bool bus = machine.profile().bus.chunk.count() > 0;
  resize(commands, items + 1, bus);
  commands.upload_ps.clear();
  commands.fetch_ps.clear();
  commands.upload_bytes = 0;
  std::size_t row = 0;
  const auto put = [&](std::int64_t submit_ps, std::int64_t primitive_ps, double pixel_s, std::uint32_t item) {
    commands.submit_ps[row] = submit_ps;
    commands.primitive_ps[row] = primitive_ps;
    commands.pixel_ps[row] = ceil_picoseconds(pixel_s).count();
    commands.item[row++] = item;
  };
  if (bus) commands.facts[row] = kClearCommand;
  put(0, 0, machine.profile().clear_s, kClearCommand);
  for (std::size_t i = 0; i < items; ++i) {
    if (selection.level[i] == kNotDrawn) continue;
    const auto level = static_cast<std::size_t>(selection.level[i]);
    const double resolution = selection.resolution[i], area_px = workload.projected_area_px[i];
    const auto item = static_cast<std::uint32_t>(i);
    if (bus) commands.facts[row] = workload.facts_begin[i] + static_cast<std::uint32_t>(level);
    if (const Level* const known = find(workload, i, level)) {
      const Machine::StageTimes times = known->costs.times(area_px, resolution);
      const bool same = resolution == 1 && !known->costs.primitives_depend_on_view();
      put(known->submit_ps, same ? known->primitive_ps : ceil_picoseconds(times.primitive_s).count(), times.pixel_s,
          item);
    } else {
      const Machine::DrawTimes draw = machine.draw_times(workload, i, level, resolution);
      put(ceil_picoseconds(draw.submit_s).count(), ceil_picoseconds(draw.stages.primitive_s).count(),
          draw.stages.pixel_s, item);
    }
  }
  resize(commands, row, bus);
}

}  // namespace framesim
