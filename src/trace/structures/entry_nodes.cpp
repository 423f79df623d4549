#include "trace/structures/entry_nodes.hpp"

#include "core/threads/parallel_rows.hpp"

#include <algorithm>
#include <bit>
#include <cmath>

namespace vkfv::trace {

namespace {

constexpr int most_levels = 10; // 1.4 million cells, 6 MB

struct Rectangle {
    glm::dvec2 lower;
    glm::dvec2 upper;
};

bool overlaps(const HierarchyNode& node, std::size_t slot, const Rectangle& rectangle) {
    bool over = true;
    for (int axis = 0; axis < 2; ++axis) {
        const double step = std::ldexp(1.0, node.exponents[axis] - 127);
        const double origin = static_cast<double>(node.origin[axis]);
        over = over && origin + node.lower[axis][slot] * step <= rectangle.upper[axis] &&
               origin + node.upper[axis][slot] * step >= rectangle.lower[axis];
    }
    return over;
}

// Descends from a node that holds all over the rectangle to the deepest node that does.
std::uint32_t descend(const std::vector<HierarchyNode>& nodes, std::uint32_t from, const Rectangle& rectangle) {
    std::uint32_t reached = from;
    for (bool deeper = true; deeper;) {
        const HierarchyNode& node = nodes[reached];
        unsigned over = 0;
        for (unsigned slot = 0; slot < 8; ++slot) {
            over |= node.slots[slot] != 0 && overlaps(node, slot, rectangle) ? 1U << slot : 0U;
        }
        deeper = std::has_single_bit(over) && (node.inner & over) != 0;
        if (deeper) {
            reached = node.first_node + static_cast<std::uint32_t>(std::popcount(node.inner & (over - 1)));
        }
    }
    return reached;
}

} // namespace

EntryNodes entry_nodes(const std::vector<HierarchyNode>& nodes, glm::dvec2 lower, glm::dvec2 upper) {
    EntryNodes entries;
    // There are about as many of the finest cells as nodes: smaller cells would seldom have a deeper entry.
    entries.finest_level = std::min(most_levels, static_cast<int>(std::bit_width(nodes.size())) / 2);
    entries.nodes.resize(entry_level_begin(entries.finest_level + 1));
    for (int level = 0; level <= entries.finest_level; ++level) {
        const int side = 1 << level;
        const glm::dvec2 cell = (upper - lower) / static_cast<double>(side);
        const std::size_t first = entry_level_begin(level);
        // The search begins at the coarser cell's node, which holds all over its four cells.
        const auto from = [&](int row, int column) {
            return level == 0 ? 0
                              : entries.nodes[entry_level_begin(level - 1) +
                                              static_cast<std::size_t>((row / 2) * (side / 2) + column / 2)];
        };
        const auto fill = [&](int first_row, int end_row) {
            for (int row = first_row; row < end_row; ++row) {
                for (int column = 0; column < side; ++column) {
                    const glm::dvec2 corner = lower + cell * glm::dvec2(column, row);
                    entries.nodes[first + static_cast<std::size_t>(row * side + column)] =
                        descend(nodes, from(row, column), {corner - cell, corner + 2.0 * cell});
                }
            }
        };
        parallel_rows(side, side, fill);
    }
    return entries;
}

} // namespace vkfv::trace
