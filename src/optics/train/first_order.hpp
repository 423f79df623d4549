// Paraxial optics of a train of surfaces, as linear maps of height and angle (Born and Wolf, "Principles of
// Optics", section 4.4; Kloos, "Matrix Methods for Optical Layout"). Lengths in mm; the train stands in air.
#pragma once

#include "physics/physics.hpp"

#include <span>

namespace vkfv::optics {

// The ray transfer matrix between two planes: y' = a y + b v, v' = c y + d v, with the height y (mm) and the reduced
// angle v = n u. Its determinant is 1.
struct RayTransfer {
    double a = 1;
    double b = 0; // mm
    double c = 0; // 1/mm, minus the power
    double d = 1;

    RayTransfer then(const RayTransfer& next) const;
};

RayTransfer free_space(double distance, double index = 1);

// The transfer from the first vertex to the last, both refractions included; the first surface's distance is left out.
RayTransfer transfer_of_train(std::span<const physics::f64::Surface> train);

// The transfer from the first vertex to the vertex of the surface `index`, before its refraction.
RayTransfer transfer_to_surface(std::span<const physics::f64::Surface> train, std::size_t index);

double focal_length(const RayTransfer& train);
double back_focal_distance(const RayTransfer& train);  // mm, from last vertex to back focal point
double front_focal_distance(const RayTransfer& train); // mm, from front focal point to first vertex

// The planes of unit magnification: `front` behind the first vertex, `back` behind the last (mm, negative: in front of
// it). The indices belong to the media in front of the train and behind it.
struct PrincipalPlanes {
    double front = 0;
    double back = 0;
};
PrincipalPlanes principal_planes(const RayTransfer& train, double index_before = 1, double index_after = 1);

// The image of a plane `object_distance` (mm) in front of the first vertex. Distance and magnification are infinite
// where there is no image.
struct ParaxialImage {
    double distance = 0; // mm behind the last vertex; negative: virtual
    double magnification = 0;
};
ParaxialImage image_of(const RayTransfer& train, double object_distance);

// The image of a stop behind all of `before`, seen from the object's side. A ray of height y and slope u at the first
// vertex crosses the stop at `scale` times (y * curvature + u), which is zero for the pupil's centre.
struct EntrancePupil {
    double scale = 0;     // mm
    double curvature = 0; // 1/mm, reciprocal of the pupil's distance behind the first vertex; 0: telecentric
};
EntrancePupil entrance_pupil(const RayTransfer& before);

// The image of a stop through the optics on one side of it. It is at infinity in a telecentric space.
struct StopImage {
    double distance = 0;      // mm, along the light, from the vertex where light enters or leaves
    double magnification = 0; // signed ratio of its size to the stop's
};
StopImage stop_seen_from_front(const RayTransfer& before, double index_before = 1); // distance behind the first vertex
StopImage stop_seen_from_behind(const RayTransfer& after, double index_after = 1);  // distance behind the last vertex

} // namespace vkfv::optics
