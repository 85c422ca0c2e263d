// A scene in memory: what a scene file (scene_file.h) describes, after its generators have run. Lengths in metres, angles
// in radians, right-handed, y up.
#pragma once

#include <cstdint>
#include <glm/vec3.hpp>
#include <string>
#include <vector>

#include "sim/machine.h"
#include "sim/parameters.h"
#include "sim/stage_graph.h"
#include "sim/workload.h"

namespace framesim {

struct Pose {
  glm::dvec3 eye{0};
  glm::dvec3 forward{0, 0, -1};  // unit length
  glm::dvec3 up{0, 1, 0};        // unit length, orthogonal to forward
};

struct Screen {
  int width = 1280;
  int height = 720;
  double fov_y_rad = 1.0471975511965976;  // 60 degrees
  double near_m = 0.1;
  double far_m = 10'000;
};

// Representations of a tree part that depend on the view (Robin Hood 2005, section 6): level 0 uses lines or points of
// `largest_px`, the level before the finest those of `smallest_px`, the finest is all triangles.
enum class ViewPart : std::uint8_t { none, trunk, leaves };
struct ViewLevels {
  ViewPart part = ViewPart::none;
  int smallest_px = 1;
  int largest_px = 20;
  std::vector<double> cylinder_diameter_m;  // trunk: ascending
  double triangles_per_cylinder = 10;       // trunk
  double groups = 12;                       // leaves
  double leaves_per_group = 40;             // leaves, one triangle each
  double leaf_area_m2 = 0.01;               // leaves: average, before facing_factor
  double facing_factor = 2;                 // leaves: divides the area, for leaves seen at an angle
};

inline constexpr std::uint16_t kNoCell = 0xffff;

// Instances as columns. In a scene with a tree the rows are its nodes in preorder (inner nodes too) and `subtree_end` is
// filled; otherwise it is empty.
struct Instances {
  std::vector<glm::dvec3> centre;  // of the bounding sphere
  std::vector<float> radius_m;     // of the bounding sphere, scale applied
  std::vector<float> area_m2;      // un-projected, scale applied
  std::vector<TypeId> type;
  std::vector<ItemKind> kind;
  std::vector<std::uint16_t> cell;  // indoor scenes: the cell it stands in; else kNoCell. Empty if no cells
  std::vector<std::uint32_t> subtree_end;
  std::size_t size() const { return centre.size(); }
};

// Axis-aligned box.
struct Box {
  glm::dvec3 low{0}, high{0};
};

// Indoor scenes: convex cells joined by convex portals. An instance is potentially visible from a cell if a sequence of
// portals leads to its cell and the view cone through them meets it.
struct Cell {
  std::string name;
  Box box;
};
struct Portal {
  std::uint16_t from = 0, to = 0;   // both ways
  std::vector<glm::dvec3> corners;  // convex polygon, at least 3
};

// Tile museums: for each cell, the cells that a random sample of sight lines reached (SRGGE 2020, section 2).
struct CellVisibility {
  std::vector<std::vector<std::uint16_t>> seen;  // a cell: ascending cells, itself included
  int samples = 0;                               // sight lines a cell that it was made with
};

enum class VisibilityMethod : std::uint8_t { frustum, portals, cells };

struct SceneCamera {
  std::string name;
  std::vector<Pose> poses;  // one a frame
};

// What a scene file may ask for, since a few bytes of it can ask for anything. The user's, not the file's, to raise.
struct SceneLimits {
  // Instances, generated ones included. Everything else that grows by a number in the file is bounded by it too: a
  // generator's grid has at most kSamplesPerInstance times as many samples or sight lines.
  std::size_t instances = 4'000'000;
  bool outside_paths = false;  // files that the scene file names may lie outside of its folder
};
inline constexpr std::size_t kSamplesPerInstance = 16;

struct Scene {
  SceneLimits limits;  // that it was read within
  std::string name, title, source, assumptions;
  std::vector<ObjectType> types;
  std::vector<ViewLevels> view_levels;  // one a type
  Instances instances;
  std::vector<Cell> cells;
  std::vector<Portal> portals;
  CellVisibility cell_visibility;
  VisibilityMethod visibility = VisibilityMethod::frustum;
  // Items whose bounding sphere covers fewer pixels are not put in the workload (Zach et al. 2002, small detail culling); 0 = off.
  double smallest_px = 0;
  // Where a policy takes no hierarchy, terrain is presented as blocks at this depth, with uniform refinement as levels.
  int flat_depth = 3;
  Screen screen;
  SceneCamera camera;
  MachineProfile machine;
  LogicLoad logic;
  std::vector<Spec> effects;
  std::vector<double> targets_s;  // the targets that `compare` uses by default, at least one
};

}  // namespace framesim
