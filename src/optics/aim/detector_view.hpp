// The light that one point of the detector sees. Lengths in mm.
#pragma once

#include "optics/aim/apertures.hpp"

#include <optional>

namespace vkfv::optics {

struct TracedWave {
    glm::dvec2 object_point = glm::dvec2(0); // where it leaves the object plane
    double path_length = 0;                  // optical, from there to the point
    glm::dvec2 slope = glm::dvec2(0);        // at the detector
};

struct DetectorView {
    const Imaging& imaging;    // of one wavelength: at_wavelength()
    double index = 1;          // of the specimen's medium
    double magnification = -1; // about
    double plane = 0;          // the object plane, above the paraxial one
    glm::dvec2 detector;       // the point
    glm::dvec2 guess;          // about where its image lies

    // What leaves the object plane with the direction cosines p / index, by Broyden's method. None: there is no such
    // ray, or an aperture stops it.
    std::optional<TracedWave> trace(glm::dvec2 p, std::uint32_t apertures) const;
    // By how much it is beyond the edge that stops it: excess_of(). <= 0: trace(p, 1) has a value.
    double excess(glm::dvec2 p) const;

  private:
    struct Found {
        glm::dvec2 point;
        glm::dvec2 move; // what is missing to the point, to first order
        Imaging::Landing landing;
    };
    std::optional<Found> find(glm::dvec2 cosines) const;
};

} // namespace vkfv::optics
