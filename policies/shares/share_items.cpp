#include "policies/shares/share_items.h"

#include <algorithm>

#include "policies/level_rules.h"
#include "sim/statistics.h"

namespace framesim {

void ShareItems::build(const Workload& workload) {
  items_.clear();
  operations_ = 0;
  CompensatedSum least, most;
  for (std::size_t i = 0; i < workload.size(); ++i) {
    if (workload.levels(i) == 0) continue;
    ShareItem item{.item = static_cast<std::uint32_t>(i), .curve = workload.kind[i] == ItemKind::curve};
    const std::size_t first = workload.level_begin[i];
    item.least_s = item.most_s = workload.cost_s[first];
    item.least_benefit = item.most_benefit = workload.benefit[first];
    for (std::size_t k = first + 1; k < workload.level_begin[i + 1]; ++k) {
      const double cost_s = workload.cost_s[k], benefit = workload.benefit[k];
      if (cost_s < item.least_s || (cost_s == item.least_s && benefit > item.least_benefit)) {
        item.least_s = cost_s;
        item.least_benefit = benefit;
      }
      if (benefit > item.most_benefit || (benefit == item.most_benefit && cost_s < item.most_s)) {
        item.most_s = cost_s;
        item.most_benefit = benefit;
      }
    }
    if (item.curve) item.least_s = item.least_benefit = 0;
    operations_ += static_cast<std::int64_t>(workload.levels(i));
    least.add(item.least_s);
    most.add(item.most_s);
    items_.push_back(item);
  }
  least_s_ = least.value();
  most_s_ = most.value();
}

namespace {

// Returns what is paid.
double draw_for(const Workload& workload, const ShareItem& item, double money_s, Selection& selection) {
  ++selection.operations;
  if (item.curve) {
    const double x = curve_resolution(workload, item.item, money_s);
    if (!(x > 0)) return 0;
    selection.level[item.item] = 0;
    selection.resolution[item.item] = x;
    return curve_cost_s(workload, item.item, x);
  }
  const std::size_t first = workload.level_begin[item.item], end = workload.level_begin[item.item + 1];
  std::size_t best = end;
  for (std::size_t k = first; k < end; ++k) {
    if (workload.cost_s[k] > money_s) continue;
    if (best == end || workload.benefit[k] > workload.benefit[best] ||
        (workload.benefit[k] == workload.benefit[best] && workload.cost_s[k] < workload.cost_s[best])) {
      best = k;
    }
  }
  selection.operations += static_cast<std::int64_t>(end - first);
  if (best == end) return 0;
  draw(selection, item.item, best - first);
  return workload.cost_s[best];
}

}  // namespace

void spend_shares(const Workload& workload, const ShareItems& items, const std::vector<double>& share_s, ShareRest rest,
                  Selection& selection) {
  // Given and paid so far: their difference is what is carried, and does not collect rounding from item to item.
  CompensatedSum given, paid;
  for (std::size_t k = 0; k < items.size(); ++k) {
    double money_s = share_s[k];
    if (rest == ShareRest::carry) {
      CompensatedSum left = given;
      left.add(share_s[k]);
      left.add(-paid.value());
      money_s = std::max(money_s, left.value());
    }
    given.add(share_s[k]);
    paid.add(draw_for(workload, items[k], money_s, selection));
  }
}

}  // namespace framesim
