// The areal material ratio curve and the core parameters derived from it: ISO 25178-2:2012, 4.4 and 5.
#pragma once

#include "surface/height_map.hpp"

#include <vector>

namespace vkfv::surface {

// The areal material ratio curve: the share of the area on which the surface is higher than a height. Every measured
// point represents an equal area; not-measured points do not count.
class MaterialRatioCurve {
  public:
    explicit MaterialRatioCurve(const HeightMap& map);

    // Smc: the height (mm) exceeded on this share of the area, 0 to 1. The k-th highest of n points lies at the share
    // (k + 1/2) / n; the curve is linear between points. NaN without measured points.
    double height(double ratio) const;
    // Smr: the share of the area above a height (mm); 0 from the highest point up, 1 from the lowest down.
    double ratio(double height) const;

    // Volume of material above a height, and of void below it (mm), per measured area: mm^3/mm^2 = mm.
    double material_volume(double height) const;
    double void_volume(double height) const;

    const std::vector<double>& heights() const { return heights_; } // mm, descending

  private:
    std::vector<double> heights_;
};

// Core parameters; NaN with fewer than four points. The equivalent straight line is the least-squares line, of heights
// on ratios, through the 40 % of the points whose secant falls least (the first such from the top); the core lies
// between its heights at 0 and 100 %. The height of a reduced peak or dale is that of the triangle with the area
// between curve and core over the same ratios.
struct CoreParameters {
    double sk = 0;   // core height, mm
    double spk = 0;  // reduced peak height, mm
    double svk = 0;  // reduced dale height, mm
    double smr1 = 0; // share of the area above the core, 0 to 1
    double smr2 = 0; // share of the area above the dales, 0 to 1
};

// Differences of heights on the curve (mm) at the default ratios of ISO 25178-2; NaN without measured points.
struct RatioParameters {
    double sxp = 0; // peak extreme height, from 2.5 % to 50 %
    double sdc = 0; // material ratio height difference, from 2 % to 98 %
};

RatioParameters ratio_parameters(const MaterialRatioCurve& curve);

CoreParameters core_parameters(const MaterialRatioCurve& curve);

} // namespace vkfv::surface
