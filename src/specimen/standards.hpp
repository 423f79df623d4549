// Height fields of the specimens that microscopes are examined with. Each is made of the description's facets alone,
// centred on the axis, and throws InputError where a value does not fit.
#pragma once

#include "specimen/description.hpp"

namespace vkfv::specimen {

// Points of a grid over the square footprint, no further apart than pitch (but for the rounding of a quotient), all at
// height 0.
HeightField level_field(const Description& description, double pitch);

// Letters or other plateaus on a level ground, `heights[k]` over it. From text, set in a font that OpenImageIO finds, a
// letter a plateau; from an image, whose grey values other than black are plateaus in ascending order. Flanks are one
// pitch wide. Text: the k-th of its letters takes the k-th height, a single height is for all.
HeightField plateaus(const Description& description, double pitch);

// Type AIR (ISO 25178-70): irregular roughness, of tiles x tiles sub-surfaces side by side. Each is a normal random
// surface of its own whose power spectrum is constant below the frequency 1 / roll_off, falls with the power
// -2 (1 + hurst) above it and ends at 1 / shortest (B. N. J. Persson et al., "On the nature of surface roughness with
// application to contact mechanics, sealing, rubber friction and adhesion", 2005); its mean is 0 and its Sq is `sq`
// exactly. Or each is the middle of the measured surface in `file`, levelled as a whole and of mean 0. Neighbours do
// not meet in height: the seams are steps one pitch wide.
HeightField sub_surfaces(const Description& description, double pitch);

// Type ASG (ISO 25178-70): a star of `petals` raised sectors, `height` over the sectors between them, out to `radius`;
// beyond it is the lower level. The edge of a sector lies at an azimuth of 0.
HeightField star(const Description& description, double pitch);

// A groove along y of the given width between the middles of its flanks and `depth` below the level, its flanks `wall`
// wide (one pitch, if that is 0).
HeightField groove(const Description& description, double pitch);

} // namespace vkfv::specimen
