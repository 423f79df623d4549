// Prescriptions as TOML, the way assets/ holds them.
#pragma once

#include "optics/prescriptions/prescription.hpp"

#include <string>

namespace vkfv::optics {

// Text that load_prescription reads back to the same bits; but zeros lose their sign, and what Prescription
// does not hold, such as comments, is not there. Numbers are the shortest that do.
std::string prescription_text(const Prescription& prescription);

} // namespace vkfv::optics
