// What every policy owes its callers, checked over the whole registry and over the variants that each parameter offers.
// A policy added to policies/registry.cpp is tested here without another line.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <string>
#include <vector>

#include "tests/catch.h"
#include "tests/policies/make_policy.h"
#include "tests/seeds.h"

using namespace framesim;
using namespace framesim::testing;

namespace {

constexpr double kInfinity = std::numeric_limits<double>::infinity();

std::vector<std::string> split(const std::string& list) {
  std::vector<std::string> words;
  for (std::size_t at = 0; at <= list.size();) {
    const std::size_t comma = std::min(list.find(", ", at), list.size());
    words.push_back(list.substr(at, comma - at));
    at = comma + 2;
  }
  return words;
}

bool has_words(const ParameterInfo& info) { return info.allowed.find(", ") != std::string::npos; }

// "number 1 .. 5" -> {"1", "5"}; nothing for an open range.
std::vector<std::string> range_ends(const ParameterInfo& info) {
  const std::size_t dots = info.allowed.find(" .. ");
  if (dots == std::string::npos) return {};
  const std::size_t low = info.allowed.rfind(' ', dots - 1) + 1;
  return {info.allowed.substr(low, dots - low), info.allowed.substr(dots + 4)};
}

// The default, each word of each enumeration or flag alone, and each pair of them.
std::vector<std::string> main_variants(const PolicyEntry& entry) {
  std::vector<std::string> options;
  std::vector<std::size_t> owner;
  for (std::size_t p = 0; p < entry.parameters.size(); ++p) {
    if (!has_words(entry.parameters[p])) continue;
    for (const std::string& word : split(entry.parameters[p].allowed)) {
      if (word == entry.parameters[p].default_text) continue;
      options.push_back(entry.parameters[p].name + "=" + word);
      owner.push_back(p);
    }
  }
  std::vector<std::string> specs = {std::string(entry.name)};
  for (std::size_t a = 0; a < options.size(); ++a) {
    specs.push_back(fmt::format("{}:{}", entry.name, options[a]));
    for (std::size_t b = a + 1; b < options.size(); ++b) {
      if (owner[a] != owner[b]) specs.push_back(fmt::format("{}:{},{}", entry.name, options[a], options[b]));
    }
  }
  return specs;
}

// Each number at each end of its range. A policy may refuse one that contradicts another parameter's default.
std::vector<std::string> extreme_variants(const PolicyEntry& entry) {
  std::vector<std::string> specs;
  for (const ParameterInfo& info : entry.parameters) {
    for (const std::string& end : range_ends(info)) {
      const std::string spec = fmt::format("{}:{}={}", entry.name, info.name, end);
      try {
        make_policy(spec);
        specs.push_back(spec);
      } catch (const InputError&) {
      }
    }
  }
  return specs;
}

std::vector<std::string> all_variants() {
  std::vector<std::string> specs;
  for (const PolicyEntry& entry : policies()) {
    for (std::string& spec : main_variants(entry)) specs.push_back(std::move(spec));
    for (std::string& spec : extreme_variants(entry)) specs.push_back(std::move(spec));
  }
  return specs;
}

// A random workload of the kinds that the policy says it handles.
TestWorkload workload_for(const Policy& policy, std::uint64_t seed, std::size_t n) {
  const WorkloadRequest request = policy.traits().request;
  return random_workload(seed, n,
                         {.concave = seed % 2 == 0,
                          .curves = request.curves && seed % 3 != 0,
                          .hierarchy = request.hierarchy && seed % 5 != 0,
                          .hard = seed % 4 != 0});
}

// The first visible item with neither itself, nor anything above or below it, drawn; or -1.
long first_omitted(const Workload& w, const Selection& s) {
  for (std::size_t i = 0; i < w.size(); ++i) {
    if (w.kind[i] == ItemKind::bundle) continue;
    bool shown = false;
    for (std::size_t j = 0; j < w.size() && !shown; ++j) {
      const bool above = w.hierarchical() && j < i && i < w.subtree_end[j];
      const bool below = w.hierarchical() && i < j && j < w.subtree_end[i];
      shown = (i == j || above || below) && s.level[j] != kNotDrawn;
    }
    if (!shown) return static_cast<long>(i);
  }
  return -1;
}

// Everything that holds of one selection.
void check_selection(const Policy& policy, const TestWorkload& w, const Selection& s, double budget_s) {
  const PolicyTraits traits = policy.traits();
  const std::string fault = find_fault(w.workload, s).value_or("");
  REQUIRE(fault == "");
  REQUIRE(s.operations >= 0);
  if (s.bound && std::isfinite(budget_s)) REQUIRE(s.planned_benefit <= *s.bound * (1 + 1e-9));
  if (!traits.may_omit) REQUIRE(first_omitted(w.workload, s) == -1);
  // The coarsest admissible choice. With a hierarchy what is drawn must be a cut: only curves can be left out of it.
  const double least_s = traits.may_omit && !traits.request.hierarchy ? 0 : w.coarsest_cost_s();
  if (traits.keeps_budget && least_s <= budget_s) REQUIRE(s.planned_cost_s <= budget_s * (1 + 1e-12));
}

bool same(const Selection& a, const Selection& b) {
  return a.level == b.level && a.resolution == b.resolution && a.planned_cost_s == b.planned_cost_s &&
         a.planned_benefit == b.planned_benefit && a.bound == b.bound && a.operations == b.operations;
}

// Five frames with changing budgets and frame times, each observed. The policy is prepared first.
std::vector<Selection> run(Policy& policy, const TestWorkload& w) {
  policy.prepare(w.scene());
  const double finest_s = w.finest_cost_s();
  std::vector<Selection> frames;
  for (const double share : {0.5, 0.1, 0.9, 0.3, 0.3}) {
    const auto frame = static_cast<std::int64_t>(frames.size());
    const double budget_s = share * finest_s;
    frames.push_back(w.select(policy, budget_s, frame));
    tell(policy, w, frames.back(), finest_s * (1 - share), TestWorkload::target_for(budget_s), frame);
  }
  return frames;
}

// Budgets from nothing to no limit.
std::vector<double> budgets(const TestWorkload& w) {
  const double coarsest_s = w.coarsest_cost_s(), finest_s = w.finest_cost_s();
  return {0, 1e-300, 0.5 * coarsest_s, coarsest_s, 0.5 * (coarsest_s + finest_s), finest_s, kInfinity};
}

// Runs `body` on a fresh policy of each variant.
template <class Body>
void for_each_variant(const Body& body) {
  for (const std::string& spec : all_variants()) {
    CAPTURE(spec);
    const std::unique_ptr<Policy> policy = make_policy(spec);
    body(*policy, spec);
  }
}

void select_at_all_budgets(Policy& policy, const TestWorkload& w) {
  policy.prepare(w.scene());
  std::int64_t frame = 0;
  for (const double budget_s : budgets(w)) {
    CAPTURE(budget_s);
    const Selection s = w.select(policy, budget_s, frame);
    check_selection(policy, w, s, budget_s);
    tell(policy, w, s, s.planned_cost_s, TestWorkload::target_for(budget_s), frame++);
  }
}

}  // namespace

