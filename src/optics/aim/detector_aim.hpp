// The part of an aim that lights what the detector sees. mm.
#pragma once

#include "optics/aim/aim.hpp"

#include <glm/glm.hpp>

#include <optional>
#include <span>

namespace vkfv::optics {

// Light that is scattered once, at most `greatest_defocus` above or below the plane of best focus. Both trains are of
// revolution, about the same axis and with x and y along the detector's sides.
struct SingleScatter {
    std::span<const physics::f64::Surface> illumination;
    std::span<const physics::f64::Surface> imaging;
    DiscSource source;
    double front_vertex_height = 0; // over that plane; the one train ends there, the other is entered there
    double greatest_defocus = 0;
    double detector_distance = 0; // behind the imaging's last vertex
    glm::dvec2 detector_half_sides{0};
};

// Half the sides of the rectangle that, about the middles of `disc`, holds the directions of all light which can meet
// the detector. Blur and distortion are those of sampled rays, times 1.25. disc: holds what passes the illumination.
// None: the rectangle would save nothing.
std::optional<glm::dvec2> aim_at_detector(const SingleScatter& light, const Aim& disc);

} // namespace vkfv::optics
