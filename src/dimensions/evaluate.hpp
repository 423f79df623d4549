// A standard's dimensions on a height map.
#pragma once

#include "dimensions/feature.hpp"

#include <string>
#include <vector>

namespace vkfv::dimensions {

struct Dimension {
    enum class Unit { length, angle, ratio }; // mm, rad, 1

    std::string name; // "step height"
    std::string rule; // the standard or method: "ISO 5436-1"
    Unit unit = Unit::length;
    // NaN where there is none.
    double nominal = surface::undefined;
    double value = surface::undefined;              // not covered by the map, or too little of it measured
    double standard_deviation = surface::undefined; // of one profile's
    double standard_error = surface::undefined;     // of the value, by the scatter of the heights alone
    int profiles = 0;                               // over which the value is a mean; 0: one fit to all points
};

// The same ones in the same order for every map on one grid: those of the measurement and of the truth pair up.
std::vector<Dimension> evaluate(const surface::HeightMap& map, const Feature& feature);

} // namespace vkfv::dimensions
