// Generated specimens: combines the parts that a kind provides.
#pragma once

#include "specimen/random_heights.hpp"
#include "specimen/roughness.hpp"
#include "specimen/square.hpp"

#include <functional>
#include <optional>
#include <variant>

namespace vkfv::specimen {

// The largest number of facets along a side: their points fill the largest image of a common device.
inline constexpr int most_facets = 16383;

// The parts of a generated specimen; either `function` or `raise` is set.
struct Recipe {
    Square square;
    Representation representation = Representation::facets;
    std::function<Analytic()> function{}; // function over the footprint
    // Sets the heights of a field that is 0 everywhere; asked_pitch: mm, before it was adjusted to divide the size.
    std::function<void(HeightField&, double asked_pitch)> raise{};
    std::optional<RandomHeights> random{}; // added to the function or the raised heights
};

// Makes facets at the points of a grid over the footprint; or the function, with random heights and roughness as a
// lattice added to it. The finer of the pitches of the square and of the roughness is used. Throws InputError for
// invalid values.
std::variant<HeightField, Mesh, Analytic> generate(const Recipe& recipe, const std::optional<Roughness>& roughness,
                                                   const SourceLocation& where);

} // namespace vkfv::specimen
