#include "tests/experiments/trace_checker.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <map>

namespace framesim {
namespace {

using nlohmann::json;

// Whole picoseconds, so that 0.1 + 0.2 us is 0.3 us.
std::int64_t ps_of(const json& us) { return std::llround(us.get<double>() * 1e6); }

std::string text_of(const json& event, const char* key) {
  const auto found = event.find(key);
  if (found == event.end()) return "";
  return found->is_string() ? found->get<std::string>() : found->dump();
}

struct Slice {
  std::int64_t begin, end;
  std::string name;
};

struct Flow {
  std::int64_t begun = 0, ended = 0, first = 0, last = 0;
  bool old_style = false;
};

class Checker {
 public:
  explicit Checker(bool ordered) : ordered_(ordered) {}

  TraceFacts check(const json& trace) {
    const json* events = &trace;
    if (trace.is_object()) {
      if (!trace.contains("traceEvents")) return fault("no traceEvents"), facts_;
      events = &trace["traceEvents"];
    }
    if (!events->is_array()) return fault("no array of events"), facts_;
    for (const json& event : *events) add(event);
    for (auto& [thread, begun] : open_) {
      for (const Slice& slice : begun) fault(fmt::format("{}: '{}' is begun and never ended", thread, slice.name));
    }
    for (auto& [thread, slices] : slices_) check_nesting(thread, slices);
    for (const auto& [id, flow] : flows_) {
      if (flow.begun == 0) fault(fmt::format("flow {} ends and has not begun", id));
      if (flow.ended == 0) fault(fmt::format("flow {} begins and does not end", id));
      if (flow.begun > 0 && flow.ended > 0 && flow.last < flow.first)
        fault(fmt::format("flow {} goes back in time", id));
    }
    return facts_;
  }

 private:
  void fault(std::string text) { facts_.faults.push_back(std::move(text)); }

  void add(const json& event) {
    if (!event.is_object() || !event.contains("ph") || !event["ph"].is_string()) return fault("an event without ph");
    const std::string phase = event["ph"];
    if (phase == "M") return add_metadata(event);
    if (!event.contains("ts") || !event["ts"].is_number()) return fault("no ts: " + event.dump());
    if (!event.contains("pid") || !event["pid"].is_number_integer()) return fault("no pid: " + event.dump());
    const std::string thread = fmt::format("{}/{}", text_of(event, "pid"), text_of(event, "tid"));
    const std::int64_t at = ps_of(event["ts"]);
    if (phase != "C") check_order(thread, at);
    if (phase == "X") return add_complete(event, thread, at);
    if (phase == "B") return open_[thread].push_back({at, at, text_of(event, "name")});
    if (phase == "E") return end_slice(thread, at);
    if (phase == "C") return add_counter(event, thread, at);
    if (phase == "i" || phase == "I") return add_mark(event);
    if (phase == "s" || phase == "t" || phase == "f") return add_flow(event, phase, at);
    if (phase == "b" || phase == "n" || phase == "e" || phase == "S" || phase == "T" || phase == "F" || phase == "p") {
      if (text_of(event, "id").empty()) fault("an asynchronous event without id");
      return;
    }
    fault("unknown ph '" + phase + "'");
  }

  void check_order(const std::string& thread, std::int64_t at) {
    const auto [last, is_first] = last_.try_emplace(thread, at);
    if (ordered_ && at < last->second) fault(fmt::format("{}: {} ps after {} ps", thread, at, last->second));
    last->second = std::max(last->second, at);
  }

  void add_metadata(const json& event) {
    ++facts_.metadata;
    if (text_of(event, "name").empty() || !event.contains("args")) fault("metadata without name or args");
  }

  void add_complete(const json& event, const std::string& thread, std::int64_t at) {
    ++facts_.slices;
    if (text_of(event, "name").empty()) fault("a slice without a name");
    if (!event.contains("dur") || !event["dur"].is_number()) return fault("X without dur: " + event.dump());
    const std::int64_t length = ps_of(event["dur"]);
    if (length < 0) return fault("X with a negative dur: " + event.dump());
    slices_[thread].push_back({at, at + length, text_of(event, "name")});
    if (event.contains("bind_id")) {  // flows of the second version
      const std::string id = text_of(event, "bind_id");
      if (event.value("flow_in", false)) note_flow(id, false, at);
      if (event.value("flow_out", false)) note_flow(id, true, at);
    }
  }

  void end_slice(const std::string& thread, std::int64_t at) {
    auto& begun = open_[thread];
    if (begun.empty()) return fault(fmt::format("{}: E at {} ps without a B", thread, at));
    if (at < begun.back().begin) fault(fmt::format("{}: '{}' ends before it begins", thread, begun.back().name));
    ++facts_.slices;
    slices_[thread].push_back({begun.back().begin, at, begun.back().name});
    begun.pop_back();
  }

  void add_counter(const json& event, const std::string& thread, std::int64_t at) {
    ++facts_.counters;
    check_order(thread + ' ' + text_of(event, "name") + text_of(event, "id"), at);
    const auto values = event.find("args");
    if (values == event.end() || values->empty()) return fault("a counter without values");
    for (const json& value : *values) {
      if (!value.is_number()) fault("a counter's value is no number: " + event.dump());
    }
  }

  void add_mark(const json& event) {
    ++facts_.marks;
    const std::string scope = text_of(event, "s");
    if (!scope.empty() && scope != "t" && scope != "p" && scope != "g") fault("a mark with the scope " + scope);
  }

  void add_flow(const json& event, const std::string& phase, std::int64_t at) {
    const std::string id = text_of(event, "id");
    if (id.empty()) return fault("a flow without id");
    if (phase != "t") note_flow(text_of(event, "cat") + text_of(event, "name") + id, phase == "s", at);
  }

  void note_flow(const std::string& id, bool begins, std::int64_t at) {
    Flow& flow = flows_[id];
    if (begins) {
      if (flow.begun++ == 0) flow.first = at, ++facts_.flows;
    } else {
      ++flow.ended;
      flow.last = std::max(flow.last, at);
    }
  }

  // Sorted by begin, the longer first: each lies within the one that is open, or after its end.
  void check_nesting(const std::string& thread, std::vector<Slice>& slices) {
    std::stable_sort(slices.begin(), slices.end(), [](const Slice& a, const Slice& b) {
      return a.begin != b.begin ? a.begin < b.begin : a.end > b.end;
    });
    std::vector<const Slice*> open;
    for (const Slice& slice : slices) {
      while (!open.empty() && open.back()->end <= slice.begin) open.pop_back();
      if (!open.empty() && slice.end > open.back()->end) {
        fault(fmt::format("{}: '{}' {}..{} and '{}' {}..{} ps do not nest", thread, open.back()->name,
                          open.back()->begin, open.back()->end, slice.name, slice.begin, slice.end));
      }
      open.push_back(&slice);
      facts_.deepest = std::max(facts_.deepest, static_cast<int>(open.size()));
    }
  }

  bool ordered_;
  TraceFacts facts_;
  std::map<std::string, std::vector<Slice>> slices_, open_;
  std::map<std::string, std::int64_t> last_;
  std::map<std::string, Flow> flows_;
};

}  // namespace

TraceFacts check_trace(const json& trace, bool ordered) { return Checker(ordered).check(trace); }

}  // namespace framesim
