// The tree keeps its invariants, read back from its nodes by code of this file alone.
#include "trace/structures/bounding_volume_hierarchy.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <bit>
#include <cmath>
#include <limits>
#include <random>
#include <stdexcept>
#include <vector>

namespace vkfv::trace {
namespace {

using vulkan::Box;

struct Check {
    std::size_t outside = 0; // primitives and nodes that stand out of the box of a slot above them
    std::size_t misread = 0; // slots and masks that contradict each other
    std::vector<int> times;  // each primitive is met in the whole tree
    std::size_t nodes = 0;   // met
    std::size_t largest_leaf = 0;
    int depth = 0;

    bool sound(std::size_t node_count) const {
        return outside == 0 && misread == 0 && nodes == node_count && depth <= hierarchy_depth &&
               std::ranges::all_of(times, [](int count) { return count == 1; });
    }
};

bool within(const Box& inner, const glm::dvec3& lower, const glm::dvec3& upper) {
    return glm::all(glm::greaterThanEqual(glm::dvec3(inner.minimum), lower)) &&
           glm::all(glm::lessThanEqual(glm::dvec3(inner.maximum), upper));
}

// The box around all primitives below a node.
Box examine(const BoundingVolumeHierarchy& tree, const std::vector<Box>& boxes, std::size_t index, int depth,
            Check& check) {
    constexpr float infinity = std::numeric_limits<float>::infinity();
    const HierarchyNode& node = tree.nodes.at(index);
    ++check.nodes;
    check.depth = std::max(check.depth, depth);
    Box all{glm::vec3(infinity), glm::vec3(-infinity)};
    std::size_t children = 0;
    for (unsigned slot = 0; slot < 8; ++slot) {
        const unsigned word = node.slots[slot];
        const bool inner = (node.inner >> slot & 1U) != 0;
        Box below{glm::vec3(infinity), glm::vec3(-infinity)};
        const auto include = [&below](const Box& box) {
            below.minimum = glm::min(below.minimum, box.minimum);
            below.maximum = glm::max(below.maximum, box.maximum);
        };
        if (inner) {
            check.misread += word == 32 + 24 + slot ? 0 : 1;
            include(examine(tree, boxes, node.first_node + children, depth + 1, check));
            ++children;
        } else if (word != 0) {
            const auto count = static_cast<unsigned>(std::popcount(word >> 5));
            check.misread += word >> 5 == (1U << count) - 1 && (word & 31U) + count <= 24 ? 0 : 1;
            check.largest_leaf = std::max<std::size_t>(check.largest_leaf, count);
            for (unsigned k = 0; k < count; ++k) {
                const std::uint32_t primitive = tree.order.at(node.first_primitive + (word & 31U) + k);
                ++check.times.at(primitive);
                include(boxes.at(primitive));
            }
        } else {
            continue;
        }
        glm::dvec3 lower;
        glm::dvec3 upper;
        for (int axis = 0; axis < 3; ++axis) {
            const double step = std::ldexp(1.0, node.exponents[axis] - 127);
            lower[axis] = static_cast<double>(node.origin[axis]) + node.lower[axis][slot] * step;
            upper[axis] = static_cast<double>(node.origin[axis]) + node.upper[axis][slot] * step;
        }
        check.outside += within(below, lower, upper) ? 0 : 1;
        all.minimum = glm::min(all.minimum, below.minimum);
        all.maximum = glm::max(all.maximum, below.maximum);
    }
    return all;
}

Check examine(const BoundingVolumeHierarchy& tree, const std::vector<Box>& boxes) {
    Check check;
    check.times.assign(boxes.size(), 0);
    EXPECT_EQ(tree.order.size(), boxes.size());
    examine(tree, boxes, 0, 1, check);
    return check;
}

std::vector<Box> random_boxes(std::size_t count, float size, std::uint32_t seed) {
    std::mt19937 generator(seed);
    std::uniform_real_distribution<float> uniform(-1.0F, 1.0F);
    std::vector<Box> boxes;
    for (std::size_t k = 0; k < count; ++k) {
        const glm::vec3 corner(uniform(generator), uniform(generator), uniform(generator));
        const glm::vec3 extent(uniform(generator), uniform(generator), uniform(generator));
        boxes.push_back({corner, corner + size * glm::abs(extent)});
    }
    return boxes;
}

TEST(BoundingVolumeHierarchy, HoldsEveryPrimitiveOnceAndEnclosesIt) {
    for (const std::size_t count : {1U, 2U, 3U, 4U, 7U, 8U, 9U, 100U, 20'000U}) {
        for (const std::size_t leaf_size : {1U, 2U, 3U}) {
            const auto boxes = random_boxes(count, 0.01F, 41);
            const auto tree = build_hierarchy(boxes, leaf_size);
            const Check check = examine(tree, boxes);
            EXPECT_TRUE(check.sound(tree.nodes.size())) << count << " by " << leaf_size;
            EXPECT_LE(check.largest_leaf, leaf_size);
        }
    }
    const auto boxes = random_boxes(20'000, 0.01F, 41);
    // A tree of 20'000 boxes has log8(20'000 / 3) = 4.2 levels; splits by area are uneven, but not by more than a few
    // levels on even boxes.
    EXPECT_LE(examine(build_hierarchy(boxes, 3), boxes).depth, 9);
}

// Large trees are made in parts that are put together.
TEST(BoundingVolumeHierarchy, IsWholeWhenMadeInParts) {
    const auto boxes = random_boxes(150'000, 0.01F, 45);
    const auto tree = build_hierarchy(boxes, 1);
    EXPECT_TRUE(examine(tree, boxes).sound(tree.nodes.size()));
    EXPECT_EQ(tree.order, build_hierarchy(boxes, 1).order);
}

TEST(BoundingVolumeHierarchy, AShrunkBoxIsNoticed) {
    const auto boxes = random_boxes(1000, 0.01F, 42);
    for (const std::size_t index : {0U, 517U, 999U}) {
        auto shrunk = boxes;
        shrunk[index].maximum = shrunk[index].minimum; // 2 % of the whole: five steps of the root, more further down
        const auto tree = build_hierarchy(shrunk, 1);
        EXPECT_FALSE(examine(tree, boxes).sound(tree.nodes.size())) << index;
    }
}

TEST(BoundingVolumeHierarchy, TakesDegenerateBoxes) {
    std::vector<std::vector<Box>> cases;
    cases.emplace_back(1, Box{glm::vec3(0), glm::vec3(0)});
    cases.emplace_back(5000, Box{glm::vec3(1, 2, 3), glm::vec3(1, 2, 3)}); // all the same point
    cases.emplace_back(5000, Box{glm::vec3(-1), glm::vec3(1)});            // all the same box
    std::vector<Box> line;
    std::vector<Box> flat;
    std::vector<Box> nested;
    for (int k = 0; k < 5000; ++k) {
        const auto x = static_cast<float>(k);
        line.push_back({glm::vec3(x, 0, 0), glm::vec3(x + 1, 0, 0)});
        const auto y = static_cast<float>(k % 71);
        flat.push_back({glm::vec3(x, y, 7), glm::vec3(x + 1, y + 1, 7)});
        nested.push_back({glm::vec3(-x), glm::vec3(x)});
    }
    cases.insert(cases.end(), {line, flat, nested});
    for (std::size_t k = 0; k < cases.size(); ++k) {
        const auto tree = build_hierarchy(cases[k], 3);
        EXPECT_TRUE(examine(tree, cases[k]).sound(tree.nodes.size())) << "case " << k;
    }
}

// The places halve again and again: by area alone, the tree would be about as deep as there are places over the four
// that one set of bins tells apart.
TEST(BoundingVolumeHierarchy, IsNeverDeeperThanTheShadersStack) {
    std::vector<Box> boxes;
    for (int octave = -100; octave < 60; ++octave) {
        for (int k = 0; k < 2000; ++k) {
            const float x = std::ldexp(1.0F + static_cast<float>(k) * 0x1p-12F, octave);
            boxes.push_back({glm::vec3(x, 0, 0), glm::vec3(x, x, 0)});
        }
    }
    const auto tree = build_hierarchy(boxes, 1);
    EXPECT_TRUE(examine(tree, boxes).sound(tree.nodes.size()));
}

TEST(BoundingVolumeHierarchy, SlotsTellWhichChildIsNearer) {
    for (int axis = 0; axis < 3; ++axis) {
        std::vector<Box> boxes(2, Box{glm::vec3(0), glm::vec3(1)});
        boxes[1].minimum[axis] += 5;
        boxes[1].maximum[axis] += 5;
        const auto tree = build_hierarchy(boxes, 1);
        for (unsigned slot = 0; slot < 8; ++slot) {
            const HierarchyNode& node = tree.nodes[0];
            if (node.slots[slot] != 0) {
                EXPECT_EQ(slot >> axis & 1U, tree.order[node.slots[slot] & 31U]) << "axis " << axis;
            }
        }
    }
}

TEST(BoundingVolumeHierarchy, IsTheSameEveryTime) {
    const auto boxes = random_boxes(5000, 0.1F, 43);
    const auto first = build_hierarchy(boxes, 3);
    const auto second = build_hierarchy(boxes, 3);
    EXPECT_EQ(first.order, second.order);
    EXPECT_NE(first.order, build_hierarchy(random_boxes(5000, 0.1F, 44), 3).order);
}

TEST(BoundingVolumeHierarchy, RefusesWhatHasNoPlace) {
    constexpr float nan = std::numeric_limits<float>::quiet_NaN();
    constexpr float infinity = std::numeric_limits<float>::infinity();
    EXPECT_THROW(build_hierarchy({}, 1), std::logic_error);
    const std::vector<Box> good(2, Box{glm::vec3(0), glm::vec3(1)});
    EXPECT_THROW(build_hierarchy(good, 0), std::logic_error);
    EXPECT_THROW(build_hierarchy(good, hierarchy_leaf_size + 1), std::logic_error);
    for (const Box& bad : {Box{glm::vec3(nan), glm::vec3(1)}, Box{glm::vec3(0), glm::vec3(0, infinity, 0)},
                           Box{glm::vec3(0, 0, 1), glm::vec3(1, 1, 0)}}) {
        const std::vector<Box> boxes = {good[0], bad};
        EXPECT_THROW(build_hierarchy(boxes, 1), std::logic_error);
    }
}

} // namespace
} // namespace vkfv::trace
