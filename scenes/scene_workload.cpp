// One frame's workload: visibility gives rows, rows become items. Three presentations of the same rows:
//  - a flat scene: one item a row;
//  - a tree, for policies that take hierarchies: the visible nodes in preorder;
//  - a tree, for the others: bundles dropped, continuous leaves listed, trees of levels as blocks (flat_blocks.h).
// Continuous types become stand-in levels where the policy takes none. O(visible) a frame; every vector is reused.
#include "scenes/scene_workload.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>

#include "scenes/flat_blocks.h"
#include "scenes/item_writer.h"
#include "scenes/view_levels.h"
#include "scenes/visibility.h"

namespace framesim {
namespace {

Facts stand_in(const ObjectType& type, double x) {
  const Facts& finest = type.levels.back();
  Facts facts = finest;
  facts.polygons *= x;
  facts.vertices *= x;
  facts.texture_bytes *= x;
  facts.lines *= x;
  facts.points *= x;
  facts.coverage *= x;
  facts.draws = draws_issued(finest, x, type.draws_scale_below_knee);
  facts.resolution = x;
  if (finest.stated_cost_s) facts.stated_cost_s = *finest.stated_cost_s * x;
  if (finest.stated_benefit) {
    facts.stated_benefit = *finest.stated_benefit * (type.shape == CurveShape::linear ? x : std::sqrt(x));
  }
  return facts;
}

// What a frame needs of one instance, side by side: where only a few of many are visible, each costs a cache line or
// two, and not one in every column of the scene.
struct Row {
  glm::dvec3 centre{0};
  float radius_m = 0, area_m2 = 0;
  TypeId type{};
  ItemKind kind = ItemKind::levels;
};

std::vector<Row> pack(const Instances& instances) {
  std::vector<Row> rows;
  rows.reserve(instances.size());
  for (std::size_t i = 0; i < instances.size(); ++i) {
    rows.push_back({.centre = instances.centre[i],
                    .radius_m = instances.radius_m[i],
                    .area_m2 = instances.area_m2[i],
                    .type = instances.type[i],
                    .kind = instances.kind[i]});
  }
  return rows;
}

class SceneWorkload final : public WorkloadSource {
 public:
  explicit SceneWorkload(const Scene& scene)
      : scene_(scene),
        visibility_(make_visibility(scene)),
        instances_(pack(scene.instances)),
        depths_(level_tree_depths(scene.instances)) {
    focal_px_ = focal_length_px(scene.screen);
    facts_.name = scene.name;
    facts_.types = scene.types;
    facts_.instances = scene.instances.size();
    facts_.frames = static_cast<std::int64_t>(scene.camera.poses.size());
    facts_.screen_px = static_cast<double>(scene.screen.width) * scene.screen.height;
    facts_.focal_px = focal_px_;
    for (std::size_t t = 0; t < scene.types.size(); ++t) add_static_facts(t);
    facts_.full_detail_facts = count_polygons();
    facts_.single_level = is_single_level();
    facts_.fixed_facts = has_fixed_facts();
  }

  const SceneFacts& scene() const override { return facts_; }

  VisibilityCounts fill(std::int64_t frame, const WorkloadRequest& request, Workload& workload) override {
    FRAMESIM_CHECK(frame >= 0 && frame < facts_.frames, fmt::format("frame {} of {}", frame, facts_.frames));
    pose_ = &scene_.camera.poses[static_cast<std::size_t>(frame)];
    request_ = request;
    VisibilityCounts counts;
    counts.tests = visibility_->find(*pose_, rows_);
    const bool tree = !scene_.instances.subtree_end.empty();
    begin(workload);
    items_.begin(workload, request.columns, tree && request.hierarchy);
    if (!tree) {
      fill_flat(workload);
    } else if (request.hierarchy) {
      fill_tree(workload);
    } else {
      fill_blocks(workload);
    }
    items_.finish();
    counts.visible = items_.size() - items_.bundles();
    return counts;
  }

 private:
  // Where the facts of a type begin in static_facts_, and its stand-in levels, if it is continuous; how many they are.
  struct TypeFacts {
    std::uint32_t levels = 0, stand_ins = 0;
    std::uint32_t level_count = 0, stand_in_count = 0;
    ViewPart view = ViewPart::none;
    bool continuous = false;
  };

