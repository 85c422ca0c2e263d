// The decision of one frame by `certified`, as the simulator calls it, against the linear relaxation's own O(n)
// selection (sim/bound.h) and against the time that reading the same arrays takes. One core, flat lists of four levels.
#include <benchmark/benchmark.h>

#include <cmath>
#include <map>
#include <memory>
#include <string>

#include "experiments/bench/allocations.h"
#include "experiments/bench/input.h"
#include "policies/registry.h"
#include "sim/bound.h"

namespace framesim::bench {
namespace {

enum class Family { scene, mixed, tied, correlated };

// Level columns of `n` items. All coarsest levels are worth their cost, as with a benefit that grows with what is seen.
//   scene       diminishing returns, four levels each; mixed: two to six
//   tied        benefit in proportion to cost: every step has one slope
//   correlated  benefit = cost + constant
struct Frame {
  std::vector<ObjectType> types;
  Workload workload;
  double coarsest_s = 0, finest_s = 0, coarsest_benefit = 0;

  double budget_s() const { return coarsest_s + 0.3 * (finest_s - coarsest_s); }
};

void add_item(Frame& frame, Family family, SplitMix& random) {
  Workload& w = frame.workload;
  const int levels = family == Family::mixed ? 2 + static_cast<int>(random.bits() % 5) : 4;
  double cost_s = 1e-6 * (0.5 + random.uniform()), slope = 1e7 * (1 + random.uniform()), benefit = cost_s * slope;
  frame.coarsest_s += cost_s;
  slope *= 0.9 * random.uniform();
  for (int l = 0; l < levels; ++l) {
    if (family == Family::tied) benefit = 1e7 * cost_s;
    if (family == Family::correlated) benefit = 1e6 * cost_s + 1;
    if (l == 0) frame.coarsest_benefit += benefit;
    w.cost_s.push_back(cost_s);
    w.benefit.push_back(benefit);
    if (l + 1 == levels) break;
    const double step_s = cost_s * (0.5 + 2 * random.uniform());
    cost_s += step_s;
    benefit += step_s * slope;
    slope *= 0.1 + 0.8 * random.uniform();
  }
  frame.finest_s += cost_s;
  w.id.push_back(static_cast<InstanceId>(w.size()));
  w.level_begin.push_back(static_cast<std::uint32_t>(w.cost_s.size()));
}

// The same list, seen a little later: every benefit moves by up to `change`; `shift` rotates the order of items.
void move_view(Frame& frame, double change, std::uint64_t seed) {
  SplitMix random(seed);
  Workload& w = frame.workload;
  frame.coarsest_benefit = 0;
  for (std::size_t i = 0; i < w.size(); ++i) {
    const double factor = std::exp(change * (2 * random.uniform() - 1));
    for (std::uint32_t k = w.level_begin[i]; k < w.level_begin[i + 1]; ++k) w.benefit[k] *= factor;
    frame.coarsest_benefit += w.benefit[w.level_begin[i]];
  }
}

Frame make_frame(Family family, std::size_t n, std::uint64_t seed) {
  Frame frame;
  SplitMix random(seed);
  frame.workload.level_begin.push_back(0);
  for (std::size_t i = 0; i < n; ++i) add_item(frame, family, random);
  frame.types.push_back({.name = "object", .levels = {Facts{}}});
  frame.workload.types = frame.types;
  frame.workload.type.assign(n, TypeId{0});
  frame.workload.kind.assign(n, ItemKind::levels);
  frame.workload.projected_area_px.assign(n, 1);
  frame.workload.curve_setup_s.assign(n, 0);
  frame.workload.curve_knee.assign(n, 0);
  return frame;
}

// What the camera sees in turn. Made once for each benchmark.
enum class Change { none, motion, exchange, cut };

struct Case {
  Family family;
  std::size_t n;
  Change change;
  auto operator<=>(const Case&) const = default;
};

constexpr double kMotion = 0.01;  // of every benefit, from frame to frame
constexpr double kCut = 0.3;      // as a logarithm; all benefits are also worth seven times as much

const std::vector<Frame>& frames_of(const Case& wanted) {
  static std::map<Case, std::vector<Frame>> made;
  std::vector<Frame>& frames = made[wanted];
  if (!frames.empty()) return frames;
  frames.reserve(2);
  for (int view = 0; view < (wanted.change == Change::none ? 1 : 2); ++view) {
    // An exchange: the last hundredth of the items is another one.
    frames.push_back(make_frame(wanted.family, wanted.n, 1));
    Frame& frame = frames.back();
    frame.workload.types = frame.types;
    if (view == 0) continue;
    if (wanted.change == Change::motion) move_view(frame, kMotion, 2);
    if (wanted.change == Change::cut) {
      move_view(frame, kCut, 3);
      for (double& benefit : frame.workload.benefit) benefit *= 7;
      frame.coarsest_benefit *= 7;
    }
    if (wanted.change == Change::exchange) {
      Workload& w = frame.workload;
      SplitMix random(4);
      const Frame other = make_frame(wanted.family, wanted.n, 5);
      for (std::size_t i = w.size() / 200; i < w.size(); i += 100) {
        for (std::uint32_t k = w.level_begin[i]; k < w.level_begin[i + 1]; ++k) {
          w.cost_s[k] = other.workload.cost_s[k];
          w.benefit[k] = other.workload.benefit[k];
        }
      }
    }
  }
  return frames;
}

double ngap(const Frame& frame, const Selection& selection) {
  return (*selection.bound - selection.planned_benefit) / (*selection.bound - frame.coarsest_benefit);
}

// Decides frame after frame. `afresh` forgets the last one each time; `budgets` are taken in turn.
void decide(benchmark::State& state, const Case& wanted, bool afresh = false, double budget_step = 0) {
  const std::vector<Frame>& frames = frames_of(wanted);
  const std::unique_ptr<Policy> policy = find_entry("policy", policies(), {.name = "certified"}).make({});
  const PolicyScene scene{.types = frames[0].types, .complexity_s = {}, .instances = wanted.n};
  policy->prepare(scene);
  Selection selection;
  selection.reset(wanted.n);
  std::int64_t frame = 0, allocated = 0;
  const auto once = [&] {
    const Frame& seen = frames[static_cast<std::size_t>(frame) % frames.size()];
    const double budget_s = seen.budget_s() * (frame % 2 == 0 ? 1 : 1 + budget_step);
    if (afresh) policy->prepare(scene);
    selection.operations = 0;
    policy->select({.frame = frame++, .target_s = 1, .budget_s = budget_s, .workload = seen.workload}, selection);
    return ngap(seen, selection);
  };
  double worst = 0;
  for (int warm_up = 0; warm_up < 16; ++warm_up) worst = once();
  worst = 0;
  for (auto _ : state) {
    const std::int64_t before = allocations();
    worst = std::max(worst, once());
    allocated += allocations() - before;
  }
  state.SetItemsProcessed(state.iterations() * static_cast<std::int64_t>(wanted.n));
  state.counters["ngap"] = worst;
  state.counters["relative_gap"] = (*selection.bound - selection.planned_benefit) / *selection.bound;
  state.counters["passes"] = static_cast<double>(selection.operations) / static_cast<double>(wanted.n);
  state.counters["allocations"] = static_cast<double>(allocated);
}

std::size_t items(const benchmark::State& state) { return static_cast<std::size_t>(state.range(0)); }

void warm(benchmark::State& state) { decide(state, {Family::scene, items(state), Change::motion}); }
BENCHMARK(warm)->Name("decision/warm")->RangeMultiplier(10)->Range(1000, 1'000'000)->Unit(benchmark::kMicrosecond);

void cold(benchmark::State& state) { decide(state, {Family::scene, items(state), Change::motion}, true); }
BENCHMARK(cold)->Name("decision/cold")->RangeMultiplier(10)->Range(1000, 1'000'000)->Unit(benchmark::kMicrosecond);

void mixed(benchmark::State& state) { decide(state, {Family::mixed, items(state), Change::motion}); }
BENCHMARK(mixed)->Name("decision/mixed-levels")->Arg(1000)->Arg(1'000'000)->Unit(benchmark::kMicrosecond);

void exchange(benchmark::State& state) { decide(state, {Family::scene, items(state), Change::exchange}); }
BENCHMARK(exchange)->Name("decision/exchange")->Arg(1'000'000)->Unit(benchmark::kMicrosecond);

void cut(benchmark::State& state) { decide(state, {Family::scene, items(state), Change::cut}); }
BENCHMARK(cut)->Name("decision/cut")->Arg(1'000'000)->Unit(benchmark::kMicrosecond);

void budget_step(benchmark::State& state) { decide(state, {Family::scene, items(state), Change::none}, false, 0.3); }
BENCHMARK(budget_step)->Name("decision/budget-step")->Arg(1'000'000)->Unit(benchmark::kMicrosecond);

void tied(benchmark::State& state) { decide(state, {Family::tied, items(state), Change::none}); }
BENCHMARK(tied)->Name("decision/tied")->Arg(100'000)->Unit(benchmark::kMicrosecond);

void correlated(benchmark::State& state) { decide(state, {Family::correlated, items(state), Change::none}); }
BENCHMARK(correlated)->Name("decision/correlated")->Arg(100'000)->Unit(benchmark::kMicrosecond);

// The yardstick's bound: upper hulls and a weighted selection on their slopes.
void select_bound(benchmark::State& state, Family family) {
  const Frame& frame = frames_of({family, items(state), Change::none}).front();
  BenefitBound bound;
  for (auto _ : state) benchmark::DoNotOptimize(bound.compute(frame.workload, frame.budget_s()));
  state.SetItemsProcessed(state.iterations() * state.range(0));
}
void selection_scene(benchmark::State& state) { select_bound(state, Family::scene); }
BENCHMARK(selection_scene)->Name("decision/selection")->Arg(1'000'000)->Unit(benchmark::kMicrosecond);
void selection_tied(benchmark::State& state) { select_bound(state, Family::tied); }
BENCHMARK(selection_tied)->Name("decision/selection-tied")->Arg(100'000)->Unit(benchmark::kMicrosecond);
void selection_correlated(benchmark::State& state) { select_bound(state, Family::correlated); }
BENCHMARK(selection_correlated)->Name("decision/selection-correlated")->Arg(100'000)->Unit(benchmark::kMicrosecond);

// Reads costs, benefits and the runs' begins once, in eight independent sums.
void stream(benchmark::State& state) {
  const Workload& w = frames_of({Family::scene, items(state), Change::none}).front().workload;
  for (auto _ : state) {
    double sum[8] = {};
    for (std::size_t k = 0; k + 8 <= w.cost_s.size(); k += 8) {
      for (std::size_t lane = 0; lane < 8; ++lane) sum[lane] += w.cost_s[k + lane] + w.benefit[k + lane];
    }
    std::uint64_t begins = 0;
    for (const std::uint32_t begin : w.level_begin) begins += begin;
    benchmark::DoNotOptimize(sum);
    benchmark::DoNotOptimize(begins);
  }
  state.SetItemsProcessed(state.iterations() * state.range(0));
}
BENCHMARK(stream)->Name("decision/stream")->Arg(1'000'000)->Unit(benchmark::kMicrosecond);

}  // namespace
}  // namespace framesim::bench
