// A centred illumination as polynomials of the ray at the source: shaders/physics/train_polynomials.glsl.
#pragma once

#include "optics/instrument/instrument.hpp"
#include "physics/physics.hpp"

#include <optional>

namespace vkfv::optics {

struct FittedTrain {
    physics::f64::TrainPolynomials polynomials{};
    // The largest errors among sampled rays that pass: of the position in the plane of best focus (mm), and of the
    // direction's transverse part.
    double place_error = 0;
    double direction_error = 0;
    double traced_share = 0; // share of sampled rays too near to an edge for the polynomials
};

// Fits the illumination of an instrument: polynomials of the least degrees whose errors are within a fifth of a
// micrometre and a 4000th of the lit circle's radius, and within 2e-5 in direction. None if that takes a degree above
// the highest, if too much light passes near edges, or if the light depends on more than its ray (displaced parts,
// several wavelengths, losses, a light field) or comes from a ring.
std::optional<FittedTrain> fit_illumination(const Instrument& instrument);

} // namespace vkfv::optics
