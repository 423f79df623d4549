// The place of a rough specimen on a capability map.
#pragma once

#include "configuration/configuration.hpp"
#include "measurement/capability/limits.hpp"
#include "surface/height_map.hpp"

#include <optional>
#include <vector>

namespace vkfv::measurement {

// The shares of Sq and Sdq that an S-filter (ISO 16610-61) leaves, which halves waves as long as its nesting index. It
// stands for a focus window and an optical resolution, which take short waves off in much the same way.
struct KeptRoughness {
    double period = 0;    // mm, the nesting index
    double sq = 0;        // Sq over that of the whole surface
    double rms_slope = 0; // Sdq over that of the whole surface
};

struct RoughSpecimen {
    double sq = 0;        // mm, root mean square height about the least-squares plane
    double rms_slope = 0; // Sdq, dimensionless
    // By ascending periods from four points on, at least two; weights of shorter filters are too few for their form.
    std::vector<KeptRoughness> kept{};

    // The shares that an S-filter of this nesting index (mm) leaves, interpolated linearly in its logarithm. An index
    // outside the periods of `kept` has the shares of the nearest.
    KeptRoughness kept_by(double period) const;
    // The longest period (mm) that keeps this share of Sq or Sdq; NaN where the shortest period does not.
    double period_keeping(double share, double KeptRoughness::*of) const;

    // The sinusoid of the same Sq and Sdq (ISO 25178-2): amplitude sqrt(2) Sq, wavelength 2 pi Sq / Sdq, which is the
    // root mean square wavelength of the surface (R. C. Spragg, D. J. Whitehouse, "A new unified approach to surface
    // metrology", Proc. Inst. Mech. Eng. 185, 1970).
    SurfaceWave wave() const;
};

// The roughness of these heights; NaN at points that have none. None for a flat surface.
std::optional<RoughSpecimen> roughness_of(const surface::HeightMap& heights);

// The roughness of a specimen without a nominal dimension, at points a quarter of a pixel apart in the middle 256
// pixels at most. Images, meshes, points and measured files count too; Sq and Sdq then contain their form. None for a
// standard with dimensions, whose relief is no roughness, and for a flat surface. pixel: distance of the pixels on the
// specimen, mm. Throws InputError.
std::optional<RoughSpecimen> rough_specimen(const Configuration& configuration, double pixel);

} // namespace vkfv::measurement
