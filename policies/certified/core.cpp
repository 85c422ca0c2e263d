#include "policies/certified/core.h"

#include <algorithm>
#include <limits>

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

// Drops states that cannot become the best: those that have lost too much, those too dear for what later groups can
// save, and those that cost no less than another and are worth no more. Of the rest, those that have lost most.
void Core::prune(double room_s, double multiplier, double savings_s, std::size_t most_states) {
  const auto state = [&](std::int32_t s) -> const State& { return states_[static_cast<std::size_t>(s)]; };
  std::erase_if(front_,
                [&](std::int32_t s) { return !(state(s).loss < best_) || state(s).cost_s - savings_s > room_s; });
  std::sort(front_.begin(), front_.end(), [&](std::int32_t a, std::int32_t b) {
    if (state(a).cost_s != state(b).cost_s) return state(a).cost_s < state(b).cost_s;
    return state(a).loss != state(b).loss ? state(a).loss < state(b).loss : a < b;
  });
  double most = -std::numeric_limits<double>::infinity();
  std::erase_if(front_, [&](std::int32_t s) {
    const double worth = multiplier * state(s).cost_s - state(s).loss;
    if (!(worth > most)) return true;
    most = worth;
    return false;
  });
  if (front_.size() <= most_states) return;
  std::sort(front_.begin(), front_.end(), [&](std::int32_t a, std::int32_t b) {
    return state(a).loss != state(b).loss ? state(a).loss < state(b).loss : a < b;
  });
  front_.resize(most_states);
}

double Core::solve(double room_s, double multiplier, std::size_t most_states, double enough) {
  states_.assign(1, {0, 0, -1, -1});
  front_.assign(1, 0);
  best_ = multiplier * room_s;
  best_state_ = 0;
  const Move* const end = moves_.data() + moves_.size();
  double savings_s = 0;  // by all moves to come: no less than any choice of them saves
  for (const Move& move : moves_) savings_s += std::max(-move.cost_s, 0.0);
  for (const Move* first = moves_.data(); first != end && best_ > enough;) {
    const Move* last = first;
    for (; last != end && last->group == first->group; ++last) savings_s -= std::max(-last->cost_s, 0.0);
    extend(first, last, room_s, multiplier);
    prune(room_s, multiplier, std::max(savings_s, 0.0) * (1 + 1e-9), most_states);
    first = last;
  }
  picked_.clear();
  for (std::int32_t s = best_state_; s > 0; s = states_[static_cast<std::size_t>(s)].parent) {
    picked_.push_back(moves_[static_cast<std::size_t>(states_[static_cast<std::size_t>(s)].move)].payload);
  }
  return best_;
}

}  // namespace framesim::certified
