// contribution-halving: a triangle budget, handed out by a heap of contributions that halve with every finer level.
//
// Source:        D. Campos Milian, SRGGE project 2 (2020), algorithm 1: time-critical rendering.
// Equations:     contribution c(L) = diagonal / (2^L * distance), L = 0 the coarsest level; 0 behind the camera. While
//                the triangles are under the budget, raise the item of largest c and halve it; while they are over it,
//                lower the item of smallest c and double it.
// Repaired:      a raise must fit and must have somewhere to go, a lowering too: an item that cannot move leaves the
//                heap. Nothing behind the camera is raised. Ties go to the item that comes first.
// As printed:    `as-printed=true`, for comparison; its faults are marked where they are. It need not end, hence the
//                cap.
// Complexity:    O(n + changes * log n).
// Known failure: budgets triangles, not seconds: pixels, draw calls and textures are free, so frame time drifts with
//                what is in view, and the budget is not kept. Levels that state a cost but no polygons look free and,
//                if all do, a derived budget is 0. The halving is an assumption: levels that do not halve the error are
//                ranked wrongly.
#include <algorithm>
#include <cstdint>
#include <optional>
#include <vector>

#include "policies/contribution.h"
#include "policies/level_rules.h"

namespace framesim {
namespace {

enum Start { coarsest, last_frame };

struct ContributionParameters {
  std::int64_t triangles = 0;
  int start = Start::coarsest;
  bool as_printed = false;
  std::int64_t iterations = 100'000;
};

using P = ContributionParameters;
const ParameterTable<P> kParameters{{
    {"triangles",
     &P::triangles,
     {.low = 0,
      .high = 1e12,
      .help = "budget; 0: budget in seconds over mean estimated cost per triangle of what is in view, at its finest"}},
    {"start",
     &P::start,
     {.help = "levels to start from; an item not drawn before starts at the coarsest", .words = {"coarsest", "last"}}},
    {"as-printed", &P::as_printed, {.help = "the pseudo-code with its faults instead of the repaired algorithm"}},
    {"iterations", &P::iterations, {.low = 1, .high = 1e9, .help = "as-printed only: where its loops are cut off"}},
}};

struct Entry {
  double contribution;
  std::uint32_t item;
};

// Heap orders: the standard heap keeps on top the entry that no other is "better" than.
struct LargestOnTop {
  bool operator()(const Entry& a, const Entry& b) const {
    return a.contribution != b.contribution ? a.contribution < b.contribution : a.item > b.item;
  }
};
struct SmallestOnTop {
  bool operator()(const Entry& a, const Entry& b) const {
    return a.contribution != b.contribution ? a.contribution > b.contribution : a.item > b.item;
  }
};

double triangles_of(const Workload& workload, std::size_t item, std::size_t level) {
  return primitives(workload.level_facts(item, level));
}

class ContributionPolicy : public Policy {
 public:
  explicit ContributionPolicy(const ContributionParameters& parameters) : parameters_(parameters) {}

  PolicyTraits traits() const override {
    return {.request = {.columns = Columns::cost | Columns::depth | Columns::distance | Columns::diagonal},
            .operation = "contribution computed, heap move, or level tried"};
  }

  void prepare(const PolicyScene& scene) override { last_level_.assign(scene.instances, 0); }

  void select(const FrameContext& context, Selection& selection) override {
    const Workload& workload = context.workload;
    budget_ = budget(context);
    triangles_ = 0;
    heap_.clear();
    for (std::size_t i = 0; i < workload.size(); ++i) {
      if (workload.levels(i) > 0) start(workload, i, selection);
    }
    if (parameters_.as_printed) {
      run_as_printed(workload, selection);
    } else if (triangles_ < budget_) {
      raise(workload, selection);
    } else {
      lower(workload, selection);
    }
    for (std::size_t i = 0; i < workload.size(); ++i) {
      if (workload.levels(i) > 0) last_level_[index(workload.id[i])] = selection.level[i];
    }
    finish_plan(workload, selection);
  }

 private:
  // Triangles for this frame.
  double budget(const FrameContext& context) const {
    if (parameters_.triangles > 0) return static_cast<double>(parameters_.triangles);
    const Workload& workload = context.workload;
    double cost_s = 0, triangles = 0;
    for (std::size_t i = 0; i < workload.size(); ++i) {
      if (workload.levels(i) == 0) continue;
      cost_s += workload.cost_s[workload.finest(i)];
      triangles += triangles_of(workload, i, workload.levels(i) - 1);
    }
    return cost_s > 0 ? context.budget_s * (triangles / cost_s) : 0;
  }

  // Lines 4-8 of the algorithm: an item's first level, contribution and triangles.
  void start(const Workload& workload, std::size_t i, Selection& selection) {
    std::size_t level = 0;
    if (parameters_.start == Start::last_frame) {
      const auto last = static_cast<std::size_t>(last_level_[index(workload.id[i])]);
      level = std::min(last, workload.levels(i) - 1);
    }
    draw(selection, i, level);
    triangles_ += triangles_of(workload, i, level);
    // Printed fault: the sign of the dot product is taken the wrong way round, so that everything in front counts 0.
    const bool in_front = workload.depth_m[i] > 0;
    const bool counts = parameters_.as_printed ? !in_front : in_front;
    heap_.push_back({counts ? contribution(workload, i, level) : 0.0, static_cast<std::uint32_t>(i)});
    ++selection.operations;
  }

