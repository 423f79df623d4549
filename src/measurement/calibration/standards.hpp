// The standards of a virtual calibration as TOML, and what their evaluations share.
#pragma once

#include "measurement/calibration/characteristic.hpp"

#include <cstdint>
#include <string>
#include <vector>

namespace vkfv::measurement {

// Contrast of the print on all standards but those whose contrast is varied: standard deviation of the reflectance over
// its mean.
inline constexpr double usual_contrast = 0.5;

// Where overrides of the configuration come from, as messages name it.
inline constexpr const char* origin_of_standards = "virtual standards";

// The tables below [specimen] of a Lambertian surface with a print, whose grain the optics and the pixels resolve.
std::string printed(const Conditions& conditions, double contrast, std::uint32_t print_seed);

// The [specimen] of a kind, whose keys are given as lines; its square is larger than the field by the blur.
// facet_pitch: mm; 0: the surface is a function.
std::string standard_of(const Conditions& conditions, const std::string& kind, const std::string& keys,
                        double facet_pitch);

// A groove with a flat bottom. mm.
struct Groove {
    double width = 0, depth = 0;
};
// The groove of this depth that is at least twelve windows wide, and wide enough for the middle third of its bottom,
// which ISO 5436-1 evaluates, to be seen by whole light cones past the walls, also while it is out of focus by two
// standard deviations of a focus curve, when a window sees the bottom around it: 3 ((depth + 2 w) tan(theta) + W / 2).
// Otherwise less light comes from below the focus than from above, and the bottom is found too high. Where the field
// does not hold it, the groove is as wide as a share `field_share` of the field, and as shallow as this width asks; the
// depth is then at most 0 if no groove fits.
Groove groove_of(const Conditions& conditions, double depth, double field_share);

// Adds a remark where a groove is shallower than wished.
void remark_shallower(const Conditions& conditions, const Groove& deepest, double wished,
                      std::vector<std::string>& remarks);

// The [specimen] of a groove, with the print of this seed but without its place.
std::string groove_standard(const Conditions& conditions, const Groove& groove, std::uint32_t print_seed);

// A printed sinusoid in the middle of the scan, whose waves run along x turned by the angle. mm, rad.
std::string sinusoid_standard(const Conditions& conditions, double amplitude, double period, std::uint32_t print_seed,
                              double angle = 0);

// A table [specimen.placement]. mm, rad.
std::string placed_at(double x, double y, double z, double rotation = 0, double tilt_x = 0, double tilt_y = 0);

// The overrides of repetition k of a measurement: another seed of the camera's noise on the same light, or without a
// camera another seed of the rays.
std::vector<TomlOverride> repetition(const Conditions& conditions, int k);

// A length in um as TOML.
std::string um(double mm);

// The dimension whose name begins so; null if the trial has none.
const StandardDimension* dimension(const TrialResult& result, const std::string& name);
// Its standard uncertainty (mm): the scatter of the heights and the effects that move all heights alike.
double uncertainty_of(const StandardDimension& dimension);

// The median of the finite numbers; NaN if there are none.
double median_of(std::vector<double> values);

// The median of measured less true heights, mm: what the aberrations of the instrument add to every height alike.
double common_offset(const TrialResult& result);

// The points whose true heights lie within the usable range of the scan.
struct PointShares {
    double points = 0;    // their number
    double right = 0;     // share measured within three standard uncertainties of the truth
    double wrong = 0;     // share measured farther from it
    double deviation = 0; // root mean square of the measured points' deviations, mm
};
// offset: mm, taken off the measured heights.
PointShares point_shares(const Conditions& conditions, const TrialResult& result, double offset);

// A straight line through points by least squares. Uncertainties are those of the scatter about the line.
struct Line {
    double offset = surface::undefined, slope = surface::undefined;
    double slope_uncertainty = surface::undefined;
    double scatter = surface::undefined;  // standard deviation of a point about the line
    double farthest = surface::undefined; // largest distance of a point from it
    double degrees_of_freedom = 0;
};
Line line_through(const std::vector<double>& x, const std::vector<double>& y);

} // namespace vkfv::measurement
