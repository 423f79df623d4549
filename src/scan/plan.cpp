#include "scan/plan.hpp"

#include "core/mathematics/units.hpp"
#include "core/messages/error.hpp"

#include <fmt/format.h>

#include <cmath>
#include <string>

namespace vkfv::scan {

namespace {

[[noreturn]] void refuse(std::string key, double millimetres, std::string expected, std::string remedy) {
    throw InputError({.where = {},
                      .key = "scan." + std::move(key),
                      .found = fmt::format("{:.9g}", millimetres * um_per_mm),
                      .expected = std::move(expected),
                      .remedy = std::move(remedy)});
}

} // namespace

double ScanPlan::position_count() const {
    constexpr double tolerance = 1e-6; // share of a step: far above rounding, far below any positioning error
    return std::floor((z_stop - z_start) / z_step + tolerance) + 1;
}

std::vector<double> ScanPlan::positions() const {
    if (!std::isfinite(z_start)) {
        refuse("z_start_um", z_start, "a finite height", "Give the lowest focal position in micrometres.");
    }
    if (!std::isfinite(z_stop) || z_stop < z_start) {
        refuse("z_stop_um", z_stop, fmt::format("a finite height not below z_start_um = {:.9g}", z_start * um_per_mm),
               "Scan upwards: the stop is the highest focal position.");
    }
    if (!std::isfinite(z_step) || z_step <= 0) {
        refuse("z_step_um", z_step, "a finite step above 0",
               "Give the distance of neighbouring focal positions in micrometres.");
    }
    const double count = position_count();
    if (count > most_positions) {
        refuse("z_step_um", z_step, fmt::format("a step that gives at most {} images", most_positions),
               "Choose a larger step or a shorter scan.");
    }
    std::vector<double> heights(static_cast<std::size_t>(count));
    for (std::size_t i = 0; i < heights.size(); ++i) {
        heights[i] = z_start + static_cast<double>(i) * z_step;
    }
    return heights;
}

} // namespace vkfv::scan
