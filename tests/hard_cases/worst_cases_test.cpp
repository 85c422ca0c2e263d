// Where the printed rules break: for each policy the worst case that a search over small lists has found.
//
// kWorst is the result of the long search, 100,000 random cases for each policy and kind, shrunk:
//   framesim_tests "[.long]"   prints it anew, with seeds, and fails where it finds worse.
#include <fmt/format.h>

#include <algorithm>
#include <cstdio>
#include <string>
#include <vector>

#include "policies/registry.h"
#include "tests/catch.h"
#include "tests/hard_cases/worst_search.h"
#include "tests/policies/make_policy.h"
#include "tests/seeds.h"

using namespace framesim;
using namespace framesim::testing;

namespace {

constexpr std::uint64_t kLongSearch = 100'000;

// The registry's defaults, and the variants that a paper prints.
std::vector<std::string> searched_policies() {
  std::vector<std::string> names;
  for (const PolicyEntry& entry : policies()) names.emplace_back(entry.name);
  for (const char* printed : {"funkhouser:rule=incremental", "funkhouser:rule=printed", "robin-hood:sums=printed",
                              "hierarchical:rule=printed", "contribution-halving:start=last"}) {
    names.emplace_back(printed);
  }
  return names;
}

struct Kept {
  std::string policy;
  Badness badness;
  double value;
  std::string small;
};

const std::vector<Kept> kWorst = {
#include "tests/hard_cases/worst_cases.inc"
};

// Prints lines for worst_cases.inc.
void search_long(Badness badness) {
  const std::string_view name = kBadnessNames[static_cast<std::size_t>(badness)];
  for (const std::string& policy : searched_policies()) {
    const WorstCase found = search_worst(policy, badness, 1, kLongSearch);
    fmt::print("{{\"{}\", Badness::{}, {}, \"{}\"}},  // seed {}\n", policy, name, found.value, to_text(found.small),
               found.seed);
    std::fflush(stdout);
    for (const Kept& kept : kWorst) {
      if (kept.policy != policy || kept.badness != badness) continue;
      CAPTURE(policy, name);
      CHECK(found.value <= kept.value * (1 + 1e-9) + 1e-12);
    }
  }
}

}  // namespace

TEST_CASE("worst cases: a case reads back as it was written, and shrinking ends") {
  for (std::uint64_t seed = 1; seed <= 200; ++seed) {
    CAPTURE(seed);
    SmallCase small = random_case(seed);
    CHECK(to_text(parse_case(to_text(small))) == to_text(small));
    int steps = 0;
    for (std::vector<SmallCase> next = smaller(small); !next.empty(); next = smaller(small), ++steps) {
      small = next.front();
      REQUIRE(steps < 1000);
    }
    CHECK(to_text(small).substr(0, 5) == "1 | 1");
  }
}

TEST_CASE("worst cases: each kept case still gives its number") {
  for (const Kept& kept : kWorst) {
    DYNAMIC_SECTION(kept.policy << ", " << kBadnessNames[static_cast<std::size_t>(kept.badness)] << ": "
                                << kept.small) {
      CHECK(measure(kept.policy, kept.badness, parse_case(kept.small)) == Approx(kept.value).epsilon(1e-9));
    }
  }
}

// Budget 1, costs 1 and 106: the finest in any case. 106 / 1 - 1.
TEST_CASE("worst cases: full detail by hand") {
  CHECK(measure("full-detail", Badness::overspend, parse_case("1 | 1@1 1/1/1 106/1/2")) == 105);
}

// 2048 pixels are 1024 for each of two polygons: the finest, 27 for a budget of 1.
TEST_CASE("worst cases: static by hand") {
  CHECK(measure("static", Badness::overspend, parse_case("1 | 2048@1 1/1/1 27/1/2")) == 26);
}

// Values 1/1, 105/82 = 1.28 and 118/85 = 1.39, budget 83: the best value comes first, does not fit, and ends it. What is
// left is the coarsest level of benefit 1, where 105 would do.
TEST_CASE("worst cases: the printed greedy rule by hand") {
  CHECK(measure("funkhouser:rule=printed", Badness::loss, parse_case("83 | 1@1 1/1/1 82/105/3 85/118/7")) ==
        Approx(1 - 1.0 / 105));
}

// The guarantee of half the optimum, and the proofs.
TEST_CASE("worst cases: what is guaranteed is kept by the worst that was found") {
  const auto loss_of = [](std::string_view policy) {
    for (const Kept& kept : kWorst) {
      if (kept.policy == policy && kept.badness == Badness::loss) return kept.value;
    }
    return 1.0;
  };
  CHECK(loss_of("funkhouser") <= 0.5);
  CHECK(loss_of("exact") == 0);
  CHECK(loss_of("full-detail") == 0);
}

// Costs 9 and 20, budget 19: a frame multiplies the size threshold by 9/19 or 20/19, and it is back where it was after a
// coarse and b fine frames only if 9^a 20^b = 19^(a+b), which no whole numbers but 0 solve. It changes between the two
// levels for ever without a period.
TEST_CASE("worst cases: feedback never settles between two levels, nor has a period") {
  const SmallCase small = parse_case("19 | 1@1 9/1/1 20/1/29");
  CHECK(measure("feedback", Badness::oscillation, small) == kLongestPeriod);
  CHECK(amplitude("feedback", small) == Approx(11.0 / 19));  // (20 - 9) / 19
}

// Costs 1 and 3, budget 2: half above and half below the target, and no level between.
TEST_CASE("worst cases: pid swings by the whole budget between two levels") {
  const SmallCase small = parse_case("2 | 1@1 1/1/1 3/1/3");
  CHECK(measure("pid", Badness::oscillation, small) == kLongestPeriod);
  CHECK(amplitude("pid", small) == 1);
}

TEST_CASE("worst cases: the first seeds of the search are no worse than what is kept") {
  for (const Kept& kept : kWorst) {
    for (std::uint64_t seed = 1; seed <= seeds(60); ++seed) {
      const SmallCase small = random_case(seed);
      CAPTURE(kept.policy, kBadnessNames[static_cast<std::size_t>(kept.badness)], seed, to_text(small));
      CHECK(measure(kept.policy, kept.badness, small) <= kept.value * (1 + 1e-9) + 1e-12);
    }
  }
}

TEST_CASE("worst cases: every policy has been searched for loss, overspending, oscillation and operations") {
  for (const std::string& policy : searched_policies()) {
    for (std::size_t b = 0; b < std::size(kBadnessNames); ++b) {
      CAPTURE(policy, kBadnessNames[b]);
      CHECK(std::count_if(kWorst.begin(), kWorst.end(), [&](const Kept& kept) {
              return kept.policy == policy && kept.badness == static_cast<Badness>(b);
            }) == 1);
    }
  }
}

TEST_CASE("worst cases: the long search for loss", "[.long]") { search_long(Badness::loss); }
TEST_CASE("worst cases: the long search for overspending", "[.long]") { search_long(Badness::overspend); }
TEST_CASE("worst cases: the long search for oscillation", "[.long]") { search_long(Badness::oscillation); }
TEST_CASE("worst cases: the long search for operations", "[.long]") { search_long(Badness::operations); }
