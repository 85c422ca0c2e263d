// run --trace: the format, by a checker that is itself tried on the fixtures of trace viewers and on broken traces;
// and what is in it, against the frame records.
#include <fmt/format.h>

#include <cmath>
#include <map>
#include <set>

#include "experiments/csv_row.h"
#include "tests/experiments/program.h"
#include "tests/experiments/shared_data.h"
#include "tests/experiments/trace_checker.h"

using namespace framesim;
using nlohmann::json;

namespace {

const std::vector<std::string> kNoFault;

json traced(const TestFolder& folder, std::vector<std::string> words) {
  words.insert(words.begin(), "run");
  const std::string path = folder.path("trace.json");
  words.insert(words.end(), {"--trace", path, "--quiet"});
  const ProgramRun run = run_program(words);
  CAPTURE(words, run.err);
  REQUIRE(run.exit_code == 0);
  return json::parse(folder.read("trace.json"));
}

std::int64_t ps(const json& us) { return std::llround(us.get<double>() * 1e6); }

// Events of one phase on one track.
std::vector<json> events_of(const json& trace, int tid, const std::string& phase, const std::string& name = "") {
  std::vector<json> found;
  for (const json& e : trace["traceEvents"]) {
    if (e["tid"] == tid && e["ph"] == phase && (name.empty() || e["name"] == name)) found.push_back(e);
  }
  return found;
}

std::vector<json> events_named(const json& trace, int tid, const std::string& beginning) {
  std::vector<json> found;
  for (const json& e : events_of(trace, tid, "X")) {
    if (e["name"].get<std::string>().starts_with(beginning)) found.push_back(e);
  }
  return found;
}

std::vector<std::string> faults_of(const std::string& text) { return check_trace(json::parse(text), true).faults; }

}  // namespace

TEST_CASE("the trace checker accepts a well-formed trace and names each fault of a broken one") {
  const std::string good =
      R"([{"ph":"X","pid":1,"tid":1,"ts":1,"dur":9,"name":"a"},{"ph":"X","pid":1,"tid":1,"ts":2,"dur":8,"name":"b"},
    {"ph":"s","pid":1,"tid":1,"ts":2,"name":"f","cat":"c","id":1},{"ph":"f","pid":1,"tid":2,"ts":3,"name":"f","cat":"c","id":1},
    {"ph":"C","pid":1,"tid":1,"ts":0,"name":"n","args":{"v":1}},{"ph":"M","pid":1,"tid":1,"name":"thread_name","args":{"name":"x"}}])";
  const TraceFacts facts = check_trace(json::parse(good), true);
  CHECK(facts.faults == kNoFault);
  CHECK(facts.deepest == 2);
  const auto one_fault = [](const std::string& events, const std::string& part) {
    const auto faults = faults_of("[" + events + "]");
    CAPTURE(events, part, faults);
    REQUIRE(faults.size() == 1);
    CHECK(faults[0].find(part) != std::string::npos);
  };
  one_fault(R"({"ph":"X","pid":1,"tid":1,"ts":1,"name":"a"})", "without dur");
  one_fault(R"({"ph":"X","pid":1,"tid":1,"ts":1,"dur":-1,"name":"a"})", "negative dur");
  one_fault(
      R"({"ph":"X","pid":1,"tid":1,"ts":1,"dur":5,"name":"a"},{"ph":"X","pid":1,"tid":1,"ts":2,"dur":5,"name":"b"})",
      "do not nest");
  one_fault(R"({"ph":"B","pid":1,"tid":1,"ts":1,"name":"a"})", "never ended");
  one_fault(R"({"ph":"E","pid":1,"tid":1,"ts":1})", "without a B");
  one_fault(
      R"({"ph":"X","pid":1,"tid":1,"ts":2,"dur":1,"name":"a"},{"ph":"X","pid":1,"tid":1,"ts":1,"dur":1,"name":"b"})",
      "after");
  one_fault(R"({"ph":"s","pid":1,"tid":1,"ts":2,"name":"f","id":1})", "does not end");
  one_fault(R"({"ph":"f","pid":1,"tid":1,"ts":2,"name":"f","id":1})", "has not begun");
  one_fault(
      R"({"ph":"s","pid":1,"tid":1,"ts":2,"name":"f","id":1},{"ph":"f","pid":1,"tid":2,"ts":1,"name":"f","id":1})",
      "back in time");
  one_fault(R"({"ph":"C","pid":1,"tid":1,"ts":2,"name":"n","args":{"v":"1"}})", "no number");
  one_fault(R"({"ph":"i","pid":1,"tid":1,"ts":2,"name":"n","s":"x"})", "scope");
  one_fault(R"({"ph":"X","pid":1,"tid":1,"dur":2,"name":"n"})", "no ts");
  one_fault(R"({"ph":"?","pid":1,"tid":1,"ts":2})", "unknown ph");
  CHECK_FALSE(faults_of(R"({"events":[]})").empty());
}

