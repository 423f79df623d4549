// The certificate of a virtual calibration as a digital calibration certificate (DCC), the XML in which laboratories
// exchange calibrations.
#pragma once

#include "measurement/calibration/certificate.hpp"

#include <string>

namespace vkfv::measurement {

// The figures and conditions of the certificate by version 3.3.0 of the schema https://ptb.de/dcc, each as a quantity
// of the D-SI (https://ptb.de/si) in its unit of certificate.json. The schema demands data of a laboratory, a person
// and a customer, which a simulation does not have: they are given as none. Throws std::logic_error for a unit of a
// figure that has no name of the D-SI here. identifier: one of this certificate alone, without white space. date: of
// the beginning and the end, "2026-01-31"; empty if it is not known. The schema knows no unknown date: 1970-01-01 then
// stands for it, with a statement that says so.
std::string digital_certificate(const Certificate& certificate, const std::string& identifier, const std::string& date);

} // namespace vkfv::measurement
