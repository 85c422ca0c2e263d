// What lies in a memory of limited size: least-recently-used residency of numbered resources.
//
// Keys are dense, so that the order of use is a doubly linked list threaded through flat arrays: every operation takes
// constant time (a miss, the time of what it evicts), nothing is hashed, and after `reset` nothing is allocated.
#pragma once

#include <cstdint>
#include <vector>

namespace framesim {

class Residency {
 public:
  // Empties the memory and takes keys 0 .. keys-1. `capacity_bytes` >= 0.
  void reset(std::uint32_t keys, std::int64_t capacity_bytes);

  // Resource `key`, now of that size, is needed: bytes that must be moved into the memory first.
  //  - it is resident with that size: 0, and it becomes the most recently used;
  //  - it is not: `bytes`; the least recently used ones go until it fits. Of another size it is another content: the
  //    old one goes first;
  //  - larger than the whole memory: `bytes` each time, it passes through, and nothing else has to go for it.
  // What has no bytes needs no memory: 0.
  std::int64_t use(std::uint32_t key, std::int64_t bytes);

  // Puts it in as the most recently used, if it fits without evicting anything; false if not.
  bool load(std::uint32_t key, std::int64_t bytes);

  bool resident(std::uint32_t key) const { return bytes_[key] > 0; }
  std::int64_t used_bytes() const { return used_bytes_; }
  std::int64_t capacity_bytes() const { return capacity_bytes_; }

 private:
  void link_newest(std::uint32_t key);
  void unlink(std::uint32_t key);
  void evict(std::uint32_t key);

  std::int64_t capacity_bytes_ = 0, used_bytes_ = 0;
  std::uint32_t end_ = 0;                     // number of keys; as a node, the ring's head: newer_[end_] is the oldest
  std::vector<std::uint32_t> newer_, older_;  // neighbours in the order of use
  std::vector<std::int64_t> bytes_;           // 0: not resident
};

}  // namespace framesim
