// Height parameters of ISO 25178-2:2012, 4.1.
#pragma once

#include "surface/height_map.hpp"

namespace vkfv::surface {

// Height parameters over the measured points; heights are relative to their mean. mm, except the dimensionless
// skewness, kurtosis and share. NaN without measured points, and for skewness and kurtosis of a constant height.
struct HeightParameters {
    double mean = 0;           // mean of the map's heights
    double sa = 0;             // arithmetical mean height
    double sq = 0;             // root mean square height
    double ssk = 0;            // skewness
    double sku = 0;            // kurtosis, 3 for a normal distribution
    double sp = 0;             // maximum peak height
    double sv = 0;             // maximum pit height, positive
    double sz = 0;             // maximum height, sp + sv
    double measured_share = 0; // share of all points
};

// Computes the parameters of the map as it is: levelling and filters are the caller's task.
HeightParameters height_parameters(const HeightMap& map);

} // namespace vkfv::surface
