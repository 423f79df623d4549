// Writes prescriptions as TOML, in the layout of assets/.
#pragma once

#include "optics/prescriptions/prescription.hpp"

#include <string>

namespace vkfv::optics {

// TOML text that load_prescription() reads back to the same bits, in the shortest decimals that do so. Zeros lose their
// sign, and content that Prescription does not hold, such as comments, is lost.
std::string prescription_text(const Prescription& prescription);

} // namespace vkfv::optics
