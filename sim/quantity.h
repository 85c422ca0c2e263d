// Quantities as people write them: "25ms", "60fps", "1.5 us", "0.3". One parser for command line, scene file and CSV.
#pragma once

#include <optional>
#include <string>
#include <string_view>

namespace framesim {

// Why a text is not the wanted quantity, in words for the user ("'25mm' has the unknown unit 'mm'; allowed: ...").
struct QuantityResult {
  std::optional<double> value;
  std::string error;
};

// A finite number without a unit. "nan", "inf", an empty text and trailing characters are errors.
QuantityResult parse_number(std::string_view text);

// A duration in seconds. Units: ns, us, ms, s, and the rates Hz and fps (their reciprocal). A unit is required, except
// that 0 needs none. Negative durations and rates <= 0 are errors.
QuantityResult parse_duration_s(std::string_view text);

// A length in metres. Units: mm, cm, m, km; a bare number is metres.
QuantityResult parse_length_m(std::string_view text);

// An angle in radians. Units: deg, rad; required, except that 0 needs none.
QuantityResult parse_angle_rad(std::string_view text);

// The shortest text that reads back as the same duration, in the largest unit in which it is >= 1 ("12.5ms").
std::string format_duration(double seconds);

}  // namespace framesim
