// Evaluates the dimensions of a measurement standard on a height map.
#pragma once

#include "dimensions/feature.hpp"

#include <string>
#include <vector>

namespace vkfv::dimensions {

struct Dimension {
    enum class Unit { length, angle, ratio }; // mm, rad, 1

    std::string name; // for example "step height"
    std::string rule; // standard or method: "ISO 5436-1"
    Unit unit = Unit::length;
    // The nominal value; NaN if there is none.
    double nominal = surface::undefined;
    double value = surface::undefined; // NaN if the map covers it too little or too little of it is measured
    double standard_deviation = surface::undefined; // scatter of one profile's value
    double standard_error = surface::undefined; // standard error of the value, from the scatter of the heights alone
    int profiles = 0;                           // number of profiles in the mean; 0: one fit to all points
};

// Evaluates the dimensions of a feature. All maps on one grid have the same dimensions in the same order, so those of
// the measurement and of the truth correspond.
std::vector<Dimension> evaluate(const surface::HeightMap& map, const Feature& feature);

} // namespace vkfv::dimensions
