#include "experiments/traces/trace.h"

#include <nlohmann/json.hpp>

#include "experiments/traces/trace_events.h"
#include "experiments/version.h"

namespace framesim {
namespace {

std::string json_text(const std::string& text) {
  return nlohmann::json(text).dump(-1, ' ', false, nlohmann::json::error_handler_t::replace);
}

std::string item_name(const CommandTimes& command) {
  return command.item == kClearCommand ? "clear" : fmt::format("item {}", command.item);
}

class TraceWriter {
 public:
  TraceWriter(const RunResult& result, const WatchedRun& watched) : result_(result), watched_(watched) {}

  std::string write() {
    for (std::size_t k = 0; k < result_.records.size(); ++k) {
      add_cpu(k);
      add_gpu(k);
      add_display(k);
      add_counters(k);
    }
    for (const Holding& h : watched_.bus) {
      events_.slice(Track::bus, h.by == Passage::fetch ? "fetch" : "upload", h.begin, h.end);
    }
    for (const Holding& h : watched_.client) events_.slice(Track::client, "job", h.begin, h.end);
    add_queues();
    return fmt::format("{{\"displayTimeUnit\":\"ns\",\n\"otherData\":{},\n\"traceEvents\":[\n{},\n{}\n]}}\n",
                       other_data(), metadata(), events_.text());
  }

 private:
  const FrameRecord& record(std::size_t k) const { return result_.records[k]; }

  void add_cpu(std::size_t k) {
    const FrameRecord& r = record(k);
    const WatchedFrame& frame = watched_.frames[k];
    const SimTime start(r.cpu_start_ps), submitted(r.submitted_ps);
    events_.slice(Track::cpu, fmt::format("frame {}", k), start, submitted,
                  fmt::format(R"("budget_ms":{},"planned_ms":{},"benefit":{},"visible":{},"drawn":{},"operations":{})",
                              r.budget_s * 1e3, r.planned_cost_s * 1e3, r.benefit, r.visible, r.drawn, r.operations));
    SimTime at = start;
    const auto part = [&](std::string_view name, std::int64_t length_ps) {
      if (length_ps > 0) events_.slice(Track::cpu, name, at, at + Picoseconds(length_ps));
      at += Picoseconds(length_ps);
    };
    part("logic", r.logic_ps);
    part("visibility", r.visibility_ps);
    part("decision", r.decide_ps);
    part("set-up", frame.cpu_before.count() - r.logic_ps - r.visibility_ps - r.decide_ps);
    part("submission", (submitted - at).count());
    for (const CommandTimes& command : frame.commands) {
      events_.slice(Track::cpu, item_name(command), command.submit_begin, command.submitted);
      events_.flow_from(Track::cpu, command.submit_begin, submitted_++);
    }
  }

  void add_gpu(std::size_t k) {
    const std::vector<CommandTimes>& commands = watched_.frames[k].commands;
    const std::string frame = fmt::format("frame {}", k);
    if (commands.empty()) {
      const SimTime drawn(record(k).drawn_ps);
      events_.slice(Track::primitive, frame + " (both stages, closed form)",
                    drawn - Picoseconds(record(k).draw_time_ps), drawn);
      return;
    }
    events_.slice(Track::primitive, frame, commands.front().primitive_begin, commands.back().primitive_end);
    events_.slice(Track::pixel, frame, commands.front().pixel_begin, commands.back().pixel_end);
    for (const CommandTimes& command : commands) {
      events_.slice(Track::primitive, item_name(command), command.primitive_begin, command.primitive_end);
      events_.flow_to(Track::primitive, command.primitive_begin, drawn_++);
      events_.slice(Track::pixel, item_name(command), command.pixel_begin, command.pixel_end);
    }
  }

