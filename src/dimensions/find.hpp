// Finds standards of unknown position in the map.
#pragma once

#include "dimensions/evaluate.hpp"

#include <array>
#include <optional>
#include <string_view>
#include <vector>

namespace vkfv::dimensions {

enum class Sought { step, groove, sinusoid, grating, cross_grating, sphere, flat };
inline constexpr std::array sought_names = {"step", "groove", "sinusoid", "grating", "cross-grating", "sphere", "flat"};

// The straight edge, or the two parallel ones, that together with a plane give the least squares of the heights: over
// all directions, in steps of 5 degrees and then of half a degree, and places, in steps of a three hundredth of the
// map. A groove or ridge has its width at half depth. None for a map without heights or without an edge.
std::optional<Step> found_step(const surface::HeightMap& map);
std::optional<Groove> found_groove(const surface::HeightMap& map);

// The dimensions of a feature of the given kind anywhere in the map, as those of evaluate(), without nominal values. A
// grating's and a sinusoid's waves are the strongest of the map; a cross grating's second wave is at least 20 degrees
// off the first; the width of lines follows from the share of points above the middle level. A sphere is found by
// find_sphere.hpp, and left out if its radius is less than five of its standard errors. Empty if no such feature is
// found.
std::vector<Dimension> evaluate_found(const surface::HeightMap& map, Sought sought);

} // namespace vkfv::dimensions
