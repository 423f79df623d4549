// The way of the light of a stack whose images say nothing about light that is lost.
#pragma once

#include "configuration/configuration.hpp"
#include "optics/instrument/instrument.hpp"
#include "scan/ledger_table.hpp"
#include "specimen/specimen.hpp"

#include <vector>

namespace vkfv::measurement {

// The ledger of a short forward trace at the middle one of the focal heights (mm), for images that are traced backward:
// backward paths follow only light that is detected. It takes a hundredth of the stack's rays, but between 1000 and
// 20 000, in double on the host, so that the numbers depend on the configuration alone.
scan::MeanLedger light_way(const Configuration& configuration, const optics::Instrument& instrument,
                           const specimen::Specimen& specimen, const std::vector<double>& heights);

} // namespace vkfv::measurement
