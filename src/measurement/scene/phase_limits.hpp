// The limits within which images of waves hold. vkfv adds the waves of different paths without their phases. This is
// right where light from each point of the specimen fills the objective's pupil, because the source fills it or the
// specimen scatters widely. It is wrong where a mirror-like specimen is lit by a narrow cone, since waves too fine to
// pass then have contrast, and where the specimen's relief is so low that it changes the light's phase alone
// (docs/waves.md).
#pragma once

#include "core/messages/warning.hpp"
#include "optics/instrument/instrument.hpp"
#include "specimen/specimen.hpp"

#include <nlohmann/json.hpp>

#include <string>
#include <vector>

namespace vkfv::measurement {

struct PhaseLimits {
    // The largest error of contrast because light does not fill the pupil evenly (contrast_error_of()).
    double contrast_error = 0;
    // The spread of light over the pupil by scatter. Half of the light from the middle of the source (of a ring: from
    // its band) that a level specimen scatters into the objective's aperture lies within a sine; this member is that
    // sine over the one of an evenly filled pupil, at most 1: 0 for a mirror, 1 for a Lambertian surface.
    double scatter_fill = 1;
    // Radius of the source's image over that of the objective's pupil, at most 1; 0: the light is that of a ring.
    double source_fill = 1;
    // Standard deviation (mm) of the heights on the pixels from their mean by a Gaussian filter of ten times the limit
    // of resolution; or, if this is less, that of a normal distribution with the same median, so that steps do not
    // count.
    double texture = 0;
    // Radius that the source needs to fill the pupil, and the radius that it has, mm; 0: the light is that of a ring.
    double filling_radius = 0, source_radius = 0;
    double phase_height = 0;   // lambda / (4 pi n), mm: relief that shifts a reflected wave by a radian
    double depth_of_field = 0; // mm

    bool fills_pupil() const;
    bool is_relief_of_phase() const;
    // Standard uncertainty (mm) of every height that the images do not show: a depth of field where images of waves do
    // not hold, otherwise 0.
    double height_uncertainty() const;
};

// The limits for the source with the most flux. The instrument must be assembled from the description.
PhaseLimits phase_limits(const optics::InstrumentDescription& description, const optics::Instrument& instrument,
                         const specimen::Specimen& specimen);

// A warning for each condition that is not met.
std::vector<Warning> warnings_of(const PhaseLimits& limits);

// JSON with the keys of assets/schemas without their unit, in mm.
nlohmann::ordered_json json_of(const PhaseLimits& limits);

} // namespace vkfv::measurement
