// What documents and pictures read off frame records.
#pragma once

#include <algorithm>
#include <cstdint>
#include <span>

#include "sim/frame_record.h"
#include "sim/statistics.h"
#include "sim/units.h"

namespace framesim {

inline double seconds(std::int64_t picoseconds) { return to_seconds(Picoseconds(picoseconds)); }
inline double frame_time_s(const FrameRecord& record) { return seconds(record.frame_time_ps); }
inline double decision_s(const FrameRecord& record) { return seconds(record.decide_ps); }

// The frames that count: frame 0 fills the pipeline and is in no statistics.
inline std::span<const FrameRecord> measured(std::span<const FrameRecord> records) {
  return records.size() > 1 ? records.subspan(1) : records;
}
// Frames first to last, both included, as far as the run has them.
inline std::span<const FrameRecord> frames(std::span<const FrameRecord> records, std::size_t first, std::size_t last) {
  const std::size_t end = std::min(last + 1, records.size());
  return first < end ? records.subspan(first, end - first) : std::span<const FrameRecord>{};
}

// Mean and maximum of value(record); 0 if there are no records.
template <class Value>
double mean_of(std::span<const FrameRecord> records, const Value& value) {
  Moments moments;
  for (const FrameRecord& record : records) moments.add(value(record));
  return moments.mean();
}
template <class Value>
double largest_of(std::span<const FrameRecord> records, const Value& value) {
  double largest = 0;
  for (const FrameRecord& record : records) largest = std::max(largest, value(record));
  return largest;
}

}  // namespace framesim
