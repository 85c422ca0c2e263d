#include "policies/tree/step.h"

#include <algorithm>

namespace framesim {
namespace {

Step raise_to(const Worth& from, const Worth& worth, int to, int depth = 1, bool must_gain = true) {
  const double gain = worth.benefit - from.benefit;
  const double extra_s = worth.cost_s - from.cost_s;
  if (!(gain > 0) && must_gain) return {};
  const double free = gain < 0 ? -kNoLimit : kNoLimit;
  return {to, depth, extra_s > 0 ? gain / extra_s : free, extra_s, gain};
}

Step lower_to(const Worth& from, const Worth& worth, int to) {
  const double loss = from.benefit - worth.benefit;
  const double saving_s = from.cost_s - worth.cost_s;
  if (!(saving_s > 0)) return {};
  return {to, 1, loss / saving_s, saving_s, loss};
}

// What `node` is worth once it is opened `depth` steps down; adds the nodes looked at to `looked_at`.
Worth worth_below(const Cut& cut, std::size_t node, int depth, std::int64_t& looked_at) {
  Worth sum;
  cut.for_successors(node, [&](std::size_t below) {
    const bool opens = depth > 1 && cut.has_successors(below);
    const Worth worth = opens ? worth_below(cut, below, depth - 1, looked_at) : cut.worth(below, 0);
    sum.cost_s += worth.cost_s;
    sum.benefit += worth.benefit;
    ++looked_at;
  });
  return sum;
}

bool may_leave_out(const Cut& cut, std::size_t node, bool leave_out) {
  return leave_out && cut.parent(node) == Cut::kNoNode;
}

bool all_coarsest(const Cut& cut, std::size_t node) {
  bool all = true;
  cut.for_successors(node, [&](std::size_t below) { all = all && cut.state(below) == 0; });
  return all;
}

}  // namespace

Step next_raise(Cut& cut, std::size_t node, bool must_gain) {
  const int state = cut.state(node);
  cut.count(1);
  if (state < kLeftOut) return {};
  const Worth present = cut.present(node);
  if (state + 1 < cut.levels(node)) return raise_to(present, cut.worth(node, state + 1), state + 1, 1, must_gain);
  if (!cut.has_successors(node)) return {};
  std::int64_t looked_at = 0;
  const Worth below = worth_below(cut, node, 1, looked_at);
  cut.count(looked_at);
  return raise_to(present, below, kOpened, 1, must_gain);
}

Step next_lowering(Cut& cut, std::size_t node, bool leave_out) {
  const int state = cut.state(node);
  cut.count(1);
  if (state == kOpened) {
    if (!cut.closable(node) || !all_coarsest(cut, node)) return {};
    const int finest = cut.levels(node) - 1;
    return lower_to(cut.present(node), cut.worth(node, finest), finest);
  }
  if (state > 0) return lower_to(cut.present(node), cut.worth(node, state - 1), state - 1);
  if (state == 0 && may_leave_out(cut, node, leave_out)) return lower_to(cut.present(node), {}, kLeftOut);
  return {};
}

Step best_raise(Cut& cut, std::size_t node, int depth, double limit_s) {
  const int state = cut.state(node);
  if (state == kBelow || (state == kOpened && !cut.closable(node))) return {};
  const Worth present = cut.present(node);
  Step best;
  double least_s = kNoLimit;
  const auto consider = [&](const Worth& worth, int to, int down) {
    const Step step = raise_to(present, worth, to, down);
    if (!step) return;
    least_s = std::min(least_s, step.cost_s);
    if ((step.cost_s <= 0 || step.cost_s <= limit_s) && step.value > best.value) best = step;
  };
  const int first = state == kOpened ? 0 : state + 1;
  for (int level = first; level < cut.levels(node); ++level) consider(cut.worth(node, level), level, 1);
  std::int64_t looked_at = cut.levels(node) - first;
  if (state >= kLeftOut && cut.has_successors(node)) {
    std::int64_t nodes = 0;
    for (int down = 1; down <= depth; ++down) {
      std::int64_t reached = 0;
      const Worth below = worth_below(cut, node, down, reached);
      looked_at += reached;
      if (reached == nodes) break;  // there is nothing deeper
      nodes = reached;
      consider(below, kOpened, down);
    }
  }
  cut.count(looked_at);
  best.least_s = least_s;
  return best;
}

Step best_lowering(Cut& cut, std::size_t node, bool leave_out) {
  const int state = cut.state(node);
  if (state < 0 && !cut.closable(node)) return {};
  const Worth present = cut.present(node);
  Step best;
  const auto consider = [&](const Worth& worth, int to) {
    const Step step = lower_to(present, worth, to);
    if (step && (!best || step.value < best.value)) best = step;
  };
  const int last = state == kOpened ? cut.levels(node) : state;
  for (int level = 0; level < last; ++level) consider(cut.worth(node, level), level);
  if (may_leave_out(cut, node, leave_out)) consider({}, kLeftOut);
  cut.count(last + 1);
  return best;
}

void take(Cut& cut, std::size_t node, const Step& step) {
  if (step.to == kOpened) {
    cut.open(node, step.depth);
  } else if (cut.state(node) == kOpened) {
    cut.close(node, step.to);
  } else {
    cut.draw(node, step.to);
  }
}

}  // namespace framesim
