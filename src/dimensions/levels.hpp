// Step heights and groove depths of ISO 5436-1, and further dimensions from the same regions.
#pragma once

#include "dimensions/feature.hpp"
#include "dimensions/statistics.hpp"

#include <optional>
#include <vector>

namespace vkfv::dimensions {

// The height (mm) of an upper level above a lower one: Z = alpha u + beta + h delta is fitted by least squares to the
// points of the regions, with delta +1 on the upper and -1 on the lower ones (ISO 5436-1, type A1); the difference is 2
// h.
struct LevelDifference {
    Mean profiles;    // from the fit to each profile
    double areal = 0; // from one fit to all points, with a slope along v too
    // The plane halfway between the levels, of the fit to all points.
    double middle = 0, slope_u = 0, slope_v = 0;
    std::vector<double> middles{}; // each profile's own halfway level at u = 0; NaN if it has none

    double halfway(double u, double v) const { return middle + slope_u * u + slope_v * v; }
};

// The depth of a groove of known place and width W. The lower level is its middle third; the upper levels lie on either
// side between W/3 and W from its edges, so that the thirds beside the edges, which may be rounded, are left out. None
// if the map covers less than half of one of these regions, or less than half of it was measured. For a ridge, of
// negative depth, upper and lower levels are exchanged, and the result is its height.
std::optional<LevelDifference> groove_depth(const surface::HeightMap& map, const Groove& groove);

// The height of a single edge, for which ISO 5436-1 has no rule. By analogy the level on either side has the length of
// the shorter one in the map, and its third next to the edge is left out. The sign is that of the level at u > 0.
std::optional<LevelDifference> step_height(const surface::HeightMap& map, const Step& step);

// The width of a groove: the distance between the two places where a profile crosses the level halfway (linearly
// between its points; the mean if noise causes several crossings), averaged over the profiles. At flanks that were not
// measured the nearest points on either side are used. The standard error is that of the widths at each profile's own
// halfway level, so that it includes the scatter of the levels. None if no profile crosses the level within W/3 of both
// edges.
std::optional<Mean> groove_width(const surface::HeightMap& map, const Groove& groove, const LevelDifference& depth);

// The depth between lines and ground of a grating, from the middle third of each line and of the ground between two
// lines. Frame and period are those of the lines found in the map (waves.hpp).
std::optional<LevelDifference> line_depth(const surface::HeightMap& map, const Grating& grating);

// The heights of plateaus above the ground, one for each nominal height other than 0, in ascending order. With W twice
// the greatest distance of a plateau's points from its edge, the points at least W/3 from the edge are used, the middle
// third of a strip; of the ground the points between W/3 and W from it. A plane common to all levels is fitted with
// them. The uncertainty follows from the residues. NaN for a plateau that was not measured.
struct PlateauHeight {
    double nominal = 0;
    double height = surface::undefined;
    double standard_error = surface::undefined;
};
std::vector<PlateauHeight> plateau_heights(const surface::HeightMap& map, const Plateaus& plateaus);

} // namespace vkfv::dimensions
