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

// `seconds` rounded up to a whole picosecond (a whole number of picoseconds written as a decimal stays that number, although
// its double may lie a hair above); a negative or NaN value, or one beyond `kLongestDuration`, is a broken
// invariant and throws InternalError (see check.h) naming the value.
Picoseconds ceil_picoseconds(double seconds);

// One stage of one frame may not be longer than this (a day); it keeps sums of many stages inside 64 bits.
inline constexpr Picoseconds kLongestDuration{86'400'000'000'000'000};

// Index of an object type in the scene's type list.
enum class TypeId : std::uint16_t {};
// Index of an instance (or of a node of a hierarchy) in the scene; stable over the whole run.
enum class InstanceId : std::uint32_t {};

constexpr std::size_t index(TypeId id) { return static_cast<std::size_t>(id); }
constexpr std::size_t index(InstanceId id) { return static_cast<std::size_t>(id); }

}  // namespace framesim
