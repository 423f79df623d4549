// The light that the real apertures let through, found by tracing: the cone from a point of the field, its best focus,
// and the gate: all useful light lies inside it. Lengths in mm.
#pragma once

#include "optics/train/first_order.hpp"
#include "optics/train/train.hpp"

#include <glm/glm.hpp>

#include <optional>
#include <vector>

namespace vkfv::optics {

// The imaging train as the search needs it. Positions are on the paraxial object plane, heights above it (+z, towards
// the objective), directions unit vectors in the medium over the specimen.
struct Imaging {
    std::vector<physics::f64::Surface> train;
    double working_distance = 0;  // object plane to the frame that the train is entered in
    double detector_distance = 0; // last vertex to detector
    double detector_index = 1;    // of the medium before the detector
    double pupil_curvature = 0;   // the paraxial chief ray from x has the slope -pupil_curvature x
    bool symmetric = true;        // about the axis

    // Light that leaves (position, height) with the direction cosines (l, m), at the detector; none: it does not come
    // so far. The landing point and the direction (of length index) are in the detector's frame, and path_length is the
    // optical path to it.
    struct Landing {
        glm::dvec2 position;
        glm::dvec3 direction;
        double path_length = 0;
    };
    std::optional<Landing> trace(glm::dvec2 position, double height, glm::dvec2 cosines, std::uint32_t apertures = 1,
                                 double spectral = 0) const;
    // By how much it is beyond the edge that stops it: excess_of().
    double excess(glm::dvec2 position, double height, glm::dvec2 cosines) const;
    glm::dvec2 chief_cosines(glm::dvec2 position) const;
};

// The train for one wavelength, as if monochromatic.
Imaging at_wavelength(Imaging imaging, double spectral);

// Directions in which a search goes out from the axis: one for a symmetric train, else all round.
std::vector<glm::dvec2> search_directions(bool symmetric);

// The rim of the cone of light that passes all apertures from a point of the object plane in the reference wavelength,
// as radii in direction cosines about the paraxial chief ray.
struct Outline {
    glm::dvec2 position;
    glm::dvec2 centre;         // direction cosines
    std::vector<double> radii; // at azimuths (i + 1/2) * step over a whole turn: midpoints, for integrals
    double step = 0;

    glm::dvec2 cosines(std::size_t azimuth, double radius) const;
    double area() const; // in direction cosines
};
Outline outline_at(const Imaging& imaging, glm::dvec2 position);

// A set of rays that fills an outline with uniform density in direction cosines, weights summing to 1. More panels,
// rings of equal shares of the cone with a quadrature each, resolve what oscillates over it.
struct ConeRay {
    glm::dvec2 cosines;
    double weight = 0;
};
std::vector<ConeRay> fill_cone(const Outline& outline, int panels = 1);

// Height above the object plane at which the RMS distance of the outline's light from its centroid on the detector is
// least. The cone is that of the object plane.
double least_spot(const Imaging& imaging, const Outline& outline);

// The gate_radius of physics::Instrument (a slope) that lets pass all light of the reference wavelength that comes from
// within field_radius of the axis and from heights between lowest and highest, mm.
double gate_radius(const Imaging& imaging, double field_radius, double lowest, double highest);

} // namespace vkfv::optics
