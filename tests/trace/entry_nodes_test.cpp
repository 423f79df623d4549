// From the node at which a ray may enter the tree, nothing that it could meet stands beside it.
#include "trace/structures/entry_nodes.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <bit>
#include <random>
#include <set>
#include <vector>

namespace vkfv::trace {
namespace {

using vulkan::Box;

// A bumpy ground of small boxes and a few large ones over it, in float.
std::vector<Box> boxes_over(glm::dvec2 lower, glm::dvec2 upper, int side) {
    std::mt19937 random(7);
    std::uniform_real_distribution<float> unit(0.0F, 1.0F);
    std::vector<Box> boxes;
    const glm::vec2 from(lower), cell = glm::vec2(upper - lower) / static_cast<float>(side);
    for (int row = 0; row < side; ++row) {
        for (int column = 0; column < side; ++column) {
            const glm::vec2 corner = from + cell * glm::vec2(column, row);
            const float height = 0.01F * unit(random);
            boxes.push_back({glm::vec3(corner, height), glm::vec3(corner + cell, height + 0.005F)});
        }
    }
    for (int k = 0; k < 5; ++k) {
        const glm::vec2 corner = from + glm::vec2(upper - lower) * 0.7F * glm::vec2(unit(random), unit(random));
        boxes.push_back({glm::vec3(corner, 0.1F), glm::vec3(corner + 0.2F, 0.2F)});
    }
    return boxes;
}

void add_primitives(const BoundingVolumeHierarchy& tree, std::uint32_t index, std::set<std::uint32_t>& primitives) {
    const HierarchyNode& node = tree.nodes.at(index);
    std::uint32_t child = node.first_node;
    for (unsigned slot = 0; slot < 8; ++slot) {
        if ((node.inner >> slot & 1U) != 0) {
            add_primitives(tree, child++, primitives);
        } else if (node.slots[slot] != 0) {
            for (unsigned k = 0;
                 k < static_cast<unsigned>(std::popcount(static_cast<unsigned>(node.slots[slot]) >> 5U)); ++k) {
                primitives.insert(tree.order.at(node.first_primitive + (node.slots[slot] & 31U) + k));
            }
        }
    }
}

bool overlap(const Box& box, glm::dvec2 lower, glm::dvec2 upper) {
    return box.minimum.x <= upper.x && box.maximum.x >= lower.x && box.minimum.y <= upper.y && box.maximum.y >= lower.y;
}

} // namespace

TEST(EntryNodes, HoldAllThatIsOverACellAndItsNeighbours) {
    const glm::dvec2 lower(-0.4, 0.1), upper(0.9, 0.8);
    const auto boxes = boxes_over(lower, upper, 48);
    const auto tree = build_hierarchy(boxes, 1);
    const EntryNodes entries = entry_nodes(tree.nodes, lower, upper);
    ASSERT_GE(entries.finest_level, 3);
    ASSERT_EQ(entries.nodes.size(), entry_level_begin(entries.finest_level + 1));
    int missed = 0, missed_by_twin = 0, below_root = 0;
    for (int level = 0; level <= entries.finest_level; ++level) {
        const int side = 1 << level;
        const glm::dvec2 cell = (upper - lower) / static_cast<double>(side);
        for (int row = 0; row < side; ++row) {
            for (int column = 0; column < side; ++column) {
                const std::size_t place = entry_level_begin(level) + static_cast<std::size_t>(row * side + column);
                std::set<std::uint32_t> held, held_by_twin;
                add_primitives(tree, entries.nodes.at(place), held);
                // The wrong twin is the node of the next cell but one.
                const int other = column + 2 < side ? column + 2 : std::max(0, column - 2);
                add_primitives(
                    tree, entries.nodes.at(place - static_cast<std::size_t>(column) + static_cast<std::size_t>(other)),
                    held_by_twin);
                below_root += level == entries.finest_level && entries.nodes[place] != 0 ? 1 : 0;
                const glm::dvec2 corner = lower + cell * glm::dvec2(column, row);
                for (std::uint32_t k = 0; k < boxes.size(); ++k) {
                    if (overlap(boxes[k], corner - cell, corner + 2.0 * cell)) {
                        missed += held.contains(k) ? 0 : 1;
                        missed_by_twin += held_by_twin.contains(k) ? 0 : 1;
                    }
                }
            }
        }
    }
    EXPECT_EQ(missed, 0);
    EXPECT_GT(missed_by_twin, 100);
    EXPECT_GT(below_root, 1 << (2 * entries.finest_level - 1)); // most cells enter below the root
}

} // namespace vkfv::trace
