// The part of DualSearch that deals with trees: a node's term is the larger of its own and the sum of its children's.
#include <cmath>
#include <limits>

#include "sim/bound_search.h"

namespace framesim {
namespace {

constexpr double kInfinity = std::numeric_limits<double>::infinity();
constexpr std::uint32_t kSettled = 0xffffffffu;  // in open_children_
constexpr double kSameCost = 64 * kRounding;     // relative

// The more valuable at m, else the cheaper. At infinity only what begins with an infinite slope is worth anything.
const DualPiece& better(const DualPiece& a, const DualPiece& b, double m) {
  if (m == kInfinity) return b.w > a.w ? b : a;
  const double of_a = a.value(m), of_b = b.value(m);
  if (of_a != of_b) return of_b > of_a ? b : a;
  return b.cost_s(m) < a.cost_s(m) ? b : a;
}

}  // namespace

void DualSearch::add_tree(std::uint32_t root) {
  const Workload& w = *workload_;
  parent_[root] = kNoParent;
  for (std::uint32_t i = root; i < w.subtree_end[root]; ++i) {
    nodes_.push_back(i);
    base_[i] = {};
    if (w.kind[i] == ItemKind::curve) keep_curve(i, curve_term(w, i));
    for (std::uint32_t child = i + 1; child < w.subtree_end[i]; child = w.subtree_end[child]) parent_[child] = i;
  }
}

void DualSearch::start_trees() {
  choose_in_trees(low_, at_low_);
  for (const std::uint32_t node : nodes_) node_low_[node] = node_now_[node];
  choose_in_trees(high_, at_high_);
  for (const std::uint32_t node : nodes_) node_high_[node] = node_now_[node];
  settle_trees();
}

// From the last node to the first, so that children come before their parent.
void DualSearch::choose_in_trees(double m, DualPiece& total) {
  for (const std::uint32_t node : nodes_) node_now_[node] = base_[node];
  for (std::size_t k = nodes_.size(); k-- > 0;) {
    const std::uint32_t node = nodes_[k];
    if (workload_->kind[node] != ItemKind::bundle) {
      node_now_[node] = better(piece(node, choose_best(node, m)), node_now_[node], m);
    }
    (parent_[node] == kNoParent ? total : node_now_[parent_[node]]).add(node_now_[node]);
  }
}

// The node's term between low and high, where it is known. A convex term is a line between two points where it touches
// lines of the same slope, or lines that do not meet in between. A bundle's children are settled before it.
std::optional<DualPiece> DualSearch::settled_piece(std::uint32_t node) const {
  const DualPiece &low = node_low_[node], &high = node_high_[node];
  if (low.w == 0 && high.w == 0) {
    if (std::fabs(low.d - high.d) <= kSameCost * low.d) return high;
    const double key = (low.a - high.a) / (low.d - high.d);
    if (!inside(key)) return key <= low_ ? high : low;
  }
  if (workload_->kind[node] == ItemKind::bundle && open_children_[node] == 0) return base_[node];
  const bool leaf = workload_->subtree_end[node] == node + 1;
  if (workload_->kind[node] != ItemKind::curve || !leaf) return std::nullopt;
  const CurveTerm& term = curves_[node];
  if (inside(term.first) || inside(term.second)) return std::nullopt;
  return term.piece_at(high_);
}

void DualSearch::settle_trees() {
  for (const std::uint32_t node : nodes_) open_children_[node] = 0;
  for (std::size_t k = nodes_.size(); k-- > 0;) {
    const std::uint32_t node = nodes_[k];
    const std::optional<DualPiece> piece = settled_piece(node);
    const bool root = parent_[node] == kNoParent;
    if (piece) {
      open_children_[node] = kSettled;
      (root ? settled_ : base_[parent_[node]]).add(*piece);
    } else if (!root) {
      ++open_children_[parent_[node]];
    }
  }
  std::size_t kept = 0;
  std::uint32_t end = 0;  // of the last subtree taken out
  for (const std::uint32_t node : nodes_) {
    if (node < end) continue;
    if (open_children_[node] == kSettled) {
      end = workload_->subtree_end[node];
    } else {
      nodes_[kept++] = node;
    }
  }
  nodes_.resize(kept);
}

}  // namespace framesim
