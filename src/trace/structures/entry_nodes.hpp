// Nodes below the root at which a ray may enter a tree of boxes: shaders/device/specimen_bvh.glsl.
#pragma once

#include "trace/structures/bounding_volume_hierarchy.hpp"

#include <glm/glm.hpp>

#include <cstdint>
#include <vector>

namespace vkfv::trace {

// Grids over a footprint, of 1, 4, 16, ... cells, with an entry node for each cell: the deepest node of the tree that
// holds all over the cell and the cells around it. A ray, or a part of one, of which neither half is longer across than
// a cell lies over the cell of its middle and the cells around it alone. Entries stand level by level, rows ascending
// with y.
struct EntryNodes {
    int finest_level = 0; // the finest level has 4^finest_level cells
    std::vector<std::uint32_t> nodes;
};

// Index of a level's first cell.
constexpr std::size_t entry_level_begin(int level) {
    return ((std::size_t{1} << (2 * level)) - 1) / 3;
}

// The entry nodes of the tree whose root is the first node. lower, upper: corners of the footprint, in the boxes' unit;
// there may be boxes outside, which rays over the footprint do not meet.
EntryNodes entry_nodes(const std::vector<HierarchyNode>& nodes, glm::dvec2 lower, glm::dvec2 upper);

} // namespace vkfv::trace
