// A priority queue of items whose keys may change: the largest key first, equal keys by an explicit rule.
#pragma once

#include <cstddef>
#include <cstdint>
#include <utility>
#include <vector>

namespace framesim {

// Binary heap over items 0..n-1 with their places, so that any item can be set or erased in O(log n). Ties: the lower
// item first, or the higher with `higher_item_first`. Memory is reused; nothing is allocated below the largest n seen.
class IndexedHeap {
 public:
  explicit IndexedHeap(bool higher_item_first = false) : higher_item_first_(higher_item_first) {}

  void reset(std::size_t n) {
    heap_.clear();
    key_.resize(n);
    place_.assign(n, kAbsent);
    moves_ = 0;
  }

  bool empty() const { return heap_.empty(); }
  std::size_t top() const { return heap_.front(); }
  double key(std::size_t item) const { return key_[item]; }
  std::int64_t moves() const { return moves_; }  // entries written since reset(): the counted work

  // Inserts `item`, or moves it to where its new key belongs.
  void set(std::size_t item, double key) {
    key_[item] = key;
    if (place_[item] == kAbsent) {
      place_[item] = heap_.size();
      heap_.push_back(item);
    }
    sift_down(sift_up(place_[item]));
  }

  // Takes `item` out; nothing happens if it is not in.
  void erase(std::size_t item) {
    const std::size_t place = place_[item];
    if (place == kAbsent) return;
    place_[item] = kAbsent;
    const std::size_t last = heap_.back();
    heap_.pop_back();
    if (last == item) return;
    put(place, last);
    sift_down(sift_up(place));
  }

 private:
  static constexpr std::size_t kAbsent = static_cast<std::size_t>(-1);

  bool before(std::size_t a, std::size_t b) const {
    if (key_[a] != key_[b]) return key_[a] > key_[b];
    return higher_item_first_ ? a > b : a < b;
  }

  void put(std::size_t place, std::size_t item) {
    heap_[place] = item;
    place_[item] = place;
    ++moves_;
  }

  std::size_t sift_up(std::size_t place) {
    const std::size_t item = heap_[place];
    while (place > 0) {
      const std::size_t parent = (place - 1) / 2;
      if (!before(item, heap_[parent])) break;
      put(place, heap_[parent]);
      place = parent;
    }
    put(place, item);
    return place;
  }

  void sift_down(std::size_t place) {
    const std::size_t item = heap_[place];
    while (true) {
      std::size_t child = 2 * place + 1;
      if (child >= heap_.size()) break;
      if (child + 1 < heap_.size() && before(heap_[child + 1], heap_[child])) ++child;
      if (!before(heap_[child], item)) break;
      put(place, heap_[child]);
      place = child;
    }
    put(place, item);
  }

  bool higher_item_first_;
  std::vector<std::size_t> heap_;
  std::vector<double> key_;
  std::vector<std::size_t> place_;  // an item: its place in heap_, or kAbsent
  std::int64_t moves_ = 0;
};

}  // namespace framesim
