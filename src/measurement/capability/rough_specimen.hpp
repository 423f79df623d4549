// The place of a rough specimen on a capability map.
#pragma once

#include "configuration/configuration.hpp"
#include "measurement/capability/limits.hpp"
#include "surface/height_map.hpp"

#include <optional>

namespace vkfv::measurement {

struct RoughSpecimen {
    double sq = 0;        // mm, root mean square height about the least-squares plane
    double rms_slope = 0; // Sdq, dimensionless

    // The sinusoid of the same Sq and Sdq (ISO 25178-2): amplitude sqrt(2) Sq, wavelength 2 pi Sq / Sdq, which is the
    // root mean square wavelength of the surface (R. C. Spragg, D. J. Whitehouse, "A new unified approach to surface
    // metrology", Proc. Inst. Mech. Eng. 185, 1970).
    SurfaceWave wave() const;
};

// The roughness of these heights; NaN at points that have none. None for a flat surface.
std::optional<RoughSpecimen> roughness_of(const surface::HeightMap& heights);

// The roughness of the configuration's specimen, at points a quarter of a pixel apart in the middle 256 pixels at most.
// None for a standard with dimensions, whose relief is no roughness, and for a flat surface. pixel: distance of the
// pixels on the specimen, mm. Throws InputError.
std::optional<RoughSpecimen> rough_specimen(const Configuration& configuration, double pixel);

} // namespace vkfv::measurement
