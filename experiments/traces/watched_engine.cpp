#include "experiments/traces/watched_engine.h"

#include <fmt/format.h>

#include <algorithm>

#include "sim/check.h"
#include "sim/event_engine.h"

namespace framesim {

class Watch::WatchedEngine final : public Engine {
 public:
  WatchedEngine(Watch& watch, const MachineProfile& machine, const EngineOptions& options)
      : watch_(watch), engine_(make_engine(machine, options)) {
    watch_.run_.kind = engine_->kind();
    if (engine_->kind() == EngineKind::closed_form) return;
    MachineProfile watched = machine;
    if (engine_->kind() == EngineKind::recurrence) watched.bus = {}, watched.client = {};  // it leaves them out
    events_ = std::make_unique<EventEngine>(watched, &watch_.log_);
  }

  EngineKind kind() const override { return engine_->kind(); }

  FrameTimes run(const FrameWork& work) override {
    WatchedFrame frame{.times = engine_->run(work), .cpu_before = work.cpu_before, .vsync_period = work.vsync_period};
    if (events_) {
      const FrameTimes seen = events_->run(work);
      FRAMESIM_CHECK(
          seen.shown == frame.times.shown && seen.submitted == frame.times.submitted,
          fmt::format("shown at {} ps, by the watched engine at {} ps", frame.times.shown.count(), seen.shown.count()));
      frame.commands.resize(work.commands.size());
      for (std::size_t i = 0; i < frame.commands.size(); ++i) frame.commands[i].item = work.commands.item[i];
    }
    watch_.run_.frames.push_back(std::move(frame));
    return watch_.run_.frames.back().times;
  }

 private:
  Watch& watch_;
  std::unique_ptr<Engine> engine_;
  std::unique_ptr<EventEngine> events_;
};

namespace {

SimTime& time_of(CommandTimes& command, Passage passage) {
  switch (passage) {
    case Passage::primitive_begin:
      return command.primitive_begin;
    case Passage::primitive_end:
      return command.primitive_end;
    case Passage::pixel_begin:
      return command.pixel_begin;
    case Passage::pixel_end:
      return command.pixel_end;
    default:
      return command.submitted;
  }
}

// A grant ends when its length has passed, or with the next one.
void note_grant(const PassageEntry& entry, std::vector<Holding>& bus) {
  if (!bus.empty()) bus.back().end = std::min(bus.back().end, entry.at);
  bus.push_back({entry.passage, entry.at, entry.at + entry.length});
}

}  // namespace

EngineMaker Watch::maker() {
  return [this](const MachineProfile& machine, const EngineOptions& options) -> std::unique_ptr<Engine> {
    return std::make_unique<WatchedEngine>(*this, machine, options);
  };
}

WatchedRun Watch::finish() {
  std::vector<CommandTimes*> commands;
  for (WatchedFrame& frame : run_.frames) {
    for (CommandTimes& command : frame.commands) commands.push_back(&command);
  }
  for (const PassageEntry& entry : log_.entries) {
    if (entry.passage == Passage::upload || entry.passage == Passage::fetch) {
      note_grant(entry, run_.bus);
    } else if (entry.passage == Passage::client_end) {
      run_.client.push_back({entry.passage, entry.at - entry.length, entry.at});
    } else {
      time_of(*commands.at(entry.command), entry.passage) = entry.at;
    }
  }
  log_ = {};
  for (WatchedFrame& frame : run_.frames) {
    SimTime begin = frame.times.cpu_start + frame.cpu_before;
    for (CommandTimes& command : frame.commands) {
      command.submit_begin = begin;
      begin = command.submitted;
    }
  }
  return std::move(run_);
}

Picoseconds gpu_busy(const WatchedFrame& frame, SimTime drawn_before) {
  std::vector<std::pair<SimTime, SimTime>> spans;
  for (const CommandTimes& c : frame.commands) {
    spans.emplace_back(c.primitive_begin, c.primitive_end);
    spans.emplace_back(c.pixel_begin, c.pixel_end);
  }
  std::sort(spans.begin(), spans.end());
  Picoseconds busy{0};
  SimTime until = drawn_before;
  for (const auto& [begin, end] : spans) {
    if (end <= until) continue;
    busy += end - std::max(begin, until);
    until = end;
  }
  return busy;
}

}  // namespace framesim
