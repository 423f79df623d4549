// Standards whose position is not given: found in the map itself.
#pragma once

#include "dimensions/evaluate.hpp"

#include <array>
#include <optional>
#include <string_view>
#include <vector>

namespace vkfv::dimensions {

enum class Sought { step, groove, sinusoid, grating, cross_grating, sphere, flat };
inline constexpr std::array sought_names = {"step", "groove", "sinusoid", "grating", "cross-grating", "sphere", "flat"};

// The straight edge, or the two parallel ones, which with a plane leave the least squares of the heights: over all
// directions, 5 degrees and then half a degree apart, and places, a three hundredth of the map apart. The width of a
// groove or ridge is that at half depth. None in a map without heights or without an edge.
std::optional<Step> found_step(const surface::HeightMap& map);
std::optional<Groove> found_groove(const surface::HeightMap& map);

// The dimensions of what is sought, wherever it lies: those of evaluate(), without nominal values. A grating's and a
// sinusoid's waves are the strongest of the map; a cross grating's second one is at least 20 degrees off the first;
// the width of lines follows from how many points lie above the middle level. A sphere is that of find_sphere.hpp; none
// is told whose radius is less than five of its standard errors. Empty where nothing of the kind is found.
std::vector<Dimension> evaluate_found(const surface::HeightMap& map, Sought sought);

} // namespace vkfv::dimensions