TEST_CASE("every policy is registered once, with a sentence and its counted operation") {
  std::vector<std::string_view> names;
  for (const PolicyEntry& entry : policies()) {
    CAPTURE(entry.name);
    CHECK(std::find(names.begin(), names.end(), entry.name) == names.end());
    names.push_back(entry.name);
    CHECK(entry.summary.size() > 10);
    CHECK(make_policy(entry.name)->traits().operation != "");
  }
  CHECK(names.size() >= 9);
}

TEST_CASE("every policy's parameters take their defaults and refuse what is not theirs") {
  for (const PolicyEntry& entry : policies()) {
    CHECK_THROWS_AS(make_policy(fmt::format("{}:no-such-parameter=1", entry.name)), InputError);
    for (const ParameterInfo& info : entry.parameters) {
      CAPTURE(entry.name, info.name, info.allowed);
      const auto with = [&](const std::string& value) { return fmt::format("{}:{}={}", entry.name, info.name, value); };
      CHECK_NOTHROW(make_policy(with(info.default_text)));
      CHECK_THROWS_AS(make_policy(with("no-such-value")), InputError);
      CHECK_THROWS_AS(make_policy(with("nan")), InputError);
      CHECK_THROWS_AS(make_policy(with("")), InputError);
      CHECK(info.help.size() > 5);
      for (const std::string& end : range_ends(info)) {
        CHECK_THROWS_AS(make_policy(with(end.front() == '-' ? end + "9" : "-" + end + "9")), InputError);  // below
      }
      if (!has_words(info)) CHECK_THROWS_AS(make_policy(with("1e300")), InputError);
    }
  }
}

TEST_CASE("every policy's default spelled out is its default") {
  for (const PolicyEntry& entry : policies()) {
    CAPTURE(entry.name);
    std::string spec(entry.name);
    for (std::size_t p = 0; p < entry.parameters.size(); ++p) {
      spec += fmt::format("{}{}={}", p == 0 ? ':' : ',', entry.parameters[p].name, entry.parameters[p].default_text);
    }
    const auto silent = make_policy(entry.name);
    const auto spelled = make_policy(spec);
    const TestWorkload w = workload_for(*silent, 7, 20);
    const std::vector<Selection> a = run(*silent, w), b = run(*spelled, w);
    for (std::size_t k = 0; k < a.size(); ++k) CHECK(same(a[k], b[k]));
  }
}

