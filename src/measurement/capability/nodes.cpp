#include "measurement/capability/nodes.hpp"

#include "core/messages/error.hpp"
#include "measurement/calibration/standards.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <string>

namespace vkfv::measurement {

namespace {
namespace of_nodes { // files of a unity build share the unnamed namespace

constexpr double longest_windows = 30;

double longest_of(const Conditions& conditions) {
    return std::min(longest_windows * conditions.window, 0.5 * conditions.field());
}

double rounded(double value, int digits) {
    return std::stod(fmt::format("{:.{}g}", value, digits));
}

// Numbers from first to last in equal ratios.
std::vector<double> in_ratios(double first, double last, int count) {
    std::vector<double> values;
    values.reserve(static_cast<std::size_t>(count));
    for (int k = 0; k < count; ++k) {
        values.push_back(rounded(first * std::pow(last / first, static_cast<double>(k) / (count - 1)), 4));
    }
    return values;
}

} // namespace of_nodes
} // namespace

bool CapabilityNode::robust() const {
    constexpr double least_right = 0.95, most_beyond = 0.01, most_bias = 0.1;
    return measured_share * (1 - beyond) >= least_right && beyond <= most_beyond && std::abs(bias) <= most_bias;
}

void require_room_for_waves(const Conditions& conditions, const std::filesystem::path& file) {
    if (conditions.usable_range() < 4 * conditions.step || !(conditions.step > 0)) {
        throw InputError(
            {.where = {.file = file},
             .key = "scan",
             .found = fmt::format("a scan of {} um in steps of {} um", um(conditions.range), um(conditions.step)),
             .expected =
                 fmt::format("a scan longer than {} um: four standard deviations of a focus curve and four steps",
                             um(4 * (conditions.curve_deviation + conditions.step))),
             .remedy = "Begin lower and end higher."});
    }
    if (of_nodes::longest_of(conditions) < 2 * conditions.window) {
        throw InputError(
            {.where = {.file = file},
             .key = "detector.pixels",
             .found = fmt::format("a field of {} um", um(conditions.field())),
             .expected = fmt::format("a field of at least four focus windows, {} um", um(4 * conditions.window)),
             .remedy = "Take more pixels, or a smaller topography.window_px."});
    }
}

std::vector<SurfaceWave> waves_of_map(const Conditions& conditions, double noise, int wavelengths, int amplitudes) {
    constexpr double least_share = 1e-3, most_share = 0.1, of_scan = 0.25;
    const double largest = std::min(of_scan * conditions.range, 0.5 * conditions.usable_range());
    // Folders are named by the amplitudes, and the last digits of an estimated noise may differ between machines.
    const double smallest = of_nodes::rounded(
        std::clamp(std::isfinite(noise) ? noise : 0.0, least_share * largest, most_share * largest), 2);
    std::vector<SurfaceWave> waves;
    waves.reserve(static_cast<std::size_t>(wavelengths) * static_cast<std::size_t>(amplitudes));
    for (const double length : of_nodes::in_ratios(conditions.window, of_nodes::longest_of(conditions), wavelengths)) {
        for (const double amplitude : of_nodes::in_ratios(smallest, largest, amplitudes)) {
            waves.push_back({.length = length, .amplitude = amplitude});
        }
    }
    return waves;
}

Trial flat_trial(const Conditions& conditions) {
    return {.name = "flat",
            .specimen = standard_of(conditions, "plane", "", conditions.pitch) +
                        printed(conditions, usual_contrast, 1) + placed_at(0, 0, conditions.middle()),
            .overrides = {}};
}

Trial trial_of(const Conditions& conditions, const SurfaceWave& wave, int number) {
    return {.name = fmt::format("wavelength_{}_um/amplitude_{}_um", um(wave.length), um(wave.amplitude)),
            .specimen =
                sinusoid_standard(conditions, wave.amplitude, wave.length, static_cast<std::uint32_t>(number + 2)),
            .overrides = repetition(conditions, number + 1)};
}

CapabilityNode node_of(const Conditions& conditions, const SurfaceWave& wave, const TrialResult& result) {
    CapabilityNode node{.wave = wave, .stack = result.name};
    const PointShares shares = point_shares(conditions, result, common_offset(result));
    node.measured_share = shares.right + shares.wrong;
    node.beyond = shares.wrong / node.measured_share;
    node.rms_error = shares.deviation;
    node.noise = result.height_noise;
    node.uncertainty = median_of(result.uncertainty.values);
    if (const auto* amplitude = dimension(result, "amplitude")) {
        node.bias = amplitude->measured.value / amplitude->truth - 1;
        node.bias_uncertainty = uncertainty_of(*amplitude) / amplitude->truth;
    }
    return node;
}

} // namespace vkfv::measurement
