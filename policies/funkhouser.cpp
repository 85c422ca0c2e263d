// funkhouser: the level of every object as a knapsack in which at most one level of each object may lie.
//
// Source:        Funkhouser and Séquin 1993, section 6. Maximise the sum of benefits with the sum of costs <= budget.
//                An (object, level) pair is a tuple; its Value is benefit / cost.
// Rules (parameter `rule`):
//   printed      All tuples by falling Value (ties: item, level). Each is added in that order; of two tuples of one
//                object the more beneficial stays. The first that does not fit ends it, since the text ends when the
//                time is claimed [R]; `misfit=skip` goes on with the next. O(levels log levels).
//   incremental  From last frame's levels (the lowest if not seen then): raise the object whose next level has the
//                highest Value, then lower those whose present level has the lowest until the sum fits; ends when one
//                object is raised and lowered in one round. O(log n) a round, few rounds from one frame to the next.
//                With Values that fall from level to level it ends where `printed` does. Not proven to end otherwise,
//                so rounds are capped at 4 * levels + 16; with concave benefits the cap is not reached.
//   repaired     From scratch on each object's upper concave hull (knapsack/hull_greedy.h): upgrades by falling gain /
//                extra cost, misfits skipped, the best single upgrade compared, what is left given to any level that
//                fits. At least half of the optimum. O(levels + n log n).
//   stop-at-misfit  The same upgrades until the first that does not fit, and nothing after it, as renderers do [M]:
//                with misfits skipped, what small upgrades find left over changes with every step of the camera, and
//                their levels with it. What is drawn is the first part of one sequence: as long as the same objects
//                must be drawn, more budget lowers no level. No bound from below: one dear upgrade ends it for all.
// Omitting:      with `none=true` "not drawn" is a level like others. Otherwise every object gets at least its coarsest
//                level (on hulls: its cheapest) if these fit together; if not, objects may be left out in that frame.
// Known failure: `printed` and `incremental` have no bound: A = {(9,14),(12,18)}, B = {(36,81)} as (cost, benefit) and
//                budget 20 draw nothing, because B is first and does not fit, where A alone gives 18.
#include <algorithm>
#include <utility>

#include "policies/knapsack/hull_greedy.h"
#include "policies/level_rules.h"
#include "sim/statistics.h"

namespace framesim {
namespace {

enum Rule { kRepaired, kIncremental, kPrinted, kStopAtMisfit };
enum Misfit { kStop, kSkip };

struct FunkhouserParameters {
  int rule = kRepaired;
  int misfit = kStop;
  bool none = false;
};

const ParameterTable<FunkhouserParameters> kParameters{{
    {"rule",
     &FunkhouserParameters::rule,
     {.help = "greedy on upper hulls with a guarantee, the paper's incremental rule, its rule from scratch, or the "
              "upper hulls until the first misfit",
      .words = {"repaired", "incremental", "printed", "stop-at-misfit"}}},
    {"misfit",
     &FunkhouserParameters::misfit,
     {.help = "rule=printed: what the first tuple that does not fit does", .words = {"stop", "skip"}}},
    {"none",
     &FunkhouserParameters::none,
     {.help = "not drawn is a level like others; false only leaves out what not even the coarsest levels allow"}},
}};

class FunkhouserPolicy : public Policy {
 public:
  explicit FunkhouserPolicy(const FunkhouserParameters& parameters) : parameters_(parameters) {}

  PolicyTraits traits() const override {
    return {.request = {.columns = Columns::cost},
            .keeps_budget = true,
            .may_omit = true,
            .operation = "tuple looked at, heap entry moved or level changed"};
  }

  void prepare(const PolicyScene& scene) override {
    last_level_.assign(scene.instances, kNotDrawn);
    last_frame_.assign(scene.instances, kNever);
  }

  void select(const FrameContext& context, Selection& selection) override {
    choice_ = LevelChoice(context.workload, context.budget_s, selection);
    switch (parameters_.rule) {
      case kRepaired:
      case kStopAtMisfit:
        select_on_hulls(selection);
        break;
      case kIncremental:
        select_incremental(context.frame);
        break;
      default:
        select_printed();
    }
    finish_plan(context.workload, selection);
  }

 private:
  static constexpr std::int64_t kNever = -2;  // no frame follows it

  struct Tuple {
    double value;
    std::uint32_t item;
    std::int32_t level;
  };

  double value(std::size_t item, int level) const { return choice_.benefit(item, level) / choice_.cost_s(item, level); }

  bool on_hulls() const { return parameters_.rule == kRepaired || parameters_.rule == kStopAtMisfit; }

  // The coarsest level; on hulls the one that costs least (of equals the most beneficial, then the coarsest).
  int lowest_level(std::size_t item) const {
    int lowest = 0;
    if (!on_hulls()) return lowest;
    for (int l = 1; l < choice_.levels(item); ++l) {
      const std::pair candidate{choice_.cost_s(item, l), -choice_.benefit(item, l)};
      if (candidate < std::pair{choice_.cost_s(item, lowest), -choice_.benefit(item, lowest)}) lowest = l;
    }
    return lowest;
  }

