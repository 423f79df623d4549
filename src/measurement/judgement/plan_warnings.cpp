#include "measurement/judgement/plan_warnings.hpp"

#include "core/mathematics/units.hpp"
#include "measurement/scene/assembly.hpp"
#include "measurement/scene/disk_space.hpp"
#include "measurement/scene/host_memory.hpp"
#include "measurement/scene/known_truth.hpp"
#include "measurement/scene/wave_devices.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstdint>

namespace vkfv::measurement {

namespace {

// The facts that all warnings of the plan depend on. Lengths in mm.
struct Plan {
    const Configuration& configuration;
    const optics::FirstOrder& first_order;
    const Relief& relief;
    std::vector<double> positions;
    double depth = 0; // depth of field, mm

    double first() const { return positions.front(); }
    double last() const { return positions.back(); }
    double z_step() const { return configuration.scan->z_step; }
    double z_stop() const { return configuration.scan->z_stop; }
    double z_start() const { return configuration.scan->z_start; }
};

std::string um_text(double mm, Rounding rounding = Rounding::nearest) {
    return number_text(mm * um_per_mm, rounding);
}

void warn_of_depth(const Plan& plan, std::vector<Warning>& warnings) {
    const double range = plan.last() - plan.first();
    if (!(range < plan.depth)) {
        return;
    }
    const bool seen = plan.relief.seen_share > 0;
    const double wanted = std::max(plan.first() + 2 * plan.depth, (seen ? plan.relief.highest : 0) + plan.depth);
    warnings.push_back({.code = "scan-in-depth-of-field",
                        .key = "scan.z_stop_um",
                        .value = um_text(plan.z_stop()),
                        .works = um_text(wanted, Rounding::up),
                        .sentence = fmt::format(
                            "The scan, {:.4g} um from its first image to its last, lies inside the depth of field, "
                            "{:.4g} um: no image is out of focus, and focus has no maximum. Scan a depth of field "
                            "beyond the specimen on either side.",
                            range * um_per_mm, plan.depth * um_per_mm)});
}

void warn_of_step(const Plan& plan, std::vector<Warning>& warnings) {
    const double coarsest = 0.5 * plan.first_order.depth_of_field;
    // The tolerance keeps rounding of the step from counting.
    if (plan.positions.size() > 1 && plan.z_step() > coarsest * (1 + 1e-9)) {
        warnings.push_back(
            {.code = "coarse-steps",
             .key = "scan.z_step_um",
             .value = um_text(plan.z_step()),
             .works = um_text(coarsest, Rounding::down),
             .sentence = fmt::format("The scan's step, {:.4g} um, is coarser than half the depth of field, {:.4g} "
                                     "um: peaks of focus fall between images.",
                                     plan.z_step() * um_per_mm, coarsest * um_per_mm)});
    }
}

void warn_of_range(const Plan& plan, std::vector<Warning>& warnings) {
    const Relief& relief = plan.relief;
    if (!(relief.seen_share > 0)) {
        return;
    }
    const auto [lower, higher] =
        std::minmax({0.0, -plan.first_order.field_curvature, -plan.first_order.field_curvature_corner});
    const bool beyond = relief.lowest < plan.first() || relief.highest > plan.last();
    const double lowest = relief.lowest + (beyond ? 0 : lower), highest = relief.highest + (beyond ? 0 : higher);
    const std::string sentence =
        beyond ? fmt::format("the specimen reaches from {:.3g} to {:.3g} um, beyond the scan: what lies outside will "
                             "not be measured",
                             lowest * um_per_mm, highest * um_per_mm)
               : fmt::format("The field is curved: the specimen comes into focus between {:.3g} and {:.3g} um there, "
                             "beyond the scan.",
                             lowest * um_per_mm, highest * um_per_mm);
    const char* const code = beyond ? "scan-misses-specimen" : "scan-misses-curved-field";
    // A point at the end of the scan has no maximum of focus there, so the scan must reach half a depth of focus beyond
    // it.
    if (lowest < plan.first()) {
        warnings.push_back({.code = code,
                            .key = "scan.z_start_um",
                            .value = um_text(plan.z_start()),
                            .works = um_text(lowest - 0.5 * plan.depth, Rounding::down),
                            .sentence = sentence});
    }
    if (highest > plan.last()) {
        warnings.push_back({.code = code,
                            .key = "scan.z_stop_um",
                            .value = um_text(plan.z_stop()),
                            .works = um_text(highest + 0.5 * plan.depth + plan.z_step(), Rounding::up),
                            .sentence = sentence});
    }
}

void warn_of_window(const Plan& plan, std::vector<Warning>& warnings) {
    constexpr double most_share = 0.5;
    constexpr int usual = 7, least = 3;
    const ImageSize pixels = plan.configuration.instrument.detector_pixels;
    const int side = std::min(pixels.columns, pixels.rows), window = plan.configuration.topography.window_px;
    if (!(window > most_share * side)) {
        return;
    }
    const int quarter = side / 4;
    const int works = std::clamp(quarter - (quarter % 2 == 0 ? 1 : 0), least, usual);
    const bool fits = works <= most_share * side;
    warnings.push_back({.code = "wide-window",
                        .key = fits ? "topography.window_px" : "detector.pixels",
                        .value = fits ? std::to_string(window) : text_of(pixels),
                        .works = fits ? std::to_string(works) : "64",
                        .sentence = fmt::format(
                            "The focus measure's window, {} pixels, is as wide as the image, {} pixels, or nearly: "
                            "all points see the same texture and get nearly the same height.",
                            window, side)});
}

void warn_of_smoothing(const Plan& plan, const optics::Instrument& instrument, std::vector<Warning>& warnings) {
    if (!plan.configuration.topography.smoothing_steps &&
        evaluation_options(plan.configuration, instrument).smoothing_steps == topography::most_smoothing_steps) {
        const double deviation = focus_curve_deviation(plan.configuration, plan.first_order);
        warnings.push_back({.code = "fine-steps",
                            .key = "scan.z_step_um",
                            .value = um_text(plan.z_step()),
                            .works = um_text(deviation / topography::most_smoothing_steps, Rounding::up),
                            .sentence = fmt::format(
                                "The scan's steps are so fine that the average along z, "
                                "topography.smoothing_steps, ends at its largest, {:g} steps, below what suits the "
                                "focus curves: noise is averaged less. Take coarser steps.",
                                topography::most_smoothing_steps)});
    }
}

// Waves have warnings of their own (wave_warnings_of_device()).
void warn_of_host_images(const Configuration& configuration, std::vector<Warning>& warnings) {
    if (configuration.trace.device != "host" || configuration.trace.waves) {
        return;
    }
    const ImageSize pixels = configuration.instrument.detector_pixels;
    const std::uint64_t bytes = counts_of_host(configuration.trace, pixels), there = memory_of_host();
    if (bytes > there) {
        warnings.push_back({.code = "memory",
                            .key = "detector.pixels",
                            .value = text_of(pixels),
                            .works = pixels_that_fit(pixels, bytes, there),
                            .sentence = fmt::format(
                                "An image of {} x {} pixels takes {} of memory where this machine's processors trace "
                                "it, and it has {}. Take fewer detector.pixels, or another trace.device.",
                                pixels.columns, pixels.rows, bytes_text(bytes), bytes_text(there))});
    }
}

void warn_of_memory(const Plan& plan, const optics::Instrument& instrument, std::vector<Warning>& warnings) {
    const double bytes = evaluation_bytes(plan.configuration, instrument);
    const auto there = static_cast<double>(memory_of_host());
    if (!(bytes > there)) {
        return;
    }
    const ImageSize pixels = plan.configuration.instrument.detector_pixels;
    constexpr double most = 9e18; // bytes, the largest number that the text can hold
    warnings.push_back({.code = "memory",
                        .key = "detector.pixels",
                        .value = text_of(pixels),
                        .works = pixels_that_fit(pixels, static_cast<std::uint64_t>(std::min(bytes, most)),
                                                 static_cast<std::uint64_t>(there)),
                        .sentence = fmt::format(
                            "The evaluation of {} x {} pixels takes {} of memory, and this machine has {}. Take "
                            "fewer detector.pixels, or a smaller topography.smoothing_steps.",
                            pixels.columns, pixels.rows, bytes_text(static_cast<std::uint64_t>(std::min(bytes, most))),
                            bytes_text(static_cast<std::uint64_t>(there)))});
}

void warn_of_assumed_pitch(const Configuration& configuration, const optics::Instrument& instrument,
                           std::vector<Warning>& warnings) {
    constexpr double most_deviation = 0.05; // far above that of any calibrated instrument
    const double true_pitch = instrument.first_order.pixel_pitch, pitch = height_pitch(instrument, configuration);
    if (std::abs(pitch - true_pitch) > most_deviation * true_pitch) {
        warnings.push_back({.code = "assumed-pitch",
                            .key = "detector.assumed_pitch_um",
                            .value = um_text(pitch),
                            .works = um_text(true_pitch),
                            .sentence = fmt::format("The instrument takes its pixels for {:.4g} um on the specimen, "
                                                    "where the lenses make them {:.4g} um: all lengths in x and y come "
                                                    "out {:.3g} times as long.",
                                                    pitch * um_per_mm, true_pitch * um_per_mm, pitch / true_pitch)});
    }
}

} // namespace

double depth_of_focus(const optics::FirstOrder& first_order) {
    return std::max(first_order.depth_of_field,
                    first_order.object_index * first_order.pixel_pitch / first_order.numerical_aperture);
}

double evaluation_bytes(const Configuration& configuration, const optics::Instrument& instrument) {
    const auto options = evaluation_options(configuration, instrument);
    const double reach = std::ceil(3 * options.smoothing_steps.value_or(0));
    const double values = 2 * reach + 2 * options.peak_range_steps + 2 + 4 * reach + 4 * options.peak_range_steps + 4;
    constexpr double bytes_a_value = 4, besides = 270 + 50;
    return static_cast<double>(configuration.instrument.detector_pixels.count()) * (bytes_a_value * values + besides);
}

std::vector<Warning> plan_warnings(const Configuration& configuration, const optics::Instrument& instrument,
                                   const Relief& relief) {
    std::vector<Warning> warnings;
    warn_of_host_images(configuration, warnings);
    warn_of_assumed_pitch(configuration, instrument, warnings);
    if (!configuration.scan) {
        return warnings;
    }
    const optics::FirstOrder& first_order = instrument.first_order;
    const Plan plan{.configuration = configuration,
                    .first_order = first_order,
                    .relief = relief,
                    .positions = configuration.scan->positions(),
                    .depth = depth_of_focus(first_order)};
    warn_of_depth(plan, warnings);
    warn_of_range(plan, warnings);
    warn_of_step(plan, warnings);
    warn_of_smoothing(plan, instrument, warnings);
    warn_of_window(plan, warnings);
    warn_of_memory(plan, instrument, warnings);
    return warnings;
}

} // namespace vkfv::measurement
