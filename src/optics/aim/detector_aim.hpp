// The part of an aim that illuminates the detector's field. Lengths in mm.
#pragma once

#include "optics/aim/aim.hpp"

#include <glm/glm.hpp>

#include <optional>
#include <span>

namespace vkfv::optics {

// Light that is scattered once, at most `greatest_defocus` above or below the plane of best focus. Both trains are
// rotationally symmetric about the same axis, with x and y along the detector's sides.
struct SingleScatter {
    std::span<const physics::f64::Surface> illumination;
    std::span<const physics::f64::Surface> imaging;
    DiscSource source;
    // The height above the plane of best focus at which the illumination train ends and the imaging train begins.
    double front_vertex_height = 0;
    double greatest_defocus = 0;
    double detector_distance = 0; // behind the imaging train's last vertex
    glm::dvec2 detector_half_sides{0};
};

// Half the sides of the rectangle that, about the direction middles of `disc`, contains the directions of all light
// which can reach the detector. Blur and distortion are those of sampled rays, times 1.25. disc: an aim that contains
// all light which passes the illumination. None if the rectangle would save nothing.
std::optional<glm::dvec2> aim_at_detector(const SingleScatter& light, const Aim& disc);

} // namespace vkfv::optics