  void add_static_facts(std::size_t t) {
    ObjectType& type = facts_.types[t];
    TypeFacts places{.levels = static_cast<std::uint32_t>(static_facts_.size())};
    if (t < scene_.view_levels.size()) places.view = scene_.view_levels[t].part;
    static_facts_.insert(static_facts_.end(), type.levels.begin(), type.levels.end());
    places.stand_ins = static_cast<std::uint32_t>(static_facts_.size());
    if (places.view != ViewPart::none) type.continuous = false;
    places.level_count = static_cast<std::uint32_t>(type.levels.size());
    places.stand_in_count = static_cast<std::uint32_t>(std::max(1, type.stand_in_levels));
    places.continuous = type.continuous;
    if (type.continuous) {
      for (int i = type.stand_in_levels - 1; i >= 1; --i) {
        static_facts_.push_back(stand_in(type, std::ldexp(1.0, -i)));
      }
      static_facts_.push_back(type.levels.back());
    }
    type_facts_.push_back(places);
  }

  // Everything at its finest: of a tree of levels, its leaves.
  double count_polygons() const {
    const Instances& rows = scene_.instances;
    double polygons = 0;
    for (std::size_t row = 0; row < rows.size(); ++row) {
      const bool inner = !rows.subtree_end.empty() && rows.subtree_end[row] > row + 1;
      if (!inner && rows.kind[row] != ItemKind::bundle) polygons += finest(row).polygons;
    }
    return polygons;
  }

  // A tree may be presented as blocks, and a block has a level a cut.
  bool is_single_level() const {
    bool single = scene_.instances.subtree_end.empty();
    for (std::size_t t = 0; t < facts_.types.size(); ++t) {
      const ObjectType& type = facts_.types[t];
      single = single && type.levels.size() == 1 && type_facts_[t].view == ViewPart::none &&
               !(type.continuous && type.stand_in_levels > 1);
    }
    return single;
  }

  // A tree may be presented as blocks, whose facts are made for each frame.
  bool has_fixed_facts() const {
    return scene_.instances.subtree_end.empty() &&
           std::all_of(type_facts_.begin(), type_facts_.end(),
                       [](const TypeFacts& t) { return t.view == ViewPart::none; });
  }

  const Facts& finest(std::size_t row) const { return scene_.types[index(instances_[row].type)].levels.back(); }

  Sight look_at(std::uint32_t row) const {
    const Row& instance = instances_[row];
    const glm::dvec3 line = instance.centre - pose_->eye;
    Sight sight{.depth_m = glm::dot(line, pose_->forward), .distance_m = glm::length(line)};
    sight.area_px = projected_area_px(static_cast<double>(instance.radius_m), sight.distance_m, sight.depth_m,
                                      focal_px_, facts_.screen_px);
    return sight;
  }

  // Small detail culling (Zach et al. 2002, section 5.3).
  bool too_small(const Sight& sight) const { return sight.area_px < scene_.smallest_px; }

  void begin(Workload& workload) const {
    workload.types = facts_.types;
    workload.screen_px = facts_.screen_px;
    workload.facts.assign(static_facts_.begin(), static_facts_.end());
    workload.static_facts = static_cast<std::uint32_t>(static_facts_.size());
  }

  void add_item(std::uint32_t row, const Sight& sight, ItemKind kind, std::uint32_t facts_begin, std::size_t levels) {
    items_.add({.id = InstanceId{row},
                .type = instances_[row].type,
                .kind = kind,
                .facts_begin = facts_begin,
                .levels = static_cast<std::uint32_t>(levels),
                .area_m2 = static_cast<double>(instances_[row].area_m2),
                .radius_m = static_cast<double>(instances_[row].radius_m)},
               sight);
  }

  // The row as it is: bundle, curve, stand-ins, levels, or levels made for this view.
  void add_row(Workload& workload, std::uint32_t row, const Sight& sight) {
    const TypeId type = instances_[row].type;
    const TypeFacts& places = type_facts_[index(type)];
    if (instances_[row].kind == ItemKind::bundle) {
      add_item(row, sight, ItemKind::bundle, places.levels, 0);
    } else if (places.view != ViewPart::none) {
      add_view_row(workload, row, sight, scene_.view_levels[index(type)]);
    } else if (!places.continuous) {
      add_item(row, sight, ItemKind::levels, places.levels, places.level_count);
    } else if (request_.curves) {
      add_item(row, sight, ItemKind::curve, places.levels, 1);
    } else {
      add_item(row, sight, ItemKind::levels, places.stand_ins, places.stand_in_count);
    }
  }

