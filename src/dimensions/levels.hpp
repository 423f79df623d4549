// Step heights and groove depths as ISO 5436-1 has them, and what follows from the same regions.
#pragma once

#include "dimensions/feature.hpp"
#include "dimensions/statistics.hpp"

#include <optional>
#include <vector>

namespace vkfv::dimensions {

// How far an upper level stands over a lower one, in mm: Z = alpha u + beta + h delta is fitted by least squares to the
// points of the regions, delta +1 on the upper and -1 on the lower ones (ISO 5436-1, type A1); the difference is 2 h.
struct LevelDifference {
    Mean profiles;    // of each profile's own fit
    double areal = 0; // of one fit to all points, with a slope along v too
    // That fit: the level halfway between both.
    double middle = 0, slope_u = 0, slope_v = 0;
    std::vector<double> middles{}; // each profile's own level halfway, at u = 0; NaN where it has none

    double halfway(double u, double v) const { return middle + slope_u * u + slope_v * v; }
};

// The depth of a groove whose place and width W are known: the lower level is its middle third; the upper levels are
// what lies on either side between W/3 and W from its edges, so that the thirds beside the edges, which may be rounded,
// are left out. None where the map covers less than half of one of these regions, or half of it was not measured.
// A ridge, of negative depth, has the regions the other way round, and its height is told.
std::optional<LevelDifference> groove_depth(const surface::HeightMap& map, const Groove& groove);

// ISO 5436-1 has no rule for a single edge. By analogy the level on either side is taken as long as the shorter one
// that the map shows, and the third of it that lies next to the edge is left out. The sign is that of the level at
// u > 0.
std::optional<LevelDifference> step_height(const surface::HeightMap& map, const Step& step);

// Between the two places where a profile crosses the level halfway between both (linearly between its points; the mean
// where noise makes it cross several times), mean over the profiles. Across flanks that were not measured the nearest
// points to either side count. The standard error is that of the widths at each profile's own level halfway, so that it
// counts how the levels scatter. None where no profile crosses the level within W/3 of both edges.
std::optional<Mean> groove_width(const surface::HeightMap& map, const Groove& groove, const LevelDifference& depth);

// The depth between lines and ground of a grating: the middle third of each line and of the ground between two lines.
// The frame and the period are those of the lines that the map shows (waves.hpp).
std::optional<LevelDifference> line_depth(const surface::HeightMap& map, const Grating& grating);

// Heights of plateaus over the ground, one for each height that is nominal and not 0, in ascending order. Where W is
// twice the greatest distance of a plateau's points from its edge, those count that are at least W/3 from it: the
// middle third of a strip; and of the ground what lies between W/3 and W from it. A plane common to all levels is
// fitted with them. The uncertainty is the residue's. NaN for one that was not measured.
struct PlateauHeight {
    double nominal = 0;
    double height = surface::undefined;
    double standard_error = surface::undefined;
};
std::vector<PlateauHeight> plateau_heights(const surface::HeightMap& map, const Plateaus& plateaus);

} // namespace vkfv::dimensions
