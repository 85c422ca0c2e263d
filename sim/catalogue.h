// What can be drawn: object types, their levels of detail, and the facts that a machine and a benefit model need of each.
#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "sim/units.h"

namespace framesim {

// The rendering algorithm of a representation (Funkhouser and Séquin 1993, section 4): it picks the machine's
// coefficients and the exponent of the accuracy heuristic.
enum class Algorithm : std::uint8_t { flat, gouraud, textured, lines, points, splats };
inline constexpr std::size_t kAlgorithmCount = 6;
inline constexpr std::array<std::string_view, kAlgorithmCount> kAlgorithmNames = {"flat",  "gouraud", "textured",
                                                                                  "lines", "points",  "splats"};

// Which formula scores a level (see benefit.h).
enum class BenefitModel : std::uint8_t { funkhouser, zach_terrain, zach_trees };
inline constexpr std::array<std::string_view, 3> kBenefitModelNames = {"funkhouser", "zach-terrain", "zach-trees"};

// The facts of one representation, drawn once. All counts are >= 0 and finite.
struct Facts {
  double polygons = 0;  // primitives: triangles, lines, points or splats
  double vertices = 0;
  double texture_bytes = 0;
  double lines = 0;           // drawn beside the polygons, with the machine's cost of lines
  double points = 0;          // ... and of points (Robin Hood 2005, section 6 mixes all three)
  double draws = 1;           // draw calls that one command stands for (a group of 64 trees: 64)
  double coverage = 1;        // share of the item's projected area that is rasterised, 0..1
  double benefit_weight = 1;  // model-specific factor: 2^(dmax-d) of a terrain patch, number of trees of a group
  double resolution = 1;  // x of a level that stands in for a continuous representation; all counts are at x already
  Algorithm algorithm = Algorithm::gouraud;
  std::optional<double> stated_cost_s{};   // GPU time stated outright, instead of facts; > 0
  std::optional<double> stated_benefit{};  // benefit stated outright, instead of a model; >= 0
};

// How the benefit of a continuous representation grows with its resolution x in [0,1]; b(x) = b(1) * shape(x).
enum class CurveShape : std::uint8_t {
  linear,       // x
  square_root,  // sqrt(x): Zach et al. 2002, section 5.3
};
inline constexpr std::array<std::string_view, 2> kCurveShapeNames = {"linear", "square-root"};

// An object type. Exactly one of two forms:
//  - discrete: `levels` coarse to fine, at least one, at most 255; `continuous` false;
//  - continuous: `levels` holds one entry, the finest representation (x = 1); primitives scale with x.
struct ObjectType {
  std::string name;
  std::vector<Facts> levels;
  bool continuous = false;
  CurveShape shape = CurveShape::square_root;
  // Below the knee x < draws/polygons each draw call shows a single primitive and only that share of them is issued
  // (Zach et al. 2002, section 5.3: too small a group draws that share of its trees). If false, every draw is paid as soon as x > 0.
  bool draws_scale_below_knee = false;
  // Levels at x = 1/2^(n-1) .. 1/2, 1 that stand in for the curve where a policy handles discrete levels only.
  int stand_in_levels = 6;
  BenefitModel benefit = BenefitModel::funkhouser;
  double importance =
      1;  // 0..1: counts in the benefit where the effect semantics is declared, and in robin-hood's values
  double radius_m = 1;  // bounding sphere of an instance of scale 1
  double area_m2 = 1;   // un-projected area of an instance of scale 1
};

inline constexpr std::size_t kMostLevels = 255;

}  // namespace framesim
