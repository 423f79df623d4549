// Resamples a height map on another map's grid.
#pragma once

#include "surface/height_map.hpp"

namespace vkfv::surface {

// The heights of `map` at the points of `onto`, whose heights are ignored. Each axis is treated separately:
// - where `map` is finer, by the mean over the target's cell, with a source cell of one pitch around each point, so
// that
//   details finer than the target's grid do not alias. If the target's ends cut source cells unevenly, at ratios of the
//   pitches that are not whole, the slope there corrects the mean, so that planes are preserved at every ratio. Where
//   both axes average, nine tenths of the cell must be measured, since the mean of less belongs to another place;
// - otherwise by cubic convolution (Keys 1981, a = -1/2), which preserves the map's own points, with linear
//   continuation by a pitch at its borders; 99 % of the weight must be measured.
// NaN beyond the map's points and where too little is measured.
HeightMap resampled(const HeightMap& map, const HeightMap& onto);

} // namespace vkfv::surface