TEST_CASE("the trace checker on the fixtures of trace viewers: what they hold, and their known oddities") {
  const auto folder = shared_data("traces");
  if (!folder) return;
  const auto read = [&](const std::string& name) {
    std::ifstream in(*folder + "/" + name);
    return check_trace(json::parse(in), false);
  };
  const TraceFacts trivial = read("catapult/trivial_trace.json");
  CHECK(trivial.faults == kNoFault);
  CHECK(trivial.slices == 2);
  const TraceFacts counters = read("catapult/instance_counters.json");
  CHECK(counters.faults == kNoFault);
  CHECK(counters.counters == 8);
  const TraceFacts marks = read("catapult/instant_events.json");
  CHECK(marks.faults == kNoFault);
  CHECK(marks.marks > 2);
  CHECK(read("catapult/nestable_async.json").faults == kNoFault);
  for (const char* name : {"catapult/flow_simple.json", "perfetto/flow_events_json_v1.json"}) {
    CAPTURE(name);
    const TraceFacts flows = read(name);
    CHECK(flows.faults == kNoFault);
    CHECK(flows.flows == 2);
  }
}

TEST_CASE("a trace of each engine and of every effect with hardware of its own is well formed") {
  const TestFolder folder;
  const std::vector<std::vector<std::string>> runs = {
      {"street", "--policy", "robin-hood", "--frames", "12"},
      {"street", "--policy", "funkhouser", "--overlap", "staged:3", "--effect", "fifo:primitive=1,pixel=1", "--frames",
       "12"},
      {"street", "--policy", "full-detail", "--fidelity", "events", "--effect", "jitter", "--frames", "12"},
      {"street", "--policy", "full-detail", "--overlap", "paper2005", "--frames", "12"},
      {"street:vsync=60Hz", "--policy", "feedback", "--frames", "12", "--effect", "preemption"},
      {"graphicon-forest", "--policy", "full-detail", "--frames", "4", "--effect", "preemption", "--overlap",
       "staged:2"},
      {"dong-forest", "--policy", "static", "--frames", "3", "--effect", "streaming:memory=8", "--overlap", "staged:2",
       "--effect", "preemption:at=command"},
  };
  for (std::size_t i = 0; i < runs.size(); ++i) {
    CAPTURE(i);
    const json trace = traced(folder, runs[i]);
    const TraceFacts facts = check_trace(trace, true);
    CHECK(facts.faults == kNoFault);
    CHECK(facts.counters >= 3 * 3);
    std::set<std::string> names;
    for (const json& e : trace["traceEvents"]) {
      if (e["ph"] == "M") names.insert(e["args"].contains("name") ? e["args"]["name"].get<std::string>() : "");
    }
    for (const char* track : {"CPU", "GPU per-primitive stage", "GPU per-pixel stage", "bus", "display"}) {
      CHECK(names.count(track) == 1);
    }
    const bool closed = trace["otherData"]["engine"] == "closed-form";
    CHECK((facts.flows == 0) == closed);
    CHECK(events_of(trace, 1, "s").size() == events_of(trace, 2, "f").size());
    CHECK(names.count("GPU's other client") == static_cast<std::size_t>(i >= 4));
    CHECK(events_of(trace, 4, "X").empty() == (i < 6));
  }
}

