#include "sim/machine.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "sim/parameters.h"
#include "sim/policy.h"
#include "sim/quantity.h"

namespace framesim {

namespace {

void require_cost(const std::string& machine, const char* name, double value) {
  if (std::isfinite(value) && value >= 0 && value <= to_seconds(kLongestDuration)) return;
  throw InputError({"machine " + machine},
                   fmt::format("{} is {}; allowed is a finite time from 0 to one day", name, value));
}

// A number, not a time: files and fits have the same range.
void require_number(const std::string& machine, const char* name, double value, double high) {
  if (value >= 0 && value <= high) return;
  throw InputError({"machine " + machine}, fmt::format("{} is {}; allowed is 0 to {}", name, value, high));
}

void require_fifo(const std::string& machine, const char* name, int value) {
  if (value >= 1 && value <= 1'000'000) return;
  throw InputError({"machine " + machine}, fmt::format("{} is {}; allowed are 1 to 1000000 commands", name, value));
}

const AlgorithmCosts& costs_of(const MachineProfile& profile, Algorithm algorithm) {
  return profile.algorithm[static_cast<std::size_t>(algorithm)];
}

void append(double submit_s, Machine::StageTimes times, std::uint32_t item, CommandColumns& commands) {
  commands.submit_ps.push_back(ceil_picoseconds(submit_s).count());
  commands.primitive_ps.push_back(ceil_picoseconds(times.primitive_s).count());
  commands.pixel_ps.push_back(ceil_picoseconds(times.pixel_s).count());
  commands.item.push_back(item);
}

}  // namespace

Overlap parse_overlap(std::string_view text, const InputLocation& where) {
  const std::string allowed =
      "allowed are staged, staged:N (1 to 4 frames in flight), serial, paper2005, max-plus-s:S (S in 0..1)";
  const auto refuse = [&] { throw InputError(where, fmt::format("'{}' is no overlap model; {}", text, allowed)); };
  const std::size_t colon = text.find(':');
  const std::string_view name = text.substr(0, colon);
  std::optional<double> argument;
  if (colon != std::string_view::npos) {
    argument = parse_number(text.substr(colon + 1)).value;
    if (!argument) refuse();
  }
  Overlap overlap;
  if (name == "staged") {
    overlap.kind = OverlapKind::staged;
    const double frames = argument.value_or(1);
    if (frames != 1 && frames != 2 && frames != 3 && frames != 4) refuse();
    overlap.frames_in_flight = static_cast<int>(frames);
  } else if (name == "serial" && !argument) {
    overlap = {.kind = OverlapKind::serial, .serial_share = 1};
  } else if (name == "paper2005" && !argument) {
    overlap = {.kind = OverlapKind::paper2005, .serial_share = 1.0 / 3};
  } else if (name == "max-plus-s" && argument && *argument >= 0 && *argument <= 1) {
    overlap = {.kind = OverlapKind::max_plus, .serial_share = *argument};
  } else {
    refuse();
  }
  return overlap;
}

std::string to_string(const Overlap& overlap) {
  switch (overlap.kind) {
    case OverlapKind::staged:
      return fmt::format("staged:{}", overlap.frames_in_flight);
    case OverlapKind::serial:
      return "serial";
    case OverlapKind::paper2005:
      return "paper2005";
    case OverlapKind::max_plus:
      return fmt::format("max-plus-s:{}", overlap.serial_share);
  }
  return "?";
}

double serial_share(const Overlap& overlap) {
  switch (overlap.kind) {
    case OverlapKind::serial:
      return 1;
    case OverlapKind::paper2005:
      return 1.0 / 3;
    case OverlapKind::max_plus:
      return overlap.serial_share;
    case OverlapKind::staged:
      break;
  }
  FRAMESIM_CHECK(overlap.kind != OverlapKind::staged, "the staged overlap has no closed form; name one");
  return 0;
}

void CommandColumns::clear() {
  submit_ps.clear();
  primitive_ps.clear();
  pixel_ps.clear();
  item.clear();
  upload_ps.clear();
  fetch_ps.clear();
  facts.clear();
  upload_bytes = 0;
}

Machine::Machine(MachineProfile profile) : profile_(std::move(profile)) {
  const MachineProfile& p = profile_;
  for (std::size_t a = 0; a < kAlgorithmCount; ++a) {
    const AlgorithmCosts& costs = p.algorithm[a];
    require_cost(p.name, "draw", costs.draw_s);
    require_cost(p.name, "polygon", costs.polygon_s);
    require_cost(p.name, "vertex", costs.vertex_s);
    require_cost(p.name, "texture_byte", costs.texture_byte_s);
    require_cost(p.name, "pixel", costs.pixel_s);
    require_number(p.name, "pixel_nonlinearity", costs.pixel_nonlinearity, kLargestPixelNonlinearity);
    require_number(p.name, "area_exponent", costs.area_exponent, kLargestAreaExponent);
  }
  require_cost(p.name, "submit", p.submit_s);
  require_cost(p.name, "submit_draw", p.submit_draw_s);
  require_cost(p.name, "frame_setup", p.frame_setup_s);
  require_cost(p.name, "clear", p.clear_s);
  require_cost(p.name, "swap", p.swap_s);
  require_cost(p.name, "visibility_test", p.visibility_test_s);
  require_cost(p.name, "operation", p.operation_s);
  require_fifo(p.name, "primitive_fifo", p.primitive_fifo);
  require_fifo(p.name, "pixel_fifo", p.pixel_fifo);
}

double draws_issued(const Facts& facts, double resolution, bool draws_scale_below_knee) {
  if (!draws_scale_below_knee) return facts.draws;
  return std::min(facts.draws, (facts.polygons + facts.lines + facts.points) * resolution);
}

Machine::LevelCosts Machine::level_costs(const Facts& facts) const {
  if (facts.stated_cost_s) return {.primitives_s = *facts.stated_cost_s};
  const AlgorithmCosts& costs = costs_of(profile_, facts.algorithm);
  const double own = costs.polygon_s * facts.polygons + costs.vertex_s * facts.vertices;
  const double lines = costs_of(profile_, Algorithm::lines).polygon_s * facts.lines;
  const double points = costs_of(profile_, Algorithm::points).polygon_s * facts.points;
  return {.draws_s = costs.draw_s * facts.draws,
          .primitives_s = own + costs.texture_byte_s * facts.texture_bytes + lines + points,
          .growing_s = own + lines + points,
          .area_exponent = costs.area_exponent,
          .coverage = facts.coverage,
          .pixel_s = costs.pixel_s,
          .pixel_nonlinearity = costs.pixel_nonlinearity};
}

Machine::StageTimes Machine::draw_time(const Facts& facts, double area_px, double resolution,
                                       bool draws_scale_below_knee) const {
  LevelCosts costs = level_costs(facts);
  if (draws_scale_below_knee && !facts.stated_cost_s) {
    costs.draws_s = costs_of(profile_, facts.algorithm).draw_s * draws_issued(facts, resolution, true);
  }
  return costs.times(area_px, resolution);
}

double Machine::submit_s(double draws) const {
  return profile_.submit_s + profile_.submit_draw_s * std::max(0.0, draws - 1);
}

Machine::DrawTimes Machine::draw_times(const Workload& workload, std::size_t item, std::size_t level,
                                       double resolution) const {
  const Facts& facts = workload.level_facts(item, level);
  const bool scale = workload.kind[item] == ItemKind::curve && workload.type_of(item).draws_scale_below_knee;
  return {.submit_s = submit_s(draws_issued(facts, resolution, scale)),
          .stages = draw_time(facts, workload.projected_area_px[item], resolution, scale)};
}

void Machine::draw(const Workload& workload, std::size_t item, std::size_t level, double resolution,
                   CommandColumns& commands) const {
  const DrawTimes times = draw_times(workload, item, level, resolution);
  append(times.submit_s, times.stages, static_cast<std::uint32_t>(item), commands);
  if (profile_.bus.chunk.count() > 0) {
    commands.facts.push_back(workload.facts_begin[item] + static_cast<std::uint32_t>(level));
  }
}

void Machine::command(const Workload& workload, const Selection& selection, CommandColumns& commands) const {
  append(0, {.primitive_s = 0, .pixel_s = profile_.clear_s}, kClearCommand, commands);
  if (profile_.bus.chunk.count() > 0) commands.facts.push_back(kClearCommand);
  for (std::size_t i = 0; i < workload.size(); ++i) {
    if (selection.level[i] == kNotDrawn) continue;
    draw(workload, i, static_cast<std::size_t>(selection.level[i]), selection.resolution[i], commands);
  }
}

}  // namespace framesim
