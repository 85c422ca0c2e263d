#include "scenes/view_levels.h"

#include <algorithm>
#include <cmath>

namespace framesim {
namespace {

Facts with_triangles(const Facts& finest, double share) {
  Facts facts = finest;
  facts.polygons *= share;
  facts.vertices *= share;
  facts.texture_bytes *= share;
  return facts;
}

// Section 6.1: widths are tried thin to thick and a cylinder becomes a line of the first width w with its projected
// diameter below 3w/2. With w as the largest width that is every cylinder below 3w/2, and the thicker ones stay
// triangles.
Facts trunk_level(const ViewLevels& levels, const Facts& finest, double px_per_m, int width_px) {
  const auto& diameters = levels.cylinder_diameter_m;
  const double limit_m = 1.5 * width_px / px_per_m;
  const auto thick = std::lower_bound(diameters.begin(), diameters.end(), limit_m);
  const auto lines = static_cast<double>(thick - diameters.begin());
  const auto cylinders = static_cast<double>(diameters.size());
  Facts facts = with_triangles(finest, cylinders > 0 ? 1 - lines / cylinders : 1);
  facts.lines += lines;
  return facts;
}

// Section 6.2, for one group of n leaves, times the groups. A group that covers less than a point of this size still
// shows one point: a tree seen from afar keeps its crown.
Facts leaves_level(const ViewLevels& levels, const Facts& finest, double px_per_m, int width_px) {
  const double n = levels.leaves_per_group;
  const double group_px = n * levels.leaf_area_m2 / levels.facing_factor * px_per_m * px_per_m;
  const double p = std::max(1.0, std::floor(group_px / (static_cast<double>(width_px) * width_px)));
  double points = 0, triangles = n;
  if (p < n) {
    points = p;
    triangles = 0;
  } else if (p <= 2 * n) {
    points = 2 * n - p;
    triangles = n - points;
  }
  Facts facts = with_triangles(finest, n > 0 ? triangles / n : 1);
  facts.points += points * levels.groups;
  return facts;
}

}  // namespace

void append_view_levels(const ViewLevels& levels, const Facts& finest, double scale, double px_per_m,
                        std::vector<Facts>& facts) {
  const double scaled = scale * px_per_m;
  for (int width = levels.largest_px; width >= levels.smallest_px; --width) {
    facts.push_back(levels.part == ViewPart::trunk ? trunk_level(levels, finest, scaled, width)
                                                   : leaves_level(levels, finest, scaled, width));
  }
  facts.push_back(finest);
}

}  // namespace framesim
