// The light that one point of the detector receives. Lengths in mm.
#pragma once

#include "optics/aim/apertures.hpp"

#include <optional>

namespace vkfv::optics {

struct TracedWave {
    glm::dvec2 object_point = glm::dvec2(0); // in the object plane
    double path_length = 0;                  // optical path length from the object plane to the detector
    glm::dvec2 slope = glm::dvec2(0);        // slope of the ray at the detector
};

struct DetectorView {
    const Imaging& imaging;    // for one wavelength, from at_wavelength()
    double index = 1;          // index of the specimen's medium
    double magnification = -1; // approximate magnification
    double plane = 0;          // height of the object plane above the paraxial one
    glm::dvec2 detector;       // the point of the detector
    glm::dvec2 guess;          // approximate position of its image

    // The ray to the detector's point that leaves the object plane with the direction cosines p / index, found by
    // Broyden's method. None if there is no such ray, or if an aperture stops it.
    std::optional<TracedWave> trace(glm::dvec2 p, std::uint32_t apertures) const;
    // The excess of that ray over the edge that stops it, as in excess_of(). A value <= 0 means that trace(p, 1) has a
    // value.
    double excess(glm::dvec2 p) const;

  private:
    struct Found {
        glm::dvec2 point;
        glm::dvec2 move; // remaining shift of the object point, to first order
        Imaging::Landing landing;
    };
    std::optional<Found> find(glm::dvec2 cosines) const;
};

} // namespace vkfv::optics