  void add_display(std::size_t k) {
    const FrameRecord& r = record(k);
    const SimTime shown(r.shown_ps);
    const std::string name = fmt::format("frame {}", k);
    if (k + 1 < result_.records.size()) {
      events_.slice(Track::display, name, shown, SimTime(record(k + 1).shown_ps));
    } else {
      events_.mark(Track::display, name, shown);  // how long the last one stays is not known
    }
    const SimTime before(k > 0 ? record(k - 1).shown_ps : r.cpu_start_ps);
    const SimTime deadline = before + ceil_picoseconds(result_.target_s);
    events_.mark(Track::display, "deadline", deadline, fmt::format(R"("frame":{},"missed":{})", k, shown > deadline));
    const std::int64_t period = watched_.frames[k].vsync_period.count();
    if (period <= 0) return;
    const std::int64_t after = k > 0 ? before.count() / period + 1 : 0;
    for (std::int64_t blank = after; blank * period <= r.shown_ps; ++blank)
      events_.mark(Track::display, "vertical blank", SimTime(blank * period));
  }

  void add_counters(std::size_t k) {
    const FrameRecord& r = record(k);
    events_.counter("frame time", SimTime(r.shown_ps),
                    fmt::format(R"("ms":{})", to_seconds(Picoseconds(r.frame_time_ps)) * 1e3));
    events_.counter("budget", SimTime(r.cpu_start_ps), fmt::format(R"("ms":{})", r.budget_s * 1e3));
    events_.counter("level switches", SimTime(r.cpu_start_ps), fmt::format(R"("items":{})", r.switches));
  }

  // Commands in each FIFO, at each time at which that changes.
  void add_queues() {
    struct Change {
      SimTime at;
      int primitive, pixel;
    };
    std::vector<Change> changes;
    for (const WatchedFrame& frame : watched_.frames) {
      for (const CommandTimes& c : frame.commands) {
        changes.push_back({c.submitted, 1, 0});
        changes.push_back({c.primitive_begin, -1, 0});
        changes.push_back({c.primitive_end, 0, 1});
        changes.push_back({c.pixel_begin, 0, -1});
      }
    }
    std::stable_sort(changes.begin(), changes.end(), [](const Change& a, const Change& b) { return a.at < b.at; });
    int primitive = 0, pixel = 0, told_primitive = -1, told_pixel = -1;
    for (std::size_t i = 0; i < changes.size(); ++i) {
      primitive += changes[i].primitive;
      pixel += changes[i].pixel;
      const bool more = i + 1 < changes.size() && changes[i + 1].at == changes[i].at;
      if (more || (primitive == told_primitive && pixel == told_pixel)) continue;
      events_.counter("queue depth", changes[i].at, fmt::format(R"("primitive":{},"pixel":{})", primitive, pixel));
      told_primitive = primitive, told_pixel = pixel;
    }
  }

  std::string metadata() const {
    std::string text = fmt::format(R"({{"pid":1,"tid":0,"ph":"M","name":"process_name","args":{{"name":{}}}}})",
                                   json_text("framesim " + result_.scene + ", " + result_.policy));
    for (std::size_t track = 1; track <= kTracks; ++track) {
      if (static_cast<Track>(track) == Track::client && !events_.has(Track::client)) continue;
      text += fmt::format(
          ",\n"
          R"({{"pid":1,"tid":{0},"ph":"M","name":"thread_name","args":{{"name":"{1}"}}}})"
          ",\n"
          R"({{"pid":1,"tid":{0},"ph":"M","name":"thread_sort_index","args":{{"sort_index":{0}}}}})",
          track, kTrackNames[track]);
    }
    return text;
  }

  std::string other_data() const {
    return fmt::format(
        R"({{"program":"framesim {}","scene":{},"policy":{},"machine":{},"overlap":{},"engine":"{}","target_ms":{},"seed":"{}"}})",
        version(), json_text(result_.scene), json_text(result_.policy), json_text(result_.machine),
        json_text(result_.overlap), kEngineKindNames[static_cast<std::size_t>(watched_.kind)], result_.target_s * 1e3,
        result_.seed);
  }

  const RunResult& result_;
  const WatchedRun& watched_;
  TraceEvents events_;
  std::uint64_t submitted_ = 0, drawn_ = 0;  // commands so far: the flows' ids
};

}  // namespace

std::string trace_json(const RunResult& result, const WatchedRun& watched) {
  return TraceWriter(result, watched).write();
}

}  // namespace framesim
