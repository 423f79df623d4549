// Warns of glasses whose dispersion the instrument's own prescriptions do not state.
#pragma once

#include "optics/instrument/instrument.hpp"

#include <string>
#include <vector>

namespace vkfv::optics {

// Returns a sentence for the user if the light of the description reaches wavelengths at which indices of its glasses
// are estimated (Medium::dispersion_uncertainty); an empty list otherwise. Throws InputError for a wavelength out of a
// glass's range.
std::vector<Warning> warning_of_unknown_dispersion(const InstrumentDescription& description);

} // namespace vkfv::optics
