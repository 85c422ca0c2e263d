// Time, identifiers and the few unit conversions that everything shares.
//
// Simulated time is an integer count of picoseconds: sums are exact, every platform agrees, and the range is 106 days.
// Estimated costs inside policies are doubles in seconds, because that is what the papers' formulas are written in; they
// become picoseconds at one place only (`ceil_picoseconds`).
#pragma once

#include <chrono>
#include <cstdint>
#include <ratio>

namespace framesim {

using Picoseconds = std::chrono::duration<std::int64_t, std::pico>;

// A point in simulated time, counted from the start of the run.
using SimTime = Picoseconds;

// Seconds as double, for reports and for policies: rounded to nearest up to 2^53 ps (2.5 hours). Divided, not multiplied by
// 1e-12, which no double equals.
constexpr double to_seconds(Picoseconds t) { return static_cast<double>(t.count()) / 1e12; }

// One stage of one frame may not be longer than this (a day); it keeps sums of many stages inside 64 bits.
inline constexpr Picoseconds kLongestDuration{86'400'000'000'000'000};

// Names the value: InputError for one that is too long (check.h, refuse_time), InternalError, a broken invariant, for another.
[[noreturn]] void refuse_duration(double seconds);

// `seconds` rounded up to a whole picosecond (a whole number of picoseconds written as a decimal stays that number, although
// its double may lie a hair above). Throws InternalError for a negative or NaN value, and InputError for one beyond
// `kLongestDuration`, which is what somebody's costs come to (check.h). Inline: it is called for every draw command.
inline Picoseconds ceil_picoseconds(double seconds) {
  // Not `seconds < 0`, so that a NaN fails too.
  if (!(seconds >= 0 && seconds <= to_seconds(kLongestDuration))) refuse_duration(seconds);
  // A decimal such as 3.5e-7 is off by half an ulp as a double and its product by another half: together at most 2^-52
  // of the value. What exceeds a whole number by no more than that (doubled, for one operation more) is that whole
  // number, else 350,000 ps would become 350,001.
  constexpr double kSlack = 0x1p-51;
  const double picoseconds = seconds * 1e12;
  // Not negative and far below 2^63, so that the conversion rounds down. From 2^53 on every double is whole.
  const auto below = static_cast<std::int64_t>(picoseconds);
  const bool whole = picoseconds - static_cast<double>(below) <= picoseconds * kSlack;
  return Picoseconds{whole ? below : below + 1};
}

// Index of an object type in the scene's type list.
enum class TypeId : std::uint16_t {};
// Index of an instance (or of a node of a hierarchy) in the scene; stable over the whole run.
enum class InstanceId : std::uint32_t {};

constexpr std::size_t index(TypeId id) { return static_cast<std::size_t>(id); }
constexpr std::size_t index(InstanceId id) { return static_cast<std::size_t>(id); }

}  // namespace framesim