  void add_view_row(Workload& workload, std::uint32_t row, const Sight& sight, const ViewLevels& levels) {
    const auto begin_at = static_cast<std::uint32_t>(workload.facts.size());
    const double type_radius_m = scene_.types[index(instances_[row].type)].radius_m;
    const double scale = static_cast<double>(instances_[row].radius_m) / type_radius_m;
    // Nothing is nearer than the near plane, so the scale stays finite for an eye in the crown.
    const double px_per_m = focal_px_ / std::max(sight.distance_m, scene_.screen.near_m);
    append_view_levels(levels, finest(row), scale, px_per_m, workload.facts);
    add_item(row, sight, ItemKind::levels, begin_at, view_level_count(levels));
  }

  void fill_flat(Workload& workload) {
    for (const std::uint32_t row : rows_) {
      const Sight sight = look_at(row);
      if (!too_small(sight)) add_row(workload, row, sight);
    }
  }

  // Visible nodes in preorder. A bundle that has nothing left below it is taken out again: it is the last item then.
  // Nodes of a tree of levels are never culled as too small: that would tear holes into the terrain.
  void fill_tree(Workload& workload) {
    open_.clear();
    for (const std::uint32_t row : rows_) {
      close_nodes(row);
      const Sight sight = look_at(row);
      if (instances_[row].kind == ItemKind::curve && too_small(sight)) continue;
      open_.push_back({row, items_.size()});
      add_row(workload, row, sight);
    }
    close_nodes(static_cast<std::uint32_t>(scene_.instances.size()));
  }

  // Ends the subtrees that do not hold `row`.
  void close_nodes(std::uint32_t row) {
    while (!open_.empty() && scene_.instances.subtree_end[open_.back().row] <= row) {
      const auto [node, item] = open_.back();
      open_.pop_back();
      if (instances_[node].kind == ItemKind::bundle && items_.size() == item + 1) {
        items_.drop_last();
      } else {
        items_.end_subtree(item);
      }
    }
  }

  // A node at flat_depth, or above it with nothing visible below, is a block; nodes between it and the top are passed
  // by.
  void fill_blocks(Workload& workload) {
    const std::vector<std::uint32_t>& subtree_end = scene_.instances.subtree_end;
    for (std::size_t i = 0; i < rows_.size();) {
      const std::uint32_t row = rows_[i];
      const ItemKind kind = instances_[row].kind;
      if (kind == ItemKind::curve) {
        const Sight sight = look_at(row);
        if (!too_small(sight)) add_row(workload, row, sight);
      }
      const bool leaf = i + 1 == rows_.size() || rows_[i + 1] >= subtree_end[row];
      if (kind != ItemKind::levels || (!leaf && depths_[row] < scene_.flat_depth)) {
        ++i;
        continue;
      }
      if (leaf && subtree_end[row] == row + 1 && depths_[row] == 0) {
        add_row(workload, row, look_at(row));  // no tree: an ordinary instance beside one
        ++i;
        continue;
      }
      const auto end = static_cast<std::size_t>(
          std::lower_bound(rows_.begin() + static_cast<std::ptrdiff_t>(i), rows_.end(), subtree_end[row]) -
          rows_.begin());
      add_block(workload, i, end);
      i = end;
    }
  }

  void add_block(Workload& workload, std::size_t first, std::size_t last) {
    areas_.clear();
    for (std::size_t i = first; i < last; ++i) areas_.push_back(look_at(rows_[i]).area_px);
    const auto begin_at = static_cast<std::uint32_t>(workload.facts.size());
    const std::size_t levels =
        append_block_levels(scene_, depths_, std::span(rows_).subspan(first, last - first), areas_, workload.facts);
    add_item(rows_[first], look_at(rows_[first]), ItemKind::levels, begin_at, levels);
  }

  const Scene& scene_;
  std::unique_ptr<Visibility> visibility_;
  std::vector<Row> instances_;
  std::vector<std::uint8_t> depths_;
  SceneFacts facts_;
  std::vector<Facts> static_facts_;
  std::vector<TypeFacts> type_facts_;
  double focal_px_ = 0;

  // Of the frame that is being filled.
  const Pose* pose_ = nullptr;
  WorkloadRequest request_;
  std::vector<std::uint32_t> rows_;
  ItemWriter items_;
  struct OpenNode {
    std::uint32_t row, item;
  };
  std::vector<OpenNode> open_;
  std::vector<double> areas_;
};

}  // namespace

std::unique_ptr<WorkloadSource> make_workload_source(const Scene& scene) {
  return std::make_unique<SceneWorkload>(scene);
}

}  // namespace framesim
