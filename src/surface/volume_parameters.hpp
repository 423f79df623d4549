// Volume parameters of ISO 25178-2:2012, 4.4.
#pragma once

#include "surface/material_ratio.hpp"

namespace vkfv::surface {

// Volumes per measured area, mm^3/mm^2 = mm, at the standard's default ratios: peaks end at 10 % of the area, dales
// begin at 80 %. NaN without measured points.
struct VolumeParameters {
    double vmp = 0; // peak material volume
    double vmc = 0; // core material volume
    double vvc = 0; // core void volume
    double vvv = 0; // dale void volume
};

VolumeParameters volume_parameters(const MaterialRatioCurve& curve);

} // namespace vkfv::surface
