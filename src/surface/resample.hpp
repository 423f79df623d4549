// A height map on another map's grid.
#pragma once

#include "surface/height_map.hpp"

namespace vkfv::surface {

// The heights of `map` at the points of `onto`, whose heights do not matter. Along each axis on its own:
// - where `map` is finer, the mean over the target's cell, each point standing for a cell of one pitch, so that what
//   the target cannot resolve does not alias; cells cut unevenly by the target's ends, at ratios of the pitches that
//   are not whole, are allowed for by the slope there, so that planes stay as they are at every ratio. Where both axes
//   do so nine tenths of the cell must be measured, since the mean of less belongs to another place;
// - otherwise cubic convolution (Keys 1981, a = -1/2), which returns the map's own points as they are, with linear
//   continuation by a pitch at its borders; 99 % of the weight must be measured.
// NaN beyond the map's points and where the above does not hold.
HeightMap resampled(const HeightMap& map, const HeightMap& onto);

} // namespace vkfv::surface
