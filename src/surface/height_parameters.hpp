// Height parameters of ISO 25178-2:2012, 4.1.
#pragma once

#include "surface/height_map.hpp"

namespace vkfv::surface {

// Over the measured points; heights are taken from their mean. mm, except the dimensionless skewness,
// kurtosis and share. Without measured points, and for skewness and kurtosis of a constant height, NaN.
struct HeightParameters {
    double mean = 0;           // of the heights as they stand in the map
    double sa = 0;             // arithmetical mean height
    double sq = 0;             // root mean square height
    double ssk = 0;            // skewness
    double sku = 0;            // kurtosis, 3 for a normal distribution
    double sp = 0;             // maximum peak height
    double sv = 0;             // maximum pit height, positive
    double sz = 0;             // maximum height, sp + sv
    double measured_share = 0; // of all points
};

// No levelling, no filter: the caller's business.
HeightParameters height_parameters(const HeightMap& map);

} // namespace vkfv::surface
