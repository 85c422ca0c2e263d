#include "sim/effects/residency.h"

#include <fmt/format.h>

#include "sim/check.h"

namespace framesim {

void Residency::reset(std::uint32_t keys, std::int64_t capacity_bytes) {
  FRAMESIM_CHECK(capacity_bytes >= 0, fmt::format("a memory of {} bytes", capacity_bytes));
  capacity_bytes_ = capacity_bytes;
  used_bytes_ = 0;
  end_ = keys;
  newer_.assign(keys + std::size_t{1}, end_);
  older_.assign(keys + std::size_t{1}, end_);
  bytes_.assign(keys, 0);
}

std::int64_t Residency::use(std::uint32_t key, std::int64_t bytes) {
  FRAMESIM_CHECK(key < end_ && bytes >= 0, fmt::format("resource {} of {}, {} bytes", key, end_, bytes));
  if (bytes_[key] == bytes) {
    if (bytes == 0) return 0;
    unlink(key);
    link_newest(key);
    return 0;
  }
  if (resident(key)) evict(key);
  if (bytes > capacity_bytes_) return bytes;
  while (used_bytes_ > capacity_bytes_ - bytes) evict(newer_[end_]);
  load(key, bytes);
  return bytes;
}

bool Residency::load(std::uint32_t key, std::int64_t bytes) {
  FRAMESIM_CHECK(key < end_ && bytes >= 0 && bytes_[key] == 0,
                 fmt::format("resource {} of {}, {} bytes", key, end_, bytes));
  if (used_bytes_ > capacity_bytes_ - bytes) return false;
  if (bytes == 0) return true;
  bytes_[key] = bytes;
  used_bytes_ += bytes;
  link_newest(key);
  return true;
}

void Residency::link_newest(std::uint32_t key) {
  const std::uint32_t newest = older_[end_];
  older_[key] = newest;
  newer_[key] = end_;
  newer_[newest] = key;
  older_[end_] = key;
}

void Residency::unlink(std::uint32_t key) {
  newer_[older_[key]] = newer_[key];
  older_[newer_[key]] = older_[key];
}

void Residency::evict(std::uint32_t key) {
  unlink(key);
  used_bytes_ -= bytes_[key];
  bytes_[key] = 0;
}

}  // namespace framesim
