// The last step of a search: a few near-ties decided together so that the money left over is used.
//
// At the best multiplier every item has its choice, and most stay with it. An item may move to another one at a loss
// (of benefit - multiplier * cost) that is small near a tie. A selection falls short of the bound by exactly
//     losses of its moves + multiplier * money left over,
// so a move whose loss alone is no less than the shortfall reached so far can be ruled out, and so can any combination. What is
// left are a few states, merged group by group with the smallest losses first (Pisinger's 1995 expanding core, with the
// bound of his reduction test). Kept to `most_states` a round, so it stops short of the optimum where more would be
// needed; it never ends worse than it began.
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

namespace framesim::certified {

class Core {
 public:
  void clear();
  // One of the moves between which an item may choose; those of one group exclude each other. Groups are numbered
  // 0, 1, ... and added in that order. loss >= 0; cost_s is what the move adds (or saves, if negative).
  void add(std::uint32_t group, double cost_s, double loss, std::uint32_t payload);

  // Picks moves that cost at most `room_s` (>= 0) together and leave the least shortfall. Returns it; `picked()` are the payloads.
  // Ends as soon as it is at most `enough`.
  double solve(double room_s, double multiplier, std::size_t most_states, double enough = 0);
  const std::vector<std::uint32_t>& picked() const { return picked_; }
  std::int64_t states() const { return static_cast<std::int64_t>(states_.size()); }

 private:
  struct Move {
    double cost_s, loss;
    std::uint32_t group, payload;
  };
  struct State {
    double cost_s, loss;
    std::int32_t parent, move;
  };

  void extend(const Move* first, const Move* last, double room_s, double multiplier);
  void prune(double room_s, double multiplier, double savings_s, std::size_t most_states);

  std::vector<Move> moves_;
  std::vector<State> states_;        // all ever made, for the way back
  std::vector<std::int32_t> front_;  // those still worth extending
  std::vector<std::uint32_t> picked_;
  double best_ = 0;
  std::int32_t best_state_ = 0;
};

}  // namespace framesim::certified
