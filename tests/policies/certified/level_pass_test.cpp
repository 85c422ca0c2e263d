// The vectorised pass against a plain loop, and against itself on every instruction set.
#include "policies/certified/level_pass.h"

#include <cstring>

#include "tests/catch.h"
#include "tests/policies/workloads.h"
#include "tests/sim/each_target.h"

using namespace framesim;
using namespace framesim::certified;
using framesim::testing::TestRandom;

namespace {

struct Lists {
  std::vector<double> cost_s, benefit;
  std::vector<std::uint32_t> begin{0};
  std::vector<std::uint8_t> kept;
  std::size_t size() const { return begin.size() - 1; }
  LevelColumns columns(bool may_omit, bool keeps) const {
    return {.cost_s = cost_s,
            .benefit = benefit,
            .begin = begin,
            .kept = keeps ? std::span<const std::uint8_t>(kept) : std::span<const std::uint8_t>(),
            .bonus = 0.2,
            .may_omit = may_omit};
  }
};

// Items of `fewest` to `most` levels; 0 is none.
Lists random_lists(std::uint64_t seed, std::size_t n, int fewest, int most) {
  TestRandom random(seed);
  Lists lists;
  for (std::size_t i = 0; i < n; ++i) {
    const int levels = random.whole(fewest, most);
    for (int l = 0; l < levels; ++l) {
      lists.cost_s.push_back(random.uniform(0.1, 2) * (l + 1));
      lists.benefit.push_back(random.uniform(0, 3) * (l + 1));
    }
    lists.begin.push_back(static_cast<std::uint32_t>(lists.cost_s.size()));
    lists.kept.push_back(random.chance(0.3) ? kNoLevel : static_cast<std::uint8_t>(random.whole(0, most)));
  }
  return lists;
}

// The first level of largest value - m * cost, or -1.
int plain_choice(const LevelColumns& columns, std::size_t item, double m) {
  int best = columns.levels(item) > 0 && !columns.may_omit ? 0 : -1;
  for (int l = 0; l < columns.levels(item); ++l) {
    const double now = columns.valued(item, best) - m * columns.cost(item, best);
    if (columns.valued(item, l) - m * columns.cost(item, l) > now) best = l;
  }
  return best;
}

struct Outcome {
  PassResult sums, sample;
  std::vector<std::int16_t> level;
  std::vector<OpenItem> open;
};

Outcome run(const LevelColumns& columns, const Bracket& bracket) {
  Outcome outcome;
  outcome.level.resize(columns.size());
  outcome.sums = pass_over_all(columns, bracket, outcome.level, outcome.open);
  outcome.sample = pass_over_sample(columns, bracket, 3);
  return outcome;
}

bool same_bits(const PassSums& a, const PassSums& b) { return std::memcmp(&a, &b, sizeof a) == 0; }

template <class Body>
void for_each_list(const Body& body) {
  for (const auto& [fewest, most] : {std::pair{4, 4}, std::pair{3, 3}, std::pair{1, 6}, std::pair{0, 5}}) {
    for (const std::size_t n : {1u, 7u, 8u, 9u, 255u, 256u, 700u}) {
      const Lists lists = random_lists(n + 1000 * static_cast<std::size_t>(most), n, fewest, most);
      for (const bool may_omit : {false, true}) {
        for (const bool keeps : {false, true}) {
          CAPTURE(fewest, most, n, may_omit, keeps);
          body(lists.columns(may_omit, keeps));
        }
      }
    }
  }
}

}  // namespace

TEST_CASE("a pass chooses as a plain loop over items and levels does, at both multipliers") {
  const Bracket bracket{0.7, 1.1};
  for_each_list([&](const LevelColumns& columns) {
    const Outcome outcome = run(columns, bracket);
    double cost_low = 0, cost_high = 0, worth_high = 0;
    std::size_t open = 0;
    for (std::size_t i = 0; i < columns.size(); ++i) {
      const int low = plain_choice(columns, i, bracket.low), high = plain_choice(columns, i, bracket.high);
      REQUIRE(outcome.level[i] == high);
      cost_low += columns.cost(i, low), cost_high += columns.cost(i, high);
      double worth = 0;
      for (int l = 0; l < columns.levels(i); ++l) {
        worth = std::max(worth, columns.worth(i, l) - bracket.high * columns.cost(i, l));
      }
      worth_high += worth;
      if (low == high) continue;
      REQUIRE(open < outcome.open.size());
      CHECK(outcome.open[open].item == i);
      CHECK(outcome.open[open].low == low);
      CHECK(outcome.open[open].high == high);
      ++open;
    }
    CHECK(open == outcome.open.size());
    CHECK(outcome.sums.low.cost_s == Approx(cost_low).epsilon(1e-12));
    CHECK(outcome.sums.high.cost_s == Approx(cost_high).epsilon(1e-12));
    CHECK(outcome.sums.high.worth == Approx(worth_high).epsilon(1e-12));
  });
}

TEST_CASE("a pass gives the same bits on every instruction set") {
  for_each_list([](const LevelColumns& columns) {
    const Outcome best = run(columns, {0.7, 1.1});
    test::for_each_target([&](const char* target) {
      CAPTURE(target);
      const Outcome other = run(columns, {0.7, 1.1});
      CHECK(other.level == best.level);
      CHECK(other.open.size() == best.open.size());
      CHECK(same_bits(other.sums.low, best.sums.low));
      CHECK(same_bits(other.sums.high, best.sums.high));
      CHECK(same_bits(other.sample.high, best.sample.high));
      CHECK(other.sums.most_benefit == best.sums.most_benefit);
    });
  });
}
