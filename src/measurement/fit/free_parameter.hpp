// The numbers of a configuration that a fit is free to change, each on a scale on which any number is allowed.
#pragma once

#include "configuration/configuration.hpp"
#include "core/toml/toml_reader.hpp"

#include <map>
#include <string>
#include <vector>

namespace vkfv::measurement {

// A number of the configuration, in the unit of its key, and the scale on which it is searched: 0 is the start, and
// every number of the scale lies inside the key's range. A number between two ends is logistic in the scale; one above
// or below an end is exponential in it; others are linear, by units of the start's magnitude.
struct FreeParameter {
    std::string key;  // dotted
    std::string unit; // empty: none
    NumberRange range{};
    double start = 0;

    double value(double scaled) const;
    // Derivative of the value by the scaled number.
    double slope(double scaled) const;
    // Width, on the scale about this place, of the range in which the parameter is known to lie beforehand: between two
    // ends that range, beside one end a decade. Infinite for a parameter without ends.
    double known_width(double scaled) const;
    // The range that known_width() is of, in words: "-0.9 to 1", "a decade".
    std::string known_range() const;
};

// The parameters of these keys. starts: TOML numbers by key, for keys that do not begin at the configuration's value.
// Throws InputError for keys that are no number of this configuration or are named twice, for starts of other keys, and
// for a start at an end of the range, or at 0 without ends, since the scale has no such place.
std::vector<FreeParameter> free_parameters(const Configuration& configuration, const std::vector<std::string>& keys,
                                           const std::map<std::string, double>& starts);

} // namespace vkfv::measurement
