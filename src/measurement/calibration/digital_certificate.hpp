// The certificate of a virtual calibration as a digital calibration certificate (DCC), the XML in which laboratories
// exchange calibrations.
#pragma once

#include "measurement/calibration/certificate.hpp"

#include <string>

namespace vkfv::measurement {

// The figures and conditions of the certificate by version 3.3.0 of the schema https://ptb.de/dcc, each as a quantity
// of the D-SI (https://ptb.de/si) in its unit of certificate.json. Data of persons and laboratories, which a simulation
// does not have, say so. identifier: one of this certificate alone, without white space. date: "2026-01-31", of its
// beginning and end; empty for an unknown one, which the schema does not know and which is written as 1970-01-01, with
// a statement.
std::string digital_certificate(const Certificate& certificate, const std::string& identifier, const std::string& date);

} // namespace vkfv::measurement
