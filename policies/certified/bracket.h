// Finds two multipliers between which the money is spent, close together, with one pass over all items where it can.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "policies/certified/level_pass.h"

namespace framesim::certified {

class BracketSearch {
 public:
  // low 0 and high 0: everything at its best fits.
  struct Found {
    bool feasible = true;  // false: the cheapest levels alone cost more than the budget
    Bracket bracket;
    PassResult pass;
    std::int64_t looked_at = 0;  // items, over all passes
  };

  void forget() { warm_ = false, width_ = drift_ = 0; }
  // A bracket with cost at low > budget_s >= cost at high (low may be 0 with cost there <= budget_s: then high is 0
  // too). Fills `level` and `open` as pass_over_all does.
  Found find(const LevelColumns& columns, double budget_s, std::span<std::int16_t> level, std::vector<OpenItem>& open);
  // Tells where in the bracket the money was spent, and how many items were open: the next frame's bracket is centred there, and
  // so wide that enough items, but not many more, are open.
  void learn(double multiplier, std::size_t open, std::size_t items);

 private:
  Bracket warm_bracket() const;
  Bracket first_bracket(Found& found) const;
  Bracket search_afresh(Found& found) const;
  Bracket search_sample(Found& found, std::size_t stride, Bracket start, double narrow) const;
  Bracket around(double multiplier, double width) const;
  bool looks_cut(Found& found) const;

  bool warm_ = false;
  double multiplier_ = 0;  // of the last frame
  double width_ = 0;       // half of a bracket, as a logarithm
  double drift_ = 0;       // how far the multiplier moves from frame to frame, as a logarithm

  const LevelColumns* columns_ = nullptr;
  double budget_s_ = 0;
};

}  // namespace framesim::certified
