// Events of the Trace Event Format as text, by track.
#pragma once

#include <fmt/format.h>

#include <algorithm>
#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

#include "sim/units.h"

namespace framesim {

enum class Track : int { cpu = 1, primitive, pixel, bus, display, client };
inline constexpr std::string_view kTrackNames[] = {"",    "CPU",     "GPU per-primitive stage", "GPU per-pixel stage",
                                                   "bus", "display", "GPU's other client"};
inline constexpr std::size_t kTracks = std::size(kTrackNames) - 1;

// Microseconds, exact to the picosecond.
inline std::string trace_us(Picoseconds t) {
  const std::int64_t size = t.count() < 0 ? -t.count() : t.count();
  return fmt::format("{}{}.{:06}", t.count() < 0 ? "-" : "", size / 1'000'000, size % 1'000'000);
}

// Collects events; text() has those of each track in order of time, and of one time in the order in which they were
// added: a slice is added before what is in it. `name`
// and `arguments` stand in the JSON as they are: plain words, and "key": value pairs.
class TraceEvents {
 public:
  void slice(Track track, std::string_view name, SimTime begin, SimTime end, std::string_view arguments = "") {
    add(track, begin,
        fmt::format(R"("ph":"X","name":"{}","dur":{},"args":{{{}}})", name, trace_us(end - begin), arguments));
  }
  void mark(Track track, std::string_view name, SimTime at, std::string_view arguments = "") {
    add(track, at, fmt::format(R"("ph":"i","s":"t","name":"{}","args":{{{}}})", name, arguments));
  }
  // A flow from the slice of `track` that was added last, and to it: viewers bind it to the slice that stands before
  // it.
  void flow_from(Track track, SimTime at, std::uint64_t id) {
    add(track, at, fmt::format(R"("ph":"s","cat":"draw","name":"draw","id":{})", id));
  }
  void flow_to(Track track, SimTime at, std::uint64_t id) {
    add(track, at, fmt::format(R"("ph":"f","bp":"e","cat":"draw","name":"draw","id":{})", id));
  }
  // Counters are in order of time, each by itself.
  void counter(std::string_view name, SimTime at, std::string_view values) {
    counters_.push_back({at, fmt::format(R"("ph":"C","name":"{}","args":{{{}}})", name, values)});
  }

  bool has(Track track) const { return !events_[static_cast<std::size_t>(track)].empty(); }
  // Events separated by commas and line breaks.
  std::string text();

 private:
  struct Event {
    SimTime at{0};
    std::string text;
  };
  void add(Track track, SimTime at, std::string text) {
    events_[static_cast<std::size_t>(track)].push_back({at, std::move(text)});
  }

  std::vector<Event> events_[kTracks + 1];
  std::vector<Event> counters_;
};

inline std::string TraceEvents::text() {
  std::string out;
  const auto append = [&](std::vector<Event>& events, int tid) {
    std::stable_sort(events.begin(), events.end(), [](const Event& a, const Event& b) { return a.at < b.at; });
    for (const Event& event : events) {
      out += fmt::format("{}{{\"pid\":1,\"tid\":{},\"ts\":{},{}}}", out.empty() ? "" : ",\n", tid, trace_us(event.at),
                         event.text);
    }
  };
  for (std::size_t track = 1; track <= kTracks; ++track) append(events_[track], static_cast<int>(track));
  append(counters_, 0);
  return out;
}

}  // namespace framesim
