// Pictures and tables of wave_figures().
#pragma once

#include "measurement/instrument/wave_figures.hpp"

#include <string>

namespace vkfv::measurement {

// SVG with a row for each point of the field.
std::string transfer_picture(const WaveFigures& figures, const std::string& title);
std::string spread_picture(const WaveFigures& figures, const std::string& title);
std::string wavefront_picture(const WaveFigures& figures, const std::string& title);

// Tables as CSV.
std::string transfer_table(const WaveFigures& figures);
std::string spread_table(const WaveFigures& figures);
std::string encircled_table(const WaveFigures& figures);
std::string wavefront_table(const WaveFigures& figures);
std::string zernike_table(const WaveFigures& figures);

} // namespace vkfv::measurement
