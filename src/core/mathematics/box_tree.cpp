#include "core/mathematics/box_tree.hpp"

#include <limits>
#include <numeric>

namespace vkfv {

namespace {
constexpr std::size_t leaf_size = 4;
}

BoxTree::BoxTree(std::span<const Box> boxes) : order_(boxes.size()) {
    std::iota(order_.begin(), order_.end(), 0u);
    if (!boxes.empty()) {
        build(boxes, 0, boxes.size());
    }
}

std::size_t BoxTree::build(std::span<const Box> boxes, std::size_t begin, std::size_t end) {
    const std::size_t index = nodes_.size();
    constexpr double infinity = std::numeric_limits<double>::infinity();
    Node node{.box = {glm::dvec3(infinity), glm::dvec3(-infinity)}, .first = begin, .count = end - begin};
    for (std::size_t i = begin; i < end; ++i) {
        node.box.lower = glm::min(node.box.lower, boxes[order_[i]].lower);
        node.box.upper = glm::max(node.box.upper, boxes[order_[i]].upper);
    }
    nodes_.push_back(node);
    if (node.count > leaf_size) {
        const glm::dvec3 extent = node.box.upper - node.box.lower;
        const int axis = extent.x >= extent.y && extent.x >= extent.z ? 0 : (extent.y >= extent.z ? 1 : 2);
        const std::size_t middle = begin + node.count / 2;
        const auto at = [&](std::size_t i) { return order_.begin() + static_cast<std::ptrdiff_t>(i); };
        const auto twice_centre = [&](std::uint32_t box) { return boxes[box].lower[axis] + boxes[box].upper[axis]; };
        std::nth_element(at(begin), at(middle), at(end),
                         [&](std::uint32_t a, std::uint32_t b) { return twice_centre(a) < twice_centre(b); });
        const std::size_t first = build(boxes, begin, middle);
        const std::size_t second = build(boxes, middle, end);
        nodes_[index].first = first;
        nodes_[index].second = second;
        nodes_[index].count = 0;
    }
    return index;
}

} // namespace vkfv