TEST_CASE("every policy selects validly and as it promises, from 1 to 64 items") {
  for_each_variant([](Policy& policy, const std::string&) {
    for (std::size_t n = 1; n <= 64; n += n < 8 ? 1 : 7) {
      for (std::uint64_t seed = 0; seed < seeds(12); ++seed) {
        CAPTURE(seed, n);
        select_at_all_budgets(policy, workload_for(policy, seed, n));
      }
    }
  });
}

TEST_CASE("every default policy selects validly on many random workloads") {
  for (const PolicyEntry& entry : policies()) {
    CAPTURE(entry.name);
    const auto policy = make_policy(entry.name);
    for (std::uint64_t seed = 100; seed < 100 + seeds(500); ++seed) {
      CAPTURE(seed);
      select_at_all_budgets(*policy, workload_for(*policy, seed, 1 + seed % 64));
    }
  }
}

TEST_CASE("every policy draws nothing of nothing") {
  for_each_variant([](Policy& policy, const std::string&) {
    TestWorkload w;
    w.finish();
    for (const double budget_s : {0.0, 1.0, kInfinity}) {
      policy.prepare(w.scene());
      const Selection s = w.select(policy, budget_s);
      CHECK(s.level.empty());
      CHECK(s.planned_cost_s == 0);
      CHECK(s.planned_benefit == 0);
      check_selection(policy, w, s, budget_s);
    }
  });
}

TEST_CASE("every policy decides about one object of one level") {
  for_each_variant([](Policy& policy, const std::string&) {
    TestWorkload w;
    w.add_item({{1e-3, 5, 100}});
    w.finish();
    for (const double budget_s : {0.0, 1e-3, 1.0, kInfinity}) {
      CAPTURE(budget_s);
      policy.prepare(w.scene());
      const Selection s = w.select(policy, budget_s);
      check_selection(policy, w, s, budget_s);
      if (budget_s >= 1) CHECK(s.level[0] == 0);  // there is no reason to leave it out
    }
  });
}

TEST_CASE("every policy copes with a camera inside an object and with everything behind it") {
  const TestView inside{.projected_area_px = kTestScreenPx, .depth_m = 0, .distance_m = 0};
  const TestView behind{.projected_area_px = 0, .depth_m = -3, .distance_m = 3, .view_angle_rad = 3.141592653589793};
  for_each_variant([&](Policy& policy, const std::string&) {
    for (const TestView& view : {inside, behind}) {
      CAPTURE(view.projected_area_px);
      TestWorkload w;
      for (int k = 0; k < 4; ++k) w.add_item({{1e-3, 1, 10}, {2e-3, 2, 50}, {5e-3, 3, 900}}, view);
      w.finish();
      select_at_all_budgets(policy, w);
    }
  });
}

TEST_CASE("every policy copes with items of no benefit and with equal ones") {
  for_each_variant([](Policy& policy, const std::string&) {
    TestWorkload worthless, equal;
    for (int k = 0; k < 5; ++k) {
      worthless.add_item({{1e-3, 0, 10}, {2e-3, 0, 50}}, {.area_m2 = 0, .diagonal_m = 0});
      equal.add_item({{1e-3, 1, 10}, {2e-3, 2, 50}});
    }
    select_at_all_budgets(policy, worthless.finish());
    select_at_all_budgets(policy, equal.finish());
  });
}

TEST_CASE("every policy repeats itself: the same calls give the same selections, also when prepared again") {
  for_each_variant([](Policy& policy, const std::string& spec) {
    for (std::uint64_t seed = 0; seed < 10; ++seed) {
      CAPTURE(seed);
      const TestWorkload w = workload_for(policy, seed, 30);
      const auto other = make_policy(spec);
      const std::vector<Selection> first = run(policy, w), again = run(policy, w), fresh = run(*other, w);
      for (std::size_t k = 0; k < first.size(); ++k) {
        CAPTURE(k);
        REQUIRE(same(first[k], again[k]));
        REQUIRE(same(first[k], fresh[k]));
      }
    }
  });
}

TEST_CASE("every policy reads only the columns that it asks for") {
  for_each_variant([](Policy& policy, const std::string&) {
    TestWorkload w = workload_for(policy, 11, 40);
    const std::vector<Selection> plain = run(policy, w);
    // What was not asked for is not computed: here it is noise.
    const Columns columns = policy.traits().request.columns;
    const auto spoil = [&](Columns column, std::vector<double>& values) {
      if (!has(columns, column)) values.assign(values.size(), std::numeric_limits<double>::quiet_NaN());
    };
    spoil(Columns::depth, w.workload.depth_m);
    spoil(Columns::distance, w.workload.distance_m);
    spoil(Columns::view_angle, w.workload.view_angle_rad);
    spoil(Columns::area, w.workload.area_m2);
    spoil(Columns::diagonal, w.workload.diagonal_m);
    const std::vector<Selection> spoiled = run(policy, w);
    for (std::size_t k = 0; k < plain.size(); ++k) {
      CAPTURE(k);
      REQUIRE(same(plain[k], spoiled[k]));
    }
  });
}
