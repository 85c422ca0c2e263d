#include "policies/certified/core.h"

#include <algorithm>

namespace framesim::certified {

void Core::clear() { moves_.clear(); }

void Core::add(std::uint32_t group, double cost_s, double loss, std::uint32_t payload) {
  moves_.push_back({cost_s, loss, group, payload});
}

// Every state may take one of the group's moves, or none.
void Core::extend(const Move* first, const Move* last, double room_s, double multiplier) {
  const std::size_t before = front_.size();
  for (std::size_t f = 0; f < before; ++f) {
    const std::int32_t from = front_[f];
    for (const Move* move = first; move != last; ++move) {
      const State& state = states_[static_cast<std::size_t>(from)];
      const double loss = state.loss + move->loss;
      if (!(loss < best_)) continue;
      const double cost_s = state.cost_s + move->cost_s;
      const auto made = static_cast<std::int32_t>(states_.size());
      states_.push_back({cost_s, loss, from, static_cast<std::int32_t>(move - moves_.data())});
      front_.push_back(made);
      const double shortfall = loss + multiplier * (room_s - cost_s);
      if (cost_s <= room_s && shortfall < best_) {
        best_ = shortfall;
        best_state_ = made;
      }
    }
  }
}

// Drops states that cannot become the best, and of the others those that have lost most.
void Core::prune(std::size_t most_states) {
  const auto loss = [&](std::int32_t s) { return states_[static_cast<std::size_t>(s)].loss; };
  std::erase_if(front_, [&](std::int32_t s) { return !(loss(s) < best_); });
  if (front_.size() <= most_states) return;
  std::nth_element(front_.begin(), front_.begin() + static_cast<std::ptrdiff_t>(most_states), front_.end(),
                   [&](std::int32_t a, std::int32_t b) { return loss(a) != loss(b) ? loss(a) < loss(b) : a < b; });
  front_.resize(most_states);
  std::sort(front_.begin(), front_.end());  // standard libraries partition differently
}

double Core::solve(double room_s, double multiplier, std::size_t most_states, double enough) {
  states_.assign(1, {0, 0, -1, -1});
  front_.assign(1, 0);
  best_ = multiplier * room_s;
  best_state_ = 0;
  const Move* const end = moves_.data() + moves_.size();
  for (const Move* first = moves_.data(); first != end && best_ > enough;) {
    const Move* last = first;
    while (last != end && last->group == first->group) ++last;
    extend(first, last, room_s, multiplier);
    prune(most_states);
    first = last;
  }
  picked_.clear();
  for (std::int32_t s = best_state_; s > 0; s = states_[static_cast<std::size_t>(s)].parent) {
    picked_.push_back(moves_[static_cast<std::size_t>(states_[static_cast<std::size_t>(s)].move)].payload);
  }
  return best_;
}

}  // namespace framesim::certified
