// Parts shared by the kinds of specimens that are generated over a square footprint, centred on the axis.
#pragma once

#include "specimen/lengths.hpp"
#include "specimen/specimen.hpp"

#include <array>
#include <vector>

namespace vkfv {
class Key;
class Section;
} // namespace vkfv

namespace vkfv::specimen {

struct Square {
    double size = 0;  // mm, side
    double pitch = 0; // mm, of the facets' grid; adjusted to divide the size

    bool operator==(const Square&) const = default;
};

enum class Representation { facets, analytic };

// The base of kinds whose surface is also a continuous function.
struct Continuous : Square {
    Representation representation = Representation::facets;

    // The function `shape` of physics/surface_function.glsl (for example SHAPE_STEP) over the footprint.
    Analytic function_of(std::uint32_t shape, const std::array<double, 4>& parameters = {}) const;

    bool operator==(const Continuous&) const = default;
};

// The keys of the base classes, followed by those of a kind.
std::vector<const Key*> square_keys(const std::vector<const Key*>& of_the_kind);
std::vector<const Key*> continuous_keys(const std::vector<const Key*>& of_the_kind);

void read_square(const Section& section, Square& square);
void read_continuous(const Section& section, Continuous& continuous);

// The key of the pitch alone, for a kind whose size follows from other keys.
const Key& square_pitch_key();
double read_square_pitch(const Section& section);

} // namespace vkfv::specimen
