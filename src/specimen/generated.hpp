// Specimens made by a rule: how the parts that a kind states come together.
#pragma once

#include "specimen/random_heights.hpp"
#include "specimen/roughness.hpp"
#include "specimen/square.hpp"

#include <functional>
#include <optional>
#include <variant>

namespace vkfv::specimen {

// Along a side of a generated surface: with one point more they fill the largest image of a common device.
inline constexpr int most_facets = 16383;

// One of `function` and `raise`.
struct Recipe {
    Square square;
    Representation representation = Representation::facets;
    std::function<Analytic()> function{}; // over the footprint
    // Sets the heights of a field that is level, at 0; asked_pitch: before it was adjusted to divide the size.
    std::function<void(HeightField&, double asked_pitch)> raise{};
    std::optional<RandomHeights> random{}; // added to either
};

// Facets at the points of a grid over the footprint; or the function, with random heights and roughness as a lattice
// added to it. The finer of the pitches of the square and of the roughness is used. Throws InputError where a value
// does not fit.
std::variant<HeightField, Mesh, Analytic> generate(const Recipe& recipe, const std::optional<Roughness>& roughness,
                                                   const SourceLocation& where);

} // namespace vkfv::specimen
