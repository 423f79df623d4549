// A centred illumination as polynomials of the ray at the source: shaders/physics/train_polynomials.glsl.
#pragma once

#include "optics/instrument/instrument.hpp"
#include "physics/physics.hpp"

#include <optional>

namespace vkfv::optics {

struct FittedTrain {
    physics::f64::TrainPolynomials polynomials{};
    // The largest errors among sampled rays that pass: of the place in the plane of best focus, mm, and of the
    // direction's part across the axis.
    double place_error = 0;
    double direction_error = 0;
    double traced_share = 0; // of sampled rays, those too near to an edge for the polynomials to tell
};

// Of the illumination of an instrument: polynomials of the least degrees that are off by no more than a fifth of a
// micrometre and a 4000th of the lit circle's radius, and by 2e-5 in direction. None where that takes a higher
// degree than there is, where too much light passes near edges, and where the light depends on more than its ray
// (parts displaced, several wavelengths, losses, a field of light) or comes from a ring.
std::optional<FittedTrain> fit_illumination(const Instrument& instrument);

} // namespace vkfv::optics