TEST_CASE("a trace says what the frame records say") {
  const TestFolder folder;
  const std::string frames = folder.path("frames.csv");
  const json trace = traced(folder, {"street:vsync=60Hz", "--policy", "funkhouser", "--overlap", "staged:2", "--target",
                                     "16ms", "--frames", "15", "--frames-out", frames});
  std::istringstream lines(folder.read("frames.csv"));
  std::string line;
  std::getline(lines, line);
  const std::vector<std::string> names = split_csv_row(line);
  std::vector<std::map<std::string, double>> records;
  while (std::getline(lines, line)) {
    const std::vector<std::string> cells = split_csv_row(line);
    auto& row = records.emplace_back();
    for (std::size_t i = 0; i < cells.size(); ++i) row[names[i]] = std::strtod(cells[i].c_str(), nullptr);
  }
  REQUIRE(records.size() == 15);
  const auto cpu = events_named(trace, 1, "frame "), pixel = events_named(trace, 3, "frame "),
             display = events_named(trace, 5, "frame ");
  REQUIRE(cpu.size() == 15);
  REQUIRE(pixel.size() == 15);
  REQUIRE(display.size() == 14);
  const auto deadlines = events_of(trace, 5, "i", "deadline");
  REQUIRE(deadlines.size() == 15);
  const auto frame_time = events_of(trace, 0, "C", "frame time");
  REQUIRE(frame_time.size() == 15);
  std::map<int, json> deadline_of;
  for (const json& e : deadlines) deadline_of[e["args"]["frame"].get<int>()] = e;
  for (std::size_t k = 0; k < 15; ++k) {
    CAPTURE(k);
    auto& r = records[k];
    CHECK(ps(cpu[k]["ts"]) == r["cpu_start_ps"]);
    CHECK(ps(cpu[k]["ts"]) + ps(cpu[k]["dur"]) == r["submitted_ps"]);
    CHECK(ps(pixel[k]["ts"]) + ps(pixel[k]["dur"]) == r["drawn_ps"]);
    if (k < 14) CHECK(ps(display[k]["ts"]) == r["shown_ps"]);
    CHECK(frame_time[k]["args"]["ms"].get<double>() == Approx(r["frame_time_ps"] * 1e-9));
    // The deadline of a frame: 16 ms after the one before was shown.
    const json& deadline = deadline_of[static_cast<int>(k)];
    const double before = k > 0 ? records[k - 1]["shown_ps"] : r["cpu_start_ps"];
    CHECK(ps(deadline["ts"]) == before + 16e9);
    CHECK(deadline["args"]["missed"] == (r["shown_ps"] > before + 16e9));
  }
  // Blanks: each multiple of the period up to the last frame shown, once; frames appear at blanks only.
  const auto blanks = events_of(trace, 5, "i", "vertical blank");
  std::set<std::int64_t> at;
  for (const json& e : blanks) at.insert(ps(e["ts"]));
  CHECK(at.size() == blanks.size());
  for (const json& e : display) CHECK(at.count(ps(e["ts"])) == 1);
  CHECK(*at.rbegin() == static_cast<std::int64_t>(records.back()["shown_ps"]));
  // Queue depth: never negative, empty at the end.
  const auto queue = events_of(trace, 0, "C", "queue depth");
  REQUIRE_FALSE(queue.empty());
  for (const json& e : queue) CHECK(e["args"]["primitive"].get<int>() >= 0);
  for (const json& e : queue) CHECK(e["args"]["pixel"].get<int>() >= 0);
  CHECK(queue.back()["args"]["primitive"] == 0);
  CHECK(queue.back()["args"]["pixel"] == 0);
}

TEST_CASE("watching a run changes none of its results") {
  const TestFolder folder;
  const auto frames = [&](bool watched) {
    std::vector<std::string> words = {"run",     "auditorium",   "--policy",          "feedback", "--effect",
                                      "jitter",  "--overlap",    "staged:2",          "--frames", "20",
                                      "--quiet", "--frames-out", folder.path("f.csv")};
    if (watched) words.insert(words.end(), {"--trace", folder.path("t.json")});
    CHECK(run_program(words).exit_code == 0);
    return folder.read("f.csv");
  };
  CHECK(frames(false) == frames(true));
  const ProgramRun refused =
      run_program({"run", "street", "--policy", "static", "--seeds", "2", "--trace", folder.path("t")});
  CHECK(refused.exit_code == 2);
  CHECK(refused.err.find("--trace") != std::string::npos);
}
