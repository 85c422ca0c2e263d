// Many seeds at once against as many runs.
#include "experiments/seeds.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <cstring>
#include <limits>
#include <map>
#include <string>
#include <vector>

#include "experiments/csv_row.h"
#include "experiments/run_parts.h"
#include "policies/registry.h"
#include "scenes/registry.h"
#include "sim/replications.h"
#include "tests/catch.h"

using namespace framesim;

namespace {

constexpr std::int64_t kFrames = 8;
constexpr std::int64_t kSeeds = 11;  // a whole group of eight, and three lanes of the next

RunSpec spec_of(const std::string& scene, const std::string& policy, const std::vector<std::string>& effects) {
  RunSpec spec;
  spec.scene = parse_spec(scene);
  spec.policy = parse_spec(policy);
  for (const std::string& effect : effects) spec.effects.push_back(parse_spec(effect));
  spec.frames = kFrames;
  spec.seed = 5;
  spec.target_s = 0.016;
  return spec;
}

// Bit for bit, NaN included: a record has 8-byte columns only.
bool same_records(std::span<const FrameRecord> a, std::span<const FrameRecord> b) {
  return a.size() == b.size() && std::memcmp(a.data(), b.data(), a.size_bytes()) == 0;
}

// Each seed's records are those of a run of its own. Returns what run_seeds says of the way.
SeedRuns check_seeds(const RunSpec& spec, std::int64_t count = kSeeds) {
  const Scene scene = load_scene(spec.scene);
  std::vector<std::vector<FrameRecord>> records;
  std::vector<std::uint64_t> seeds;
  std::int64_t frames = 0;
  const SeedRuns runs = run_seeds(
      spec, scene, count, [&] { ++frames; },
      [&](std::uint64_t seed, std::span<const FrameRecord> of_seed) {
        seeds.push_back(seed);
        records.emplace_back(of_seed.begin(), of_seed.end());
      });
  REQUIRE(records.size() == static_cast<std::size_t>(count));
  REQUIRE(runs.summaries.size() == records.size());
  CHECK(frames == count * frames_to_run(spec, scene));
  for (std::size_t s = 0; s < records.size(); ++s) {
    RunSpec alone = spec;
    alone.seed = spec.seed + s;
    CAPTURE(alone.seed);
    const RunResult expected = run(alone, scene);
    REQUIRE(seeds[s] == alone.seed);
    REQUIRE(same_records(records[s], expected.records));
    REQUIRE(runs.hashes[s] == expected.records_hash);
    REQUIRE(std::memcmp(&runs.summaries[s], &expected.summary, sizeof(Summary)) == 0);
  }
  return runs;
}

const std::vector<std::string> kTimes = {"jitter:sigma=0.2", "vsync:rate=60Hz", "frames-in-flight:n=2"};

}  // namespace

TEST_CASE("seeds at once are the runs of each seed, for every policy") {
  for (const PolicyEntry& entry : policies()) {
    CAPTURE(entry.name);
    const SeedRuns runs = check_seeds(spec_of("street", std::string(entry.name), kTimes));
    const bool feedback = entry.make({})->traits().uses_feedback;
    CHECK(runs.obstacle.has_value() == feedback);
    CHECK(runs.side_by_side == !feedback);
    CHECK(std::any_of(runs.hashes.begin(), runs.hashes.end(), [&](auto hash) { return hash != runs.hashes[0]; }));
  }
}

TEST_CASE("seeds at once are the runs of each seed, for each estimator") {
  for (const EstimatorEntry& entry : estimators()) {
    CAPTURE(entry.name);
    RunSpec spec = spec_of("street", "robin-hood", kTimes);
    spec.estimator = parse_spec(std::string(entry.name));
    CHECK(check_seeds(spec).obstacle.has_value() == entry.make({})->learns());
  }
}

