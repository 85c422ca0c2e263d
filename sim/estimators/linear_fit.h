// The two coefficients of Dong et al. 2015, eq. 5: time = c1 * polygons + c2 * texture, from measured objects.
#pragma once

#include <optional>
#include <span>

namespace framesim {

struct LinearCosts {
  double c1 = 0;  // seconds a polygon
  double c2 = 0;  // seconds a texture byte
};

struct LinearSample {
  double time_s = 0;
  double polygons = 0;
  double texture_bytes = 0;
};

// Eq. 7 and 8: each pair of samples is solved, and the solutions are averaged. Both denominators are the determinant;
// the text above eq. 7 has one for c2 with the indices of a product mixed up, which is not. Pairs whose determinant is
// below 1e-12 of its products are skipped and not counted; nothing if that is all of them.
// Known failure: a pair that is nearly proportional divides measurement error by a small determinant, and one such pair
// spoils the mean. Coefficients may come out negative.
std::optional<LinearCosts> fit_pairs(std::span<const LinearSample> samples);

// The same equations by least squares: pairs count by how much they tell. Never negative. If textures are absent, or
// proportional to polygons, c1 carries all of the cost and c2 is 0.
LinearCosts fit_least_squares(std::span<const LinearSample> samples);

}  // namespace framesim
