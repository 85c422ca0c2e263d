// What must not change a selection, checked over the whole registry on random lists: other units of time and of benefit,
// another order of the instances, objects that are not seen. kBreaks lists who breaks what, and why; the test also fails
// where one of them no longer does.
#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <numeric>
#include <string>
#include <vector>

#include "sim/closed_form.h"
#include "tests/catch.h"
#include "tests/policies/make_policy.h"
#include "tests/seeds.h"
#include "tests/sim/random_pipeline.h"

using namespace framesim;
using namespace framesim::testing;

namespace {

// Resolutions under scaling by 4^k: all rounding scales too, so every bit is the same. By 2 * 4^k searches that halve a
// bracket at its geometric mean, sqrt(a) * sqrt(b), round otherwise, and end elsewhere within their tolerance.
constexpr double kBits = 0;
constexpr double kSearch = 1e-6;
// Resolutions where sums are added up in another order. Searches end at a budget spent to 1e-9, and a small resolution
// moves by more than its share of that.
constexpr double kSummation = 1e-6;

struct Item {
  std::vector<TestLevel> levels;
  bool curve = false;
  TestView view;
};
using Items = std::vector<Item>;

Items random_items(std::uint64_t seed, bool curves) {
  TestRandom random(seed);
  Items items(static_cast<std::size_t>(random.whole(2, 24)));
  for (Item& item : items) {
    item.levels = random_levels(random, {.concave = seed % 2 == 0});
    item.view = random_view(random, {});
    item.curve = curves && random.chance(0.4);
  }
  return items;
}

struct Change {
  double costs = 1, benefits = 1;
  std::uint32_t id_step = 1;  // ids between which the objects are that are not seen
};

TestWorkload build(const Items& items, const Change& change = {}) {
  TestWorkload w;
  for (const Item& item : items) {
    std::vector<TestLevel> levels = item.levels;
    for (TestLevel& level : levels) {
      level.cost_s *= change.costs;
      level.benefit *= change.benefits;
    }
    if (item.curve) {
      w.add_curve(levels.back().cost_s, levels.back().benefit, item.view);
    } else {
      w.add_item(levels, item.view);
    }
  }
  for (std::size_t i = 0; i < w.workload.size(); ++i) {
    w.workload.id[i] = static_cast<InstanceId>(change.id_step * static_cast<std::uint32_t>(i));
  }
  w.finish();
  return w;
}

// Six frames of changing budgets, each told what it took.
std::vector<Selection> run(const std::string& spec, const TestWorkload& w, std::size_t instances) {
  const auto policy = make_policy(spec);
  PolicyScene scene = w.scene();
  scene.instances = instances;
  policy->prepare(scene);
  // Of what the list costs in order of nothing: the sum must not depend on the order of the items.
  std::vector<double> finest;
  for (std::size_t i = 0; i < w.workload.size(); ++i) finest.push_back(w.workload.cost_s[w.workload.finest(i)]);
  std::sort(finest.begin(), finest.end());
  const double whole_s = std::accumulate(finest.begin(), finest.end(), 0.0);
  std::vector<Selection> frames;
  for (const double share : {0.5, 0.13, 0.9, 0.31, 0.31, 0.7}) {
    const auto frame = static_cast<std::int64_t>(frames.size());
    const double budget_s = share * whole_s;
    frames.push_back(w.select(*policy, budget_s, frame));
    tell(*policy, w, frames.back(), budget_s * (1.3 - share), budget_s, frame);
  }
  return frames;
}

// Whether item i of one is drawn as item order[i] of the other, in every frame. Resolutions may differ by `tolerance`.
bool same(const std::vector<Selection>& a, const std::vector<Selection>& b, const std::vector<std::size_t>& order,
          double tolerance) {
  for (std::size_t f = 0; f < a.size(); ++f) {
    for (std::size_t i = 0; i < order.size(); ++i) {
      if (a[f].level[i] != b[f].level[order[i]]) return false;
      if (std::fabs(a[f].resolution[i] - b[f].resolution[order[i]]) > tolerance * a[f].resolution[i]) return false;
    }
  }
  return true;
}

enum class Property { costs, benefits, order, unseen };
constexpr std::string_view kPropertyNames[] = {"all costs and the budget times a power of two",
                                               "all benefits times a power of two", "the instances in another order",
                                               "objects that are not seen"};

bool holds(const std::string& spec, Property property, std::uint64_t seed) {
  const Items items = random_items(seed, make_policy(spec)->traits().request.curves);
  std::vector<std::size_t> order(items.size());
  std::iota(order.begin(), order.end(), std::size_t{0});
  const TestWorkload plain = build(items);
  const std::vector<Selection> before = run(spec, plain, items.size());
  for (const auto& [factor, tolerance] :
       {std::pair{0x1p-20, kBits}, {0.25, kBits}, {0x1p10, kBits}, {0.5, kSearch}, {0x1p9, kSearch}}) {
    if (property == Property::costs) {
      if (!same(before, run(spec, build(items, {.costs = factor}), items.size()), order, tolerance)) return false;
    } else if (property == Property::benefits) {
      if (!same(before, run(spec, build(items, {.benefits = factor}), items.size()), order, tolerance)) return false;
    }
  }
  if (property == Property::unseen) {
    return same(before, run(spec, build(items, {.id_step = 3}), 3 * items.size() + 7), order, kBits);
  }
  if (property == Property::order) {
    TestRandom random(seed + 1'000'000);
    for (std::size_t i = order.size(); i > 1; --i) {
      std::swap(order[i - 1], order[static_cast<std::size_t>(random.whole(0, static_cast<int>(i) - 1))]);
    }
    Items moved(items.size());
    for (std::size_t i = 0; i < items.size(); ++i) moved[order[i]] = items[i];
    return same(before, run(spec, build(moved), items.size()), order, kSummation);
  }
  return true;
}

struct Break {
  std::string policy;
  Property property;
  std::string reason;
};
const std::vector<Break> kBreaks = {
    {"lagrange:rest=carry", Property::order,
     "what a level leaves goes to the next item of the list: its documented rule"},
};

bool is_listed(const std::string& policy, Property property) {
  return std::any_of(kBreaks.begin(), kBreaks.end(),
                     [&](const Break& b) { return b.policy == policy && b.property == property; });
}

std::vector<std::string> checked_policies() {
  std::vector<std::string> names;
  for (const PolicyEntry& entry : policies()) names.emplace_back(entry.name);
  for (const char* variant : {"funkhouser:rule=incremental", "funkhouser:rule=printed", "robin-hood:sums=printed",
                              "robin-hood:levels=false", "lagrange:rest=carry", "mixed-gradient:direction=multiplier",
                              "hierarchical:rule=printed", "contribution-halving:start=last", "certified:none=true"}) {
    names.emplace_back(variant);
  }
  return names;
}

}  // namespace

