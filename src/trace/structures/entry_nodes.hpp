// Where a ray may enter a tree of boxes below its root: shaders/device/specimen_bvh.glsl.
#pragma once

#include "trace/structures/bounding_volume_hierarchy.hpp"

#include <glm/glm.hpp>

#include <cstdint>
#include <vector>

namespace vkfv::trace {

// Grids over a footprint, of 1, 4, 16, ... cells: for each cell, the node deepest in the tree of all that hold whatever
// lies over the cell and the cells around it. A ray, or a part of one, whose half is nowhere longer across than a cell
// of the one its middle is over is over these cells alone. Level by level, rows ascending with y.
struct EntryNodes {
    int finest_level = 0; // of 4^level cells
    std::vector<std::uint32_t> nodes;
};

// Index of a level's first cell.
constexpr std::size_t entry_level_begin(int level) {
    return ((std::size_t{1} << (2 * level)) - 1) / 3;
}

// Of the tree whose root is the first node. lower, upper: of the footprint, in the boxes' unit, outside of which there
// may be boxes too, that rays over the footprint do not meet.
EntryNodes entry_nodes(const std::vector<HierarchyNode>& nodes, glm::dvec2 lower, glm::dvec2 upper);

} // namespace vkfv::trace
