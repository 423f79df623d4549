// The light that the real apertures transmit, found by tracing: the cone from a point of the field, its best focus, and
// the acceptance bound (gate) that contains all useful light. Lengths in mm.
#pragma once

#include "optics/train/first_order.hpp"
#include "optics/train/train.hpp"

#include <glm/glm.hpp>

#include <optional>
#include <vector>

namespace vkfv::optics {

// The imaging train with the constants that these searches need. Positions are on the paraxial object plane, heights
// above it (+z, towards the objective), directions unit vectors in the medium over the specimen.
struct Imaging {
    std::vector<physics::f64::Surface> train;
    double working_distance = 0;  // from the object plane to the frame in which light enters the train
    double detector_distance = 0; // from the last vertex to the detector
    double detector_index = 1;    // index of the medium before the detector
    double pupil_curvature = 0;   // 1/mm; the paraxial chief ray from x has the slope -pupil_curvature x
    bool symmetric = true;        // true for a rotationally symmetric train

    // The arrival at the detector of the ray that leaves (position, height) with the direction cosines (l, m); none if
    // the ray ends before. The landing point and the direction (of length index) are in the detector's frame;
    // path_length is the optical path to the landing point.
    struct Landing {
        glm::dvec2 position;
        glm::dvec3 direction;
        double path_length = 0;
    };
    std::optional<Landing> trace(glm::dvec2 position, double height, glm::dvec2 cosines, std::uint32_t apertures = 1,
                                 double spectral = 0) const;
    // The excess of a ray over the edge that stops it, as in excess_of().
    double excess(glm::dvec2 position, double height, glm::dvec2 cosines) const;
    glm::dvec2 chief_cosines(glm::dvec2 position) const;
};

// The imaging train for one wavelength, as a monochromatic train.
Imaging at_wavelength(Imaging imaging, double spectral);

// Directions from the axis in which a search must go: one for a symmetric train, else all round.
std::vector<glm::dvec2> search_directions(bool symmetric);

// The rim of the cone of light that passes all apertures from a point of the object plane at the reference wavelength,
// as radii in direction cosines about the paraxial chief ray.
struct Outline {
    glm::dvec2 position;
    glm::dvec2 centre;         // direction cosines
    std::vector<double> radii; // at azimuths (i + 1/2) * step of a whole turn, midpoints for integrals
    double step = 0;

    glm::dvec2 cosines(std::size_t azimuth, double radius) const;
    double area() const; // in squared direction cosines
};
Outline outline_at(const Imaging& imaging, glm::dvec2 position);

// Rays that fill an outline with uniform density in direction cosines; their weights sum to 1. Panels are rings of
// equal shares of the cone with a quadrature each: more of them resolve functions that oscillate over the cone.
struct ConeRay {
    glm::dvec2 cosines;
    double weight = 0;
};
std::vector<ConeRay> fill_cone(const Outline& outline, int panels = 1);

// The height (mm) above the object plane at which the RMS distance of the outline's light from its centroid on the
// detector is least. The cone of the object plane serves for all heights.
double least_spot(const Imaging& imaging, const Outline& outline);

// The gate_radius of physics::Instrument (a slope): the acceptance bound that passes all light of the reference
// wavelength from within field_radius of the axis and from heights between lowest and highest (mm).
double gate_radius(const Imaging& imaging, double field_radius, double lowest, double highest);

} // namespace vkfv::optics