  static double contribution(const Workload& workload, std::size_t i, std::size_t level) {
    return srgge_contribution(workload.diagonal_m[i], workload.distance_m[i], level);
  }

  // Takes the top off the heap.
  template <class Order>
  Entry pop(Selection& selection) {
    std::pop_heap(heap_.begin(), heap_.end(), Order{});
    const Entry top = heap_.back();
    heap_.pop_back();
    ++selection.operations;
    return top;
  }
  template <class Order>
  void push(const Entry& entry, Selection& selection) {
    heap_.push_back(entry);
    std::push_heap(heap_.begin(), heap_.end(), Order{});
    ++selection.operations;
  }

  void raise(const Workload& workload, Selection& selection) {
    std::make_heap(heap_.begin(), heap_.end(), LargestOnTop{});
    while (triangles_ < budget_ && !heap_.empty()) {
      const auto [contribution, i] = pop<LargestOnTop>(selection);
      if (contribution <= 0) return;  // behind the camera, and so are the rest
      const auto level = static_cast<std::size_t>(selection.level[i]);
      if (level + 1 == workload.levels(i)) continue;
      const double after = triangles_ - triangles_of(workload, i, level) + triangles_of(workload, i, level + 1);
      if (after > budget_) continue;
      triangles_ = after;
      draw(selection, i, level + 1);
      push<LargestOnTop>({contribution / 2, i}, selection);
    }
  }

  void lower(const Workload& workload, Selection& selection) {
    std::make_heap(heap_.begin(), heap_.end(), SmallestOnTop{});
    while (triangles_ > budget_ && !heap_.empty()) {
      const auto [contribution, i] = pop<SmallestOnTop>(selection);
      const auto level = static_cast<std::size_t>(selection.level[i]);
      if (level == 0) continue;
      triangles_ += triangles_of(workload, i, level - 1) - triangles_of(workload, i, level);
      draw(selection, i, level - 1);
      push<SmallestOnTop>({contribution * 2, i}, selection);
    }
  }

  // Lines 9-18 as they stand, and a cap. Levels are clamped, which the print does not do: a selection must exist.
  void run_as_printed(const Workload& workload, Selection& selection) {
    std::int64_t left = parameters_.iterations;
    std::optional<std::uint32_t> max_id;
    std::make_heap(heap_.begin(), heap_.end(), LargestOnTop{});
    for (; triangles_ < budget_ && left > 0 && !heap_.empty(); --left) {
      const auto [contribution, i] = pop<LargestOnTop>(selection);
      push<LargestOnTop>({contribution / 2, i}, selection);
      const auto level = static_cast<std::size_t>(selection.level[i]);
      // Printed fault: no end at the finest level; the index runs on while the count goes up.
      const std::size_t finer = std::min(level + 1, workload.levels(i) - 1);
      draw(selection, i, finer);
      // Printed fault: the triangles of the level that is left are not taken off.
      triangles_ += triangles_of(workload, i, finer);
      max_id = i;
    }
    if (!(triangles_ > budget_) || heap_.empty()) return;
    std::size_t min = smallest(selection);
    const std::size_t max = max_id ? find(*max_id) : heap_.size();
    for (; triangles_ > budget_ && left > 0; --left) {
      const std::uint32_t i = heap_[min].item;
      const auto level = static_cast<std::size_t>(selection.level[i]);
      // Printed fault: no end at the coarsest level; its triangles are taken off again and again.
      const std::size_t coarser = level > 0 ? level - 1 : 0;
      draw(selection, i, coarser);
      // Printed fault: the triangles of the new level are taken off, those of the old one stay.
      triangles_ -= triangles_of(workload, i, coarser);
      ++selection.operations;
      if (max == heap_.size()) continue;
      // Printed fault: maxId is doubled where minId is meant, so the minimum stays the minimum for ever, unless they
      // are one.
      const double before = heap_[max].contribution;
      heap_[max].contribution *= 2;
      if (max == min && heap_[max].contribution != before) min = smallest(selection);
    }
  }

  // Position in the heap's array of the smallest contribution, of equals the first item.
  std::size_t smallest(Selection& selection) const {
    selection.operations += static_cast<std::int64_t>(heap_.size());
    const auto better = [](const Entry& a, const Entry& b) { return SmallestOnTop{}(b, a); };
    return static_cast<std::size_t>(std::min_element(heap_.begin(), heap_.end(), better) - heap_.begin());
  }
  std::size_t find(std::uint32_t item) const {
    const auto is_it = [item](const Entry& e) { return e.item == item; };
    return static_cast<std::size_t>(std::find_if(heap_.begin(), heap_.end(), is_it) - heap_.begin());
  }

  const ContributionParameters parameters_;
  std::vector<std::int16_t> last_level_;  // of each instance: LOD(model) of the algorithm
  std::vector<Entry> heap_;
  double budget_ = 0;     // triangles
  double triangles_ = 0;  // of the levels as they stand (as printed: what the algorithm believes)
};

}  // namespace

PolicyEntry contribution_halving_policy() {
  return {.name = "contribution-halving",
          .summary = "triangle budget handed out by a heap of contributions that halve with every level (SRGGE)",
          .parameters = kParameters.describe(),
          .make = [](const Settings& settings) -> std::unique_ptr<Policy> {
            return std::make_unique<ContributionPolicy>(kParameters.read(settings));
          }};
}

}  // namespace framesim
