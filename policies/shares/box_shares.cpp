#include "policies/shares/box_shares.h"

#include <algorithm>

#include "sim/statistics.h"

namespace framesim {

double BoxShares::left_s() const { return std::max(0.0, budget_s_ - fixed_s_); }

void BoxShares::solve(std::vector<ShareBox>& boxes, double budget_s) {
  budget_s_ = budget_s;
  rounds_ = 0;
  operations_ = static_cast<std::int64_t>(boxes.size());
  free_.clear();
  CompensatedSum fixed;
  for (std::uint32_t i = 0; i < boxes.size(); ++i) {
    ShareBox& box = boxes[i];
    box.share_s = box.low_s;
    if (box.weight > 0 && box.high_s > box.low_s) {
      free_.push_back(i);
    } else {
      fixed.add(box.low_s);
    }
  }
  fixed_s_ = fixed.value();
  while (!free_.empty()) {
    if (rounds_++ == kMostRounds) fix_by_breakpoints(boxes);
    CompensatedSum weights;
    for (const std::uint32_t i : free_) weights.add(boxes[i].weight);
    const double price = left_s() / weights.value();
    double over = 0, under = 0;  // what clamping frees, what it costs
    for (const std::uint32_t i : free_) {
      const ShareBox& box = boxes[i];
      const double share_s = price * box.weight;
      if (share_s > box.high_s) over += share_s - box.high_s;
      if (share_s < box.low_s) under += box.low_s - share_s;
    }
    operations_ += 2 * static_cast<std::int64_t>(free_.size());
    if ((over == 0 && under == 0) || rounds_ > kMostRounds) {
      for (const std::uint32_t i : free_) {
        boxes[i].share_s = std::clamp(price * boxes[i].weight, boxes[i].low_s, boxes[i].high_s);
      }
      return;
    }
    fix(boxes, price, over >= under, under >= over);
  }
}

void BoxShares::fix(std::vector<ShareBox>& boxes, double price, bool highs, bool lows) {
  CompensatedSum fixed;
  fixed.add(fixed_s_);
  std::size_t kept = 0;
  for (const std::uint32_t i : free_) {
    ShareBox& box = boxes[i];
    const double share_s = price * box.weight;
    if (highs && share_s > box.high_s) {
      box.share_s = box.high_s;
    } else if (lows && share_s < box.low_s) {
      box.share_s = box.low_s;
    } else {
      free_[kept++] = i;
      continue;
    }
    fixed.add(box.share_s);
  }
  free_.resize(kept);
  fixed_s_ = fixed.value();
}

// Between two neighbouring breakpoints it is the same boxes that are free: finds the last breakpoint at which the
// budget is not yet spent, and fixes all others for good.
void BoxShares::fix_by_breakpoints(std::vector<ShareBox>& boxes) {
  breakpoints_.clear();
  for (const std::uint32_t i : free_) {
    breakpoints_.push_back(boxes[i].low_s / boxes[i].weight);
    breakpoints_.push_back(boxes[i].high_s / boxes[i].weight);
  }
  std::sort(breakpoints_.begin(), breakpoints_.end());
  operations_ += static_cast<std::int64_t>(breakpoints_.size());
  const double most_s = left_s();
  const auto affordable = [&](double price) {
    CompensatedSum sum;
    for (const std::uint32_t i : free_) sum.add(std::clamp(price * boxes[i].weight, boxes[i].low_s, boxes[i].high_s));
    operations_ += static_cast<std::int64_t>(free_.size());
    return sum.value() <= most_s;
  };
  const auto beyond = std::partition_point(breakpoints_.begin(), breakpoints_.end(), affordable);
  const double price = beyond == breakpoints_.begin() ? 0 : *(beyond - 1);
  CompensatedSum fixed;
  fixed.add(fixed_s_);
  std::size_t kept = 0;
  for (const std::uint32_t i : free_) {
    ShareBox& box = boxes[i];
    // Divided as above: a breakpoint's own box must not fall on the other side of it by rounding.
    if (box.high_s / box.weight <= price) {
      box.share_s = box.high_s;
    } else if (box.low_s / box.weight > price) {
      box.share_s = box.low_s;
    } else {
      free_[kept++] = i;
      continue;
    }
    fixed.add(box.share_s);
  }
  free_.resize(kept);
  fixed_s_ = fixed.value();
}

}  // namespace framesim
