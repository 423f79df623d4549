#include "measurement/image/camera_report.hpp"

#include "measurement/scene/warning_json.hpp"

#include "report/chart.hpp"

#include <fmt/format.h>

#include <array>
#include <cmath>

namespace vkfv::measurement {

namespace {

using camera::MeasuredFigure;
using camera::PairLevel;
using camera::PhotonTransferFigures;

constexpr double percent = 100;
constexpr glm::dvec2 panel{520, 380};
constexpr double margin = 24, head = 56;

struct Row {
    const char* name; // key in JSON, with its unit
    const char* words;
    MeasuredFigure PhotonTransferFigures::*figure;
    double unit = 1; // factor from the figure to the unit in the name
};
constexpr std::array rows = {
    Row{"gain_dn_per_e", "system gain K / (DN/e-)", &PhotonTransferFigures::gain},
    Row{"quantum_efficiency_percent", "quantum efficiency / %", &PhotonTransferFigures::quantum_efficiency, percent},
    Row{"read_noise_e", "temporal dark noise / e-", &PhotonTransferFigures::read_noise},
    Row{"saturation_capacity_e", "saturation capacity / e-", &PhotonTransferFigures::capacity},
    Row{"largest_signal_to_noise_db", "largest signal to noise ratio / dB", &PhotonTransferFigures::signal_to_noise_db},
    Row{"dynamic_range_db", "dynamic range / dB", &PhotonTransferFigures::dynamic_range_db},
    Row{"sensitivity_threshold_photons", "absolute sensitivity threshold / photons", &PhotonTransferFigures::threshold},
    Row{"dsnu_e", "DSNU / e-", &PhotonTransferFigures::dark_signal},
    Row{"prnu_percent", "PRNU / %", &PhotonTransferFigures::photo_response, percent},
    Row{"dark_current_e_per_s", "dark current / (e-/s)", &PhotonTransferFigures::dark_current},
    Row{"linearity_error_percent", "linearity error / %", &PhotonTransferFigures::linearity_error, percent}};

std::string document(report::Svg& svg, const std::string& title, int panels) {
    svg.text({margin, 34}, title, "font-size=\"19\" fill=\"#111111\"");
    return svg.document(glm::dvec2(margin + (panel.x + margin) * panels, head + panel.y + margin), title);
}

glm::dvec2 corner(int place) {
    return {margin + (panel.x + margin) * place, head};
}

// The mean grey value of a level, above the dark one.
double signal_of(const CameraMeasurement& measurement, const PairLevel& level) {
    return mean_value(level) - mean_value(measurement.data.series.front());
}

} // namespace

CameraMeasurement measure_camera(const camera::Camera& camera, const camera::PhotonTransferOptions& options,
                                 const camera::ImageTaker& take) {
    auto data = camera::measure_photon_transfer(camera, options, take);
    const auto figures = camera::photon_transfer_figures(data);
    return {.camera = camera,
            .options = options,
            .data = std::move(data),
            .figures = figures,
            .expected = camera::expected_figures(camera)};
}

std::string summary(const CameraMeasurement& measurement) {
    std::string text = fmt::format("{:<42} {:>12} {:>12} {:>10} {:>11}\n", "EMVA 1288, photon transfer", "put in",
                                   "measured", "std error", "deviation");
    for (const Row& row : rows) {
        const auto& [value, error, bounded] = measurement.figures.*row.figure;
        const double expected = (measurement.expected.*row.figure).value;
        if (!std::isfinite(value)) {
            continue;
        }
        const std::string measured = fmt::format("{}{:.6g}", bounded ? "< " : "", value * row.unit);
        const bool compared = expected > 0 && !bounded;
        text += fmt::format("{:<42} {:>12.6g} {:>12} {:>10} {:>11}\n", row.words, expected * row.unit, measured,
                            bounded ? "" : fmt::format("{:.2g}", error * row.unit),
                            compared ? fmt::format("{:+.2f} %", percent * (value / expected - 1)) : "");
    }
    return text +
           fmt::format("of {} pairs of images, and 2 x {} averaged ones, {} x {} pixels; a pixel's charge ends at "
                       "{:.0f} e-\n",
                       measurement.data.series.size() + measurement.data.peak.size(), measurement.data.averaged,
                       measurement.options.columns, measurement.options.rows, measurement.camera.clip());
}

nlohmann::ordered_json camera_json(const CameraMeasurement& measurement) {
    nlohmann::ordered_json json;
    for (const Row& row : rows) {
        const auto& [value, error, bounded] = measurement.figures.*row.figure;
        const double expected = (measurement.expected.*row.figure).value;
        if (!std::isfinite(value)) {
            continue;
        }
        auto& figure = json[row.name] = {{"put_in", expected * row.unit}};
        if (bounded) {
            figure["below"] = value * row.unit;
        } else {
            figure["measured"] = value * row.unit;
            figure["standard_error"] = error * row.unit;
        }
    }
    json["clip_e"] = measurement.camera.clip();
    json["columns"] = measurement.options.columns;
    json["rows"] = measurement.options.rows;
    json["exposures"] = measurement.options.exposures;
    json["averaged"] = measurement.options.averaged;
    json["flat_photons"] = measurement.data.flat_photons;
    json["offset_dn"] = measurement.camera.options().offset;
    json["bit_depth"] = measurement.camera.options().bit_depth;
    json["seed"] = measurement.camera.options().seed;
    auto warnings = warnings_of(measurement.camera);
    const auto further = warnings_of(measurement);
    warnings.insert(warnings.end(), further.begin(), further.end());
    json["warnings"] = json_of(warnings);
    return json;
}

std::vector<Warning> warnings_of(const CameraMeasurement& measurement) {
    std::vector<Warning> warnings;
    if (const auto& noise = measurement.figures.read_noise; noise.bounded) {
        warnings.push_back(
            {.code = "quantisation",
             .key = "camera.gain_dn_per_e",
             .value = number_text(measurement.camera.options().gain),
             .works = "a larger one",
             .sentence = fmt::format(
                 "Quantisation dominates the noise in the dark, whose variance is below 0.24 DN^2: the temporal "
                 "dark noise is not measured, but below {:.3g} e- (EMVA 1288), and DSNU is that of rounded "
                 "values, which may be far from the pixels'. A larger camera.gain_dn_per_e would show both",
                 noise.value)});
    }
    return warnings;
}

std::vector<Warning> warnings_of(const camera::Camera& camera) {
    std::vector<Warning> warnings;
    const auto& options = camera.options();
    if (camera.converter_end() < camera.clip()) {
        warnings.push_back(
            {.code = "grey-values-end",
             .key = "camera.gain_dn_per_e",
             .value = number_text(options.gain),
             .works = number_text(options.gain * camera.converter_end() / camera.clip(), Rounding::down),
             .sentence = fmt::format("Grey values end at {:.0f} e-, before a pixel's charge does, at {:.0f} e-: the "
                                     "camera saturates below its "
                                     "full_well_e. Take a smaller camera.gain_dn_per_e or offset_dn, or more bits.",
                                     camera.converter_end(), camera.clip())});
    }
    constexpr double deviations = 4;
    const double spread = options.gain * std::hypot(camera.temporal_noise(0), options.dark_signal);
    if (options.offset < deviations * spread) {
        warnings.push_back(
            {.code = "dark-cut-off",
             .key = "camera.offset_dn",
             .value = number_text(options.offset),
             .works = number_text(deviations * spread, Rounding::up),
             .sentence = fmt::format("Grey values of the dark spread by {:.2g} DN, and camera.offset_dn = {:g} cuts "
                                     "some of them off at 0. Take at least {:.2g}.",
                                     spread, options.offset, deviations * spread)});
    }
    return warnings;
}

std::string transfer_chart(const CameraMeasurement& measurement) {
    const auto& [camera, options, data, figures, expected] = measurement;
    const double dark_variance = temporal_variance(data.series.front());
    std::vector<report::Curve> curves(2);
    curves[0] = {.name = "pairs of images", .points = {}, .spreads = {}, .line = false, .markers = true};
    curves[1] = {.name = fmt::format("K = {:.4g} DN/e-", figures.gain.value), .points = {}, .spreads = {}};
    for (const auto* levels : {&data.series, &data.peak}) {
        for (const auto& level : *levels) {
            curves[0].points.emplace_back(signal_of(measurement, level), temporal_variance(level) - dark_variance);
        }
    }
    const double end = figures.gain.value * figures.capacity.value;
    curves[1].points = {{0, 0}, {end, figures.gain.value * end}};
    report::Svg svg;
    report::draw_chart(svg, corner(0), panel, "temporal variance, that of the dark taken off",
                       report::axis_over(curves, 0, "grey value over the dark / DN"),
                       report::axis_over(curves, 1, "variance / DN^2"), curves);
    return document(svg, "Photon transfer", 1);
}

std::string signal_to_noise_chart(const CameraMeasurement& measurement) {
    const auto& [camera, options, data, figures, expected] = measurement;
    std::vector<report::Curve> curves(3);
    curves[0] = {.name = "measured", .points = {}, .spreads = {}, .line = false, .markers = true};
    curves[1] = {.name = "of the values put in", .points = {}, .spreads = {}};
    curves[2] = {.name = "ideal", .points = {}, .spreads = {}};
    for (const auto& level : data.series) {
        const double photons = level.photons, electrons = photons * camera.quantum_efficiency();
        if (photons <= 0 || electrons > camera.options().full_well) {
            continue;
        }
        curves[0].points.emplace_back(photons, signal_of(measurement, level) / std::sqrt(temporal_variance(level)));
        curves[1].points.emplace_back(photons, electrons / camera.temporal_noise(electrons));
        curves[2].points.emplace_back(photons, std::sqrt(photons));
    }
    report::Svg svg;
    report::draw_chart(svg, corner(0), panel, "signal to noise ratio",
                       report::axis_over(curves, 0, "photons a pixel", true),
                       report::axis_over(curves, 1, "signal over temporal noise", true), curves);
    return document(svg, "Signal to noise ratio", 1);
}

std::string linearity_chart(const CameraMeasurement& measurement) {
    const auto& [camera, options, data, figures, expected] = measurement;
    std::vector<report::Curve> values(2), deviations(1);
    values[0] = {.name = "measured", .points = {}, .spreads = {}, .line = false, .markers = true};
    values[1] = {.name = "responsivity", .points = {}, .spreads = {}};
    deviations[0] = {.name = "", .points = {}, .spreads = {}, .line = true, .markers = true};
    const double responsivity = figures.gain.value * figures.quantum_efficiency.value; // DN a photon
    for (const auto& level : data.series) {
        const double signal = signal_of(measurement, level), fitted = responsivity * level.photons;
        values[0].points.emplace_back(level.photons, signal);
        values[1].points.emplace_back(level.photons, fitted);
        if (level.photons > 0 && level.photons * figures.quantum_efficiency.value < figures.capacity.value) {
            deviations[0].points.emplace_back(level.photons, percent * (signal / fitted - 1));
        }
    }
    report::Svg svg;
    report::draw_chart(svg, corner(0), panel, "grey value over the dark",
                       report::axis_over(values, 0, "photons a pixel"), report::axis_over(values, 1, "DN"), values);
    report::draw_chart(svg, corner(1), panel, "deviation from the line",
                       report::axis_over(deviations, 0, "photons a pixel"), report::axis_over(deviations, 1, "%"),
                       deviations);
    return document(svg, "Linearity", 2);
}

std::string transfer_table(const CameraMeasurement& measurement) {
    std::string text = "series,photons,exposure_s,mean_dn,variance_dn2\n";
    const auto add = [&](const char* series, const std::vector<PairLevel>& levels) {
        for (const auto& level : levels) {
            text += fmt::format("{},{},{},{},{}\n", series, level.photons, level.exposure_time, mean_value(level),
                                temporal_variance(level));
        }
    };
    add("transfer", measurement.data.series);
    add("peak", measurement.data.peak);
    add("dark current", measurement.data.dark);
    return text;
}

} // namespace vkfv::measurement