TEST_CASE("seeds at once are the runs of each seed, with all effects that allow it together") {
  const std::vector<std::string> all = {
      "jitter:sigma=0.3",         "logic-spikes:pattern=poisson,first=0,rate=0.7,duration=2ms",
      "vsync:rate=90Hz",          "frames-in-flight:n=3",
      "fifo:primitive=3,pixel=2", "submission:command=20us",
      "semantics:weight=0.5",     "focus:weight=0.5",
      "motion-blur:weight=0.5",   "hysteresis:weight=0.5",
      "cross-fade:frames=2",      "late-timings:frames=2"};
  for (const char* scene : {"street", "graphicon-forest", "auditorium"}) {
    CAPTURE(scene);
    RunSpec spec = spec_of(scene, "funkhouser", all);
    spec.bound = spec.verify = true;
    const SeedRuns runs = check_seeds(spec);
    CHECK(runs.obstacle.value_or("") == "");
    CHECK(runs.side_by_side);
  }
}

// 64 share their frames at a time.
TEST_CASE("more seeds than share their frames at a time are still each its run") {
  RunSpec spec = spec_of("street", "distance", {"jitter"});
  spec.frames = 2;
  CHECK_FALSE(check_seeds(spec, 67).obstacle);
}

TEST_CASE("one seed is its run, and so are seeds that nothing tells apart") {
  CHECK_FALSE(check_seeds(spec_of("street", "distance", {"jitter"}), 1).obstacle);
  const SeedRuns same = check_seeds(spec_of("street", "distance", {}), 9);
  CHECK(std::all_of(same.hashes.begin(), same.hashes.end(), [&](auto hash) { return hash == same.hashes[0]; }));
}

TEST_CASE("seeds share their frames with the other engines too, one after the other") {
  for (const char* overlap : {"serial", "max-plus-s:0.2"}) {
    CAPTURE(overlap);
    RunSpec spec = spec_of("street", "robin-hood", {"jitter", "vsync:rate=60Hz"});
    spec.overlap = parse_overlap(overlap);
    const SeedRuns runs = check_seeds(spec);
    CHECK_FALSE(runs.obstacle);
    CHECK_FALSE(runs.side_by_side);
  }
  RunSpec events = spec_of("street", "robin-hood", kTimes);
  events.engine.kind = EngineKind::events;
  CHECK_FALSE(check_seeds(events, 3).obstacle);
  RunSpec traced = spec_of("street", "robin-hood", kTimes);
  traced.engine.critical_path = true;
  const SeedRuns runs = check_seeds(traced, 9);
  CHECK_FALSE(runs.obstacle);
  CHECK_FALSE(runs.side_by_side);
}

TEST_CASE("seeds run each on its own where the frame's times flow back") {
  const std::map<std::string, std::string> obstacles = {
      {"thermal:heat=1000,tau=1s,limit=0,slope=0.01", "state"},
      {"streaming:preload=no,memory=0.05,bandwidth=0.2,chunk=4", "uploads"},
      {"preemption:arrivals=poisson,period=3ms,duration=700us", "client"}};
  for (const auto& [effect, word] : obstacles) {
    CAPTURE(effect);
    const SeedRuns runs = check_seeds(spec_of("street", "robin-hood", {effect, "jitter"}), 3);
    REQUIRE(runs.obstacle);
    CHECK(runs.obstacle->find(word) != std::string::npos);
  }
}

