// An exposure of an interferometer as tracers hand it over.
#pragma once

#include "fields/interferometer.hpp"

namespace vkfv::fields {

// Throws RunError where the fields do not hold for the position.
void require_in_range(FocalRange range, trace::FocalPosition position);

// The exposure of these fluxes, with its ledger.
trace::Image exposure_image(const FringeFields& fields, Grid<double> flux);

} // namespace vkfv::fields