  // Must every object be drawn in this frame?
  bool all_drawn() {
    if (parameters_.none) return false;
    CompensatedSum sum;
    for (std::size_t i = 0; i < choice_.size(); ++i) {
      if (choice_.levels(i) > 0) sum.add(choice_.cost_s(i, lowest_level(i)));
    }
    choice_.count(static_cast<std::int64_t>(choice_.size()));
    return sum.value() <= choice_.budget_s();
  }

  void draw_lowest() {
    for (std::size_t i = 0; i < choice_.size(); ++i) {
      if (choice_.levels(i) > 0) choice_.change(i, lowest_level(i));
    }
  }

  void select_on_hulls(Selection& selection) {
    const bool everything = all_drawn();
    if (everything) draw_lowest();
    const double bound =
        parameters_.rule == kStopAtMisfit ? hull_greedy_.improve_until_misfit(choice_) : hull_greedy_.improve(choice_);
    // A bound on those who draw everything would be none for those who may omit.
    if (!everything) selection.bound = std::max(bound, selected_benefit(choice_.workload(), selection));
  }

  void select_printed() {
    tuples_.clear();
    for (std::size_t i = 0; i < choice_.size(); ++i) {
      for (int l = 0; l < choice_.levels(i); ++l) tuples_.push_back({value(i, l), static_cast<std::uint32_t>(i), l});
    }
    std::sort(tuples_.begin(), tuples_.end(), [](const Tuple& a, const Tuple& b) {
      if (a.value != b.value) return a.value > b.value;
      return std::pair{a.item, a.level} < std::pair{b.item, b.level};
    });
    if (all_drawn()) draw_lowest();
    choice_.count(static_cast<std::int64_t>(tuples_.size()));
    for (const auto& [unused, item, level] : tuples_) {
      const int present = choice_.level(item);
      choice_.count(1);
      if (present != kNotDrawn && choice_.benefit(item, level) <= choice_.benefit(item, present)) continue;
      if (choice_.fits(item, level)) {
        choice_.change(item, level);
      } else if (parameters_.misfit == kStop) {
        break;
      }
    }
  }

  void select_incremental(std::int64_t frame) {
    raise_.reset(choice_.size());
    lower_.reset(choice_.size());
    floor_ = all_drawn() ? 0 : kNotDrawn;
    start_from_last_frame(frame);
    for (std::size_t rounds = 4 * choice_.workload().cost_s.size() + 16; rounds > 0 && raise_and_lower();) --rounds;
    choice_.count(raise_.moves() + lower_.moves());
    for (std::size_t i = 0; i < choice_.size(); ++i) {
      const std::size_t id = index(choice_.workload().id[i]);
      last_level_[id] = static_cast<std::int16_t>(choice_.level(i));
      last_frame_[id] = frame;
    }
  }

  void start_from_last_frame(std::int64_t frame) {
    for (std::size_t i = 0; i < choice_.size(); ++i) {
      if (choice_.levels(i) == 0) continue;
      const std::size_t id = index(choice_.workload().id[i]);
      const int last = last_frame_[id] == frame - 1 ? last_level_[id] : floor_;
      move_to(i, std::clamp(last, floor_, choice_.levels(i) - 1));
    }
  }

  void move_to(std::size_t item, int level) {
    choice_.change(item, level);
    if (level + 1 < choice_.levels(item)) {
      raise_.set(item, value(item, level + 1));
    } else {
      raise_.erase(item);
    }
    if (level > floor_) {
      lower_.set(item, -value(item, level));
    } else {
      lower_.erase(item);
    }
  }

  // One round: raises one object, lowers until the sum fits. False when the rule ends.
  bool raise_and_lower() {
    const bool raises = !raise_.empty();
    const std::size_t raised = raises ? raise_.top() : 0;
    if (raises) move_to(raised, choice_.level(raised) + 1);
    bool lowers = false, same = false;
    while (choice_.over_budget() && !lower_.empty()) {
      const std::size_t item = lower_.top();
      move_to(item, choice_.level(item) - 1);
      lowers = true;
      same = same || (raises && item == raised);
    }
    return !same && (raises || lowers);
  }

  const FunkhouserParameters parameters_;
  std::vector<std::int16_t> last_level_;  // an instance: its level in the last frame it was visible
  std::vector<std::int64_t> last_frame_;  // ... and that frame
  LevelChoice choice_;                    // of the frame at hand
  HullGreedy hull_greedy_;
  std::vector<Tuple> tuples_;
  int floor_ = kNotDrawn;    // rule=incremental: no object goes below this level in this frame
  IndexedHeap raise_;        // ... objects by the Value of their next level
  IndexedHeap lower_{true};  // ... by that of their present one; the last in the order of raising is the first to fall
};

}  // namespace

PolicyEntry funkhouser_policy() {
  return {
      .name = "funkhouser",
      .summary = "greedy multiple-choice knapsack on benefit over cost, as printed, incremental or with a guarantee",
      .parameters = kParameters.describe(),
      .make = [](const Settings& settings) -> std::unique_ptr<Policy> {
        return std::make_unique<FunkhouserPolicy>(kParameters.read(settings));
      }};
}

}  // namespace framesim
