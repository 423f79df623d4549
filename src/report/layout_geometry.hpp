// Boxes, and pictures of the plane of drawing on the page.
#pragma once

#include <glm/glm.hpp>

#include <limits>

namespace vkfv::report {

struct Box {
    glm::dvec2 lower{std::numeric_limits<double>::infinity()};
    glm::dvec2 upper{-std::numeric_limits<double>::infinity()};

    void add(glm::dvec2 point) {
        lower = glm::min(lower, point);
        upper = glm::max(upper, point);
    }
    void add(const Box& other) {
        lower = glm::min(lower, other.lower);
        upper = glm::max(upper, other.upper);
    }
    glm::dvec2 size() const { return upper - lower; }
    glm::dvec2 middle() const { return 0.5 * (lower + upper); }
    bool empty() const { return !(lower.x <= upper.x); }
    Box grown(double by) const { return {lower - by, upper + by}; }
    bool meets(const Box& other) const {
        return glm::all(glm::lessThan(lower, other.upper)) && glm::all(glm::lessThan(other.lower, upper));
    }
};

// The place of a picture of the plane of drawing on the page.
struct View {
    double scale = 1;    // px per mm
    glm::dvec2 origin{}; // px, of y = z = 0
    glm::dvec2 operator()(glm::dvec2 p) const { return {origin.x + scale * p.x, origin.y - scale * p.y}; }
    Box operator()(const Box& box) const {
        Box result;
        result.add((*this)(box.lower));
        result.add((*this)(box.upper));
        return result;
    }
};

// The (y, z) coordinates in the plane of drawing of a point in the specimen's frame (mm).
inline glm::dvec2 flat(glm::dvec3 point) {
    return {point.y, point.z};
}

} // namespace vkfv::report
