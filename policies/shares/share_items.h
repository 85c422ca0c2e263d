// What the policies that divide the budget into shares of time have in common: what each item can use, and what it
// draws for the share it gets.
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "sim/policy.h"

namespace framesim {

// An item that can be drawn, between its cheapest and its most beneficial choice.
struct ShareItem {
  std::uint32_t item = 0;
  bool curve = false;
  double least_s =
      0;  // of its cheapest level (of equals the most beneficial, then the coarsest); a curve: 0, not drawn
  double least_benefit = 0;
  double most_s = 0;  // of its most beneficial level (of equals the cheapest); a curve: of x = 1
  double most_benefit = 0;
};

class ShareItems {
 public:
  // Reads costs and benefits of a flat workload. O(levels).
  void build(const Workload& workload);

  std::size_t size() const { return items_.size(); }
  const ShareItem& operator[](std::size_t k) const { return items_[k]; }
  double least_s() const { return least_s_; }  // sums over all items
  double most_s() const { return most_s_; }
  std::int64_t operations() const { return operations_; }  // levels looked at

 private:
  std::vector<ShareItem> items_;
  double least_s_ = 0, most_s_ = 0;
  std::int64_t operations_ = 0;
};

// What becomes of money that a level leaves of its item's share.
enum class ShareRest { lose, carry };  // `carry`: it goes to the next item, in order of items

// Draws for `share_s` (one entry an item of `items`, seconds in all, not beyond the cheapest choice): the most
// beneficial level that costs no more (of equals the cheapest, then the coarsest), or the resolution that can be paid;
// nothing if neither can. Costs no more than the shares together, up to their rounding. Counts a level compared as an
// operation.
void spend_shares(const Workload& workload, const ShareItems& items, const std::vector<double>& share_s, ShareRest rest,
                  Selection& selection);

// Shares are computed for a budget that is smaller by this factor: sums and products round by some 1e-16 of it, and the
// budget must not be broken by that. A larger margin wastes money, a smaller one does not cover the rounding.
inline constexpr double kRoundingMargin = 1 - 1e-13;

}  // namespace framesim