// Sums of whole picoseconds do not know their order.
TEST_CASE("metamorphic: instances in another order change no closed-form frame time") {
  for (const Overlap overlap : {Overlap{.kind = OverlapKind::serial}, Overlap{.kind = OverlapKind::paper2005},
                                Overlap{.kind = OverlapKind::max_plus, .serial_share = 0.3}, Overlap{}}) {
    for (std::uint64_t seed = 1; seed <= 50; ++seed) {
      CAPTURE(seed);
      test::SplitMix random(seed);
      std::vector<std::array<std::int64_t, 3>> commands(40);
      for (auto& command : commands)
        command = {random.between(0, 999), random.between(0, 1'000'000'000), random.between(0, 99)};
      const auto shown = [&] {
        MachineProfile machine;
        machine.overlap = overlap;
        const test::PipelineFrame frame = test::make_frame(5'000'000, 1'000'000, commands);
        return ClosedForm(machine).run(frame.work()).shown.count();
      };
      const std::int64_t before = shown();
      for (std::size_t i = commands.size(); i > 1; --i) {
        std::swap(commands[i - 1],
                  commands[static_cast<std::size_t>(random.between(0, static_cast<std::int64_t>(i) - 1))]);
      }
      CHECK(shown() == before);
    }
  }
}

TEST_CASE("metamorphic: what must not change a selection changes none, but where the table says why") {
  for (const std::string& policy : checked_policies()) {
    for (const Property property : {Property::costs, Property::benefits, Property::order, Property::unseen}) {
      const std::string_view name = kPropertyNames[static_cast<std::size_t>(property)];
      CAPTURE(policy, name);
      std::vector<std::uint64_t> broken;
      for (std::uint64_t seed = 1; seed <= seeds(20); ++seed) {
        if (!holds(policy, property, seed)) broken.push_back(seed);
      }
      CAPTURE(broken);
      CHECK(broken.empty() != is_listed(policy, property));
    }
  }
}

// "omit=true" is the knapsack itself. By default an item may be left out only where not even the cheapest levels fit, so
// there the benefit may fall where the budget reaches them; from there on it may not.
TEST_CASE("metamorphic: a larger budget never lowers the exact benefit") {
  for (std::uint64_t seed = 1; seed <= seeds(60); ++seed) {
    const TestWorkload w = build(random_items(seed, false));
    const double high_s = w.finest_cost_s() * (1 + 1e-9);  // the sum is rounded
    const double whole = w.select(*make_policy("full-detail", w), high_s).planned_benefit;
    for (const std::string spec : {"exact", "exact:omit=true"}) {
      CAPTURE(seed, spec);
      const auto policy = make_policy(spec, w);
      const double low_s = spec == "exact" ? w.coarsest_cost_s() * (1 + 1e-9) : 0;
      double last = 0;
      for (int step = 0; step <= 20; ++step) {
        CAPTURE(step);
        const Selection s = w.select(*policy, low_s + (high_s - low_s) * step / 20, step);
        CHECK(s.planned_benefit >= last);
        last = s.planned_benefit;
      }
      CHECK(last == Approx(whole).epsilon(1e-12));
    }
  }
}
