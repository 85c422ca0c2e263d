// A tree of `levels` nodes (terrain) for policies that take flat lists only: its nodes at one depth become items, whose
// levels are uniform refinements.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "scenes/scene.h"

namespace framesim {

// A node's place among the `levels` nodes above it: 0 for the topmost. One entry a row; 0 outside such trees.
std::vector<std::uint8_t> level_tree_depths(const Instances& instances);

// What one block shows of its visible subtree. `rows` are visible rows in preorder, rows[0] the block's node, the others
// below it; areas[i] the projected area of rows[i]. Level l is the cut at l steps below the node, where a node without
// visible children stands for itself: facts are summed, benefit is the sum of each node's own, stated outright, so that
// the flat presentation is worth what the same cut of the tree is worth. Appends the levels; returns how many.
std::size_t append_block_levels(const Scene& scene, std::span<const std::uint8_t> depths,
                                std::span<const std::uint32_t> rows, std::span<const double> areas,
                                std::vector<Facts>& facts);

}  // namespace framesim
