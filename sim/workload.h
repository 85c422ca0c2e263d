// PORT: the visible workload of one frame, as flat columns, and the source that fills it.
//
// An *item* is something that the policy decides about: a visible instance, a terrain patch, a group of trees. Columns
// run over items in ascending id. The levels of all items lie in one run, coarse to fine; item i owns
// [level_begin[i], level_begin[i+1]). Vectors are reused from frame to frame: in steady state nothing is allocated.
//
// Three kinds of item, because the sources need all three:
//  - levels: one of n discrete levels is drawn, or none;
//  - curve:  a resolution x in [0,1]; cost is piecewise linear in x, benefit is concave (`curve_cost_s`, `curve_benefit`).
//            Its level run has one entry, for x = 1;
//  - bundle: no representation of its own, only groups the items of its subtree (an inner node of a tree of groups).
//            Its level run is empty.
// With a hierarchy the items are in preorder and `subtree_end` gives each subtree: the children of i are i+1, then
// subtree_end[i+1], and so on while < subtree_end[i]. A `levels` item with children is drawn *instead of* its whole
// subtree: what is drawn must be a cut. Without a hierarchy `subtree_end` is empty.
#pragma once

#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include "sim/catalogue.h"
#include "sim/units.h"

namespace framesim {

enum class ItemKind : std::uint8_t { levels, curve, bundle };

// Columns that a policy may ask for; only those are computed. `id`, `type`, `kind`, levels, benefit and projected area are
// always there, because records and machine need them.
enum class Columns : std::uint32_t {
  none = 0,
  cost = 1u << 0,        // cost_s, curve_setup_s
  depth = 1u << 1,       // depth_m
  distance = 1u << 2,    // distance_m
  view_angle = 1u << 3,  // view_angle_rad
  area = 1u << 4,        // area_m2
  diagonal = 1u << 5,    // diagonal_m
  all = 0x3f,
};
constexpr Columns operator|(Columns a, Columns b) {
  return static_cast<Columns>(static_cast<std::uint32_t>(a) | static_cast<std::uint32_t>(b));
}
constexpr bool has(Columns set, Columns column) {
  return (static_cast<std::uint32_t>(set) & static_cast<std::uint32_t>(column)) != 0;
}

struct Workload {
  // Of the scene, set once.
  std::span<const ObjectType> types;
  double screen_px = 0;  // pixels of the whole screen

  // One entry an item.
  std::vector<InstanceId> id;  // ascending, unique
  std::vector<TypeId> type;
  std::vector<ItemKind> kind;
  std::vector<double> projected_area_px;   // of the bounding sphere, 0 (behind the camera) .. screen_px
  std::vector<double> depth_m;             // along the view direction; may be <= 0
  std::vector<double> distance_m;          // from the eye to the centre, >= 0
  std::vector<double> view_angle_rad;      // between view direction and the line to the centre, 0..pi
  std::vector<double> area_m2;             // un-projected area
  std::vector<double> diagonal_m;          // diagonal of the bounding box
  std::vector<std::uint32_t> facts_begin;  // facts of level l of item i: facts[facts_begin[i] + l]
  std::vector<std::uint32_t> level_begin;  // size() + 1 entries
  std::vector<std::uint32_t> subtree_end;  // size() entries with a hierarchy, else empty

  // One entry a level (of all items).
  std::vector<double> cost_s;   // estimated, > 0: filled by the estimator
  std::vector<double> benefit;  // >= 0: filled by the benefit model

  // One entry an item, meaningful for curves only; filled by the estimator.
  std::vector<double> curve_setup_s;  // part of cost_s that is paid for the draw calls, 0..cost_s
  std::vector<double> curve_knee;     // resolution below which setup shrinks with x; 0 = all of it from the first x > 0

  // Facts: first those of all types (constant over the run), then those made for this frame (representations that depend
  // on the view). `static_facts` is the length of the first part.
  std::vector<Facts> facts;
  std::uint32_t static_facts = 0;

  std::size_t size() const { return id.size(); }
  bool hierarchical() const { return !subtree_end.empty(); }
  std::size_t levels(std::size_t item) const { return level_begin[item + 1] - level_begin[item]; }
  std::size_t finest(std::size_t item) const { return level_begin[item + 1] - 1; }  // index into the level columns
  const Facts& level_facts(std::size_t item, std::size_t level) const { return facts[facts_begin[item] + level]; }
  const ObjectType& type_of(std::size_t item) const { return types[index(type[item])]; }

  // Empties the columns and drops this frame's facts; keeps all capacity.
  void clear();
  // Exact size in bytes of all columns' capacity, for the memory report.
  std::size_t capacity_bytes() const;
};

// Estimated cost in seconds of curve item i at resolution x in [0,1]; 0 at x = 0. Zach et al. 2002, section 5.3, with
// the setup of too small a group scaled down below the knee.
double curve_cost_s(const Workload& workload, std::size_t item, double x);
// Benefit of curve item i at resolution x in [0,1]; 0 at x = 0, increasing and concave.
double curve_benefit(const Workload& workload, std::size_t item, double x);
// Their derivatives with respect to x, at x in (0,1] (one-sided at the knee, from above). benefit' may be large near 0.
double curve_cost_slope_s(const Workload& workload, std::size_t item, double x);
double curve_benefit_slope(const Workload& workload, std::size_t item, double x);
// The largest x in [0,1] whose cost is <= cost_s; 0 if not even the first primitive fits.
double curve_resolution(const Workload& workload, std::size_t item, double cost_s);

// What the policy can take. A source must present curves as stand-in levels where `curves` is false, and a flat list where
// `hierarchy` is false.
struct WorkloadRequest {
  bool curves = false;
  bool hierarchy = false;
  Columns columns = Columns::all;
};

// What visibility cost in this frame.
struct VisibilityCounts {
  std::int64_t tests = 0;    // bounds tested against frustum or portals
  std::int64_t visible = 0;  // items in the workload, bundles not counted
};

// What is known of a scene before its first frame.
struct SceneFacts {
  std::string name;
  std::vector<ObjectType> types;
  std::size_t instances = 0;  // ids are 0 .. instances-1
  std::int64_t frames = 0;    // length of the camera path
  double screen_px = 0;
  double focal_px = 0;           // pixels from the eye to the screen; 0 = not known
  double full_detail_facts = 0;  // polygons of the whole scene at its finest levels, for reports
  bool single_level = false;     // whatever the request and the frame, no item has two levels to choose from
  bool fixed_facts = false;  // whatever the request and the frame, all facts are static ones (Workload::static_facts)
};

// Fills the workload of any frame of a scene. Implemented in scenes/.
class WorkloadSource {
 public:
  virtual ~WorkloadSource() = default;
  virtual const SceneFacts& scene() const = 0;
  // Fills `workload` (all columns but cost_s, benefit, curve_setup_s, curve_knee, which estimator and benefit model fill;
  // those are sized) for frame 0..frames-1. The same frame and request give the same bits, in any order of calls.
  virtual VisibilityCounts fill(std::int64_t frame, const WorkloadRequest& request, Workload& workload) = 0;
};

}  // namespace framesim