// SeedUse::none: a run with this effect is the same for any seed. A new effect that is not named here runs with its
// defaults.
TEST_CASE("an effect that says it does not use its seed gives the same run for another") {
  const std::map<std::string, std::string> lively = {{"frames-in-flight", "frames-in-flight:n=3"},
                                                     {"fifo", "fifo:primitive=2,pixel=1"},
                                                     {"submission", "submission:command=55us"},
                                                     {"logic-times", "logic-times:times=3:9"},
                                                     {"logic-spikes", "logic-spikes:every=2,first=1,duration=2ms"},
                                                     {"cross-fade", "cross-fade:frames=2"},
                                                     {"vsync", "vsync:rate=60Hz"},
                                                     {"thermal", "thermal:heat=1000,tau=1s,limit=0,slope=0.01"}};
  const Scene scene = load_scene(parse_spec("street"));
  int seedless = 0;
  for (const EffectEntry& entry : effects()) {
    const auto named = lively.find(std::string(entry.name));
    const std::string text = named == lively.end() ? std::string(entry.name) : named->second;
    if (entry.make(parse_spec(text).settings, 1)->seed_use() != SeedUse::none) continue;
    ++seedless;
    CAPTURE(text);
    RunSpec spec = spec_of("street", "feedback", {text});
    spec.frames = 40;
    const std::uint64_t first = run(spec, scene).records_hash;
    for (const std::uint64_t seed : {6u, 77u}) {
      spec.seed = seed;
      CHECK(run(spec, scene).records_hash == first);
    }
  }
  CHECK(seedless >= 10);
}

TEST_CASE("the spread over seeds is the mean, deviation and Student's interval of the runs") {
  const RunSpec spec = spec_of("street", "distance", kTimes);
  const SeedRuns runs = run_seeds(spec, load_scene(spec.scene), 4);
  double mean = 0, squares = 0;
  for (const Summary& s : runs.summaries) mean += 1e3 * s.latency_s / 4;
  for (const Summary& s : runs.summaries) squares += std::pow(1e3 * s.latency_s - mean, 2);
  const double deviation = std::sqrt(squares / 3), half = 3.182446 * deviation / 2;  // t of 3 degrees, sqrt(4)
  const std::string table = format_seeds(runs);
  const std::string line = table.substr(table.find("latency, ms"));
  CAPTURE(table);
  double shown[4] = {}, low = 0, high = 0;
  REQUIRE(std::sscanf(line.c_str(), "latency, ms %lf %lf %lf %lf %lf .. %lf", &shown[0], &shown[1], &shown[2],
                      &shown[3], &low, &high) == 6);
  CHECK(shown[0] == Approx(mean).epsilon(1e-5));
  CHECK(shown[1] == Approx(deviation).epsilon(1e-3));
  CHECK(shown[2] <= shown[0]);
  CHECK(shown[3] >= shown[0]);
  CHECK(low == Approx(mean - half).epsilon(1e-5));
  CHECK(high == Approx(mean + half).epsilon(1e-5));
}

TEST_CASE("one seed has no spread") {
  const RunSpec spec = spec_of("street", "distance", kTimes);
  const std::string table = format_seeds(run_seeds(spec, load_scene(spec.scene), 1));
  CHECK(table.find(" NA ") != std::string::npos);
  CHECK(table.find("nan") == std::string::npos);
}

TEST_CASE("the seeds' file has a row for each seed, with its hash") {
  const RunSpec spec = spec_of("street", "distance", kTimes);
  const SeedRuns runs = run_seeds(spec, load_scene(spec.scene), 3);
  const std::string csv = seeds_csv(runs);
  std::vector<std::vector<std::string>> rows;
  for (std::size_t at = 0; at < csv.size();) {
    const std::size_t end = csv.find('\n', at);
    std::string line = csv.substr(at, end - at);
    if (!line.empty() && line.back() == '\r') line.pop_back();
    rows.push_back(split_csv_row(line));
    at = end + 1;
  }
  REQUIRE(rows.size() == 4);
  CHECK(rows[0].front() == "seed");
  CHECK(rows[0].back() == "hash");
  for (std::size_t s = 0; s < 3; ++s) {
    CHECK(rows[s + 1].size() == rows[0].size());
    CHECK(rows[s + 1].front() == std::to_string(5 + s));
    CHECK(rows[s + 1].back() == fmt::format("{:016x}", runs.hashes[s]));
  }
}
