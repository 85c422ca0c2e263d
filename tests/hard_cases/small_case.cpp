#include "tests/hard_cases/small_case.h"

#include <fmt/format.h>

#include <algorithm>
#include <cstdio>
#include <sstream>

#include "tests/catch.h"

namespace framesim::testing {
namespace {

int finest_cost(const SmallCase& small) {
  int sum = 0;
  for (const SmallItem& item : small.items) sum += item.levels.back().cost;
  return sum;
}

bool well_formed(const SmallCase& small) {
  if (small.items.empty() || small.budget < std::max(1, coarsest_cost(small))) return false;
  for (const SmallItem& item : small.items) {
    if (item.levels.empty() || item.area_px < 1 || item.distance_m < 1) return false;
    for (std::size_t l = 0; l < item.levels.size(); ++l) {
      const SmallLevel& level = item.levels[l];
      if (level.cost < 1 || level.benefit < 1 || level.polygons < 1) return false;
      if (l == 0) continue;
      const SmallLevel& below = item.levels[l - 1];
      if (level.cost <= below.cost || level.polygons <= below.polygons || level.benefit < below.benefit) return false;
    }
  }
  return true;
}

// `change` applied to a copy, kept if it is well formed.
template <class Change>
void try_change(const SmallCase& small, std::vector<SmallCase>& found, Change change) {
  SmallCase copy = small;
  change(copy);
  if (well_formed(copy)) found.push_back(std::move(copy));
}

void halve_numbers(const SmallCase& small, std::vector<SmallCase>& found) {
  const auto halve = [&](auto number_of) {
    if (SmallCase copy = small; number_of(copy) > 1) {
      number_of(copy) /= 2;
      if (well_formed(copy)) found.push_back(std::move(copy));
    }
  };
  halve([](SmallCase& c) -> int& { return c.budget; });
  for (std::size_t i = 0; i < small.items.size(); ++i) {
    halve([i](SmallCase& c) -> int& { return c.items[i].area_px; });
    halve([i](SmallCase& c) -> int& { return c.items[i].distance_m; });
    for (std::size_t l = 0; l < small.items[i].levels.size(); ++l) {
      halve([i, l](SmallCase& c) -> int& { return c.items[i].levels[l].cost; });
      halve([i, l](SmallCase& c) -> int& { return c.items[i].levels[l].benefit; });
      halve([i, l](SmallCase& c) -> int& { return c.items[i].levels[l].polygons; });
    }
  }
}

}  // namespace

int coarsest_cost(const SmallCase& small) {
  int sum = 0;
  for (const SmallItem& item : small.items) sum += item.levels.front().cost;
  return sum;
}

SmallCase random_case(std::uint64_t seed) {
  TestRandom random(seed);
  SmallCase small;
  const int items = random.whole(1, 4);
  for (int i = 0; i < items; ++i) {
    SmallItem item{.area_px = 1 << random.whole(4, 17), .distance_m = random.whole(1, 100), .levels = {}};
    SmallLevel level{};
    const int levels = random.whole(1, 3);
    for (int l = 0; l < levels; ++l) {
      // Steps of all sizes: a rule is at its worst where a small step stands beside a large one.
      level.cost += random.whole(l == 0 ? 0 : 1, 1 << random.whole(0, 7));
      level.benefit += random.whole(0, 1 << random.whole(0, 7));
      level.polygons += random.whole(1, 1 << random.whole(0, 9));
      item.levels.push_back(level);
    }
    small.items.push_back(std::move(item));
  }
  small.budget = random.whole(coarsest_cost(small), finest_cost(small));
  return small;
}

std::string to_text(const SmallCase& small) {
  std::string text = fmt::format("{}", small.budget);
  for (const SmallItem& item : small.items) {
    text += fmt::format(" | {}@{}", item.area_px, item.distance_m);
    for (const SmallLevel& level : item.levels) {
      text += fmt::format(" {}/{}/{}", level.cost, level.benefit, level.polygons);
    }
  }
  return text;
}

SmallCase parse_case(std::string_view text) {
  std::istringstream in{std::string(text)};
  SmallCase small;
  in >> small.budget;
  for (std::string word; in >> word;) {
    int a = 0, b = 0, c = 0;
    if (word == "|") {
      small.items.emplace_back();
    } else if (std::sscanf(word.c_str(), "%d@%d", &a, &b) == 2) {
      small.items.back().area_px = a;
      small.items.back().distance_m = b;
    } else {
      REQUIRE(std::sscanf(word.c_str(), "%d/%d/%d", &a, &b, &c) == 3);
      small.items.back().levels.push_back({a, b, c});
    }
  }
  REQUIRE(well_formed(small));
  return small;
}

TestWorkload build(const SmallCase& small) {
  TestWorkload w;
  for (const SmallItem& item : small.items) {
    std::vector<TestLevel> levels;
    for (const SmallLevel& level : item.levels) {
      levels.push_back(
          {level.cost * kCostUnit_s, static_cast<double>(level.benefit), static_cast<double>(level.polygons)});
    }
    const auto distance_m = static_cast<double>(item.distance_m);
    w.add_item(
        levels,
        {.projected_area_px = static_cast<double>(item.area_px), .depth_m = distance_m, .distance_m = distance_m});
  }
  w.finish();
  return w;
}

std::vector<SmallCase> smaller(const SmallCase& small) {
  std::vector<SmallCase> found;
  for (std::size_t i = 0; i < small.items.size(); ++i) {
    const auto at = static_cast<std::ptrdiff_t>(i);
    // With the budget, and with what is left of it without the item.
    try_change(small, found, [at](SmallCase& c) { c.items.erase(c.items.begin() + at); });
    try_change(small, found, [at, i](SmallCase& c) {
      c.budget -= c.items[i].levels.back().cost;
      c.items.erase(c.items.begin() + at);
    });
  }
  for (std::size_t i = 0; i < small.items.size(); ++i) {
    for (std::size_t l = 0; l < small.items[i].levels.size(); ++l) {
      try_change(small, found, [i, l](SmallCase& c) {
        c.items[i].levels.erase(c.items[i].levels.begin() + static_cast<std::ptrdiff_t>(l));
      });
    }
  }
  halve_numbers(small, found);
  return found;
}

}  // namespace framesim::testing
