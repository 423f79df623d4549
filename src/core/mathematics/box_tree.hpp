// A tree of boxes that finds those that a ray meets, on the host and in double.
#pragma once

#include <glm/glm.hpp>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

namespace vkfv {

// A binary tree over boxes, halved by number along the longest axis down to a few boxes.
class BoxTree {
  public:
    struct Box {
        glm::dvec3 lower, upper;
    };

    BoxTree() = default;
    explicit BoxTree(std::span<const Box> boxes);

    // Calls nearer(k, farthest) for every box k that the ray may meet at a distance from 0 to `farthest`; it returns
    // the new `farthest`. Boxes are enlarged a little, to allow for the rounding of a few operations.
    template <class Nearer>
    void walk(const glm::dvec3& origin, const glm::dvec3& direction, double farthest, Nearer nearer) const {
        std::array<std::size_t, 64> stack; // 2^32 boxes have a depth of 32
        std::size_t depth = 0;
        if (!nodes_.empty()) {
            stack[depth++] = 0;
        }
        while (depth > 0) {
            const Node& node = nodes_[stack[--depth]];
            if (!meets(node.box, origin, direction, farthest)) {
                continue;
            }
            if (node.count == 0) {
                stack[depth++] = node.second;
                stack[depth++] = node.first;
                continue;
            }
            for (std::size_t i = node.first; i < node.first + node.count; ++i) {
                farthest = nearer(order_[i], farthest);
            }
        }
    }

  private:
    struct Node {
        Box box;
        std::size_t first = 0;  // first child; of a leaf: index into order_
        std::size_t second = 0; // second child
        std::size_t count = 0;  // number of boxes of a leaf; 0: an inner node
    };

    static bool meets(const Box& box, const glm::dvec3& origin, const glm::dvec3& direction, double stop) {
        double start = 0;
        constexpr double margin = 1e-12; // relative to the coordinates
        for (int axis = 0; axis < 3; ++axis) {
            const double wider =
                margin * (std::abs(origin[axis]) + std::abs(box.lower[axis]) + std::abs(box.upper[axis]));
            const double lower = box.lower[axis] - wider, upper = box.upper[axis] + wider;
            if (direction[axis] == 0) {
                stop = origin[axis] < lower || origin[axis] > upper ? -HUGE_VAL : stop;
                continue;
            }
            const double a = (lower - origin[axis]) / direction[axis], b = (upper - origin[axis]) / direction[axis];
            start = std::max(start, std::min(a, b));
            stop = std::min(stop, std::max(a, b));
        }
        return start <= stop;
    }
    std::size_t build(std::span<const Box> boxes, std::size_t begin, std::size_t end);

    std::vector<Node> nodes_; // node 0 is the root
    std::vector<std::uint32_t> order_;
};

} // namespace vkfv
