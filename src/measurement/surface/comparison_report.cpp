#include "measurement/surface/comparison_report.hpp"

#include "core/files/result_folder.hpp"
#include "core/mathematics/units.hpp"
#include "core/messages/json_text.hpp"
#include "core/messages/safe_text.hpp"
#include "measurement/surface/surface_report.hpp"
#include "report/parameter_table.hpp"
#include "report/topography_picture.hpp"
#include "surface_files/height_image.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>

namespace vkfv::measurement {

namespace {

using Json = nlohmann::ordered_json;

// A mean over the measurements, and its standard error from their scatter, NaN for a single measurement.
struct MeanAndError {
    double mean = 0;
    double error = 0;
};

MeanAndError mean_and_error(const std::vector<double>& values) {
    const double n = static_cast<double>(values.size());
    double sum = 0, squares = 0;
    for (const double value : values) {
        sum += value;
    }
    for (const double value : values) {
        squares += (value - sum / n) * (value - sum / n);
    }
    return {sum / n, n > 1 ? std::sqrt(squares / (n - 1) / n) : std::numeric_limits<double>::quiet_NaN()};
}

template <class Figure>
MeanAndError over(const topography::Comparison& comparison, const Figure& figure) {
    std::vector<double> values;
    for (const auto& measurement : comparison.measurements) {
        values.push_back(figure(measurement));
    }
    return mean_and_error(values);
}

// One parameter over the measurements, and that of the truth under them.
struct ComparedParameter {
    report::ParameterRow named; // name and unit only
    MeanAndError measured;
    double truth = 0;
};

std::vector<ComparedParameter> compared_parameters(const topography::Comparison& comparison) {
    std::vector<std::vector<report::ParameterRow>> measured, truth;
    for (const auto& measurement : comparison.measurements) {
        measured.push_back(report::parameter_rows(measurement.measured));
        truth.push_back(report::parameter_rows(measurement.truth));
    }
    const auto of = [](const std::vector<std::vector<report::ParameterRow>>& rows, std::size_t k) {
        std::vector<double> values;
        for (const auto& row : rows) {
            values.push_back(row[k].value);
        }
        return mean_and_error(values);
    };
    std::vector<ComparedParameter> result;
    for (std::size_t k = 0; k < measured.front().size(); ++k) {
        result.push_back({measured.front()[k], of(measured, k), of(truth, k).mean});
    }
    return result;
}

Json shift_json(const topography::LateralShift& shift) {
    return {{"x_um", shift.x * um_per_mm}, {"y_um", shift.y * um_per_mm}, {"correlation", shift.correlation}};
}

// NaN (not measured, undefined) becomes null.
Json json_of(const topography::Comparison& comparison, const ComparisonRequest& request) {
    const auto add = [](Json& object, const std::string& name, const MeanAndError& value) {
        object[name] = value.mean;
        object[name + "_standard_error"] = value.error;
    };
    Json report;
    auto measured = Json::array();
    for (std::size_t k = 0; k < comparison.measurements.size(); ++k) {
        const auto& one = comparison.measurements[k];
        measured.push_back({{"file", request.measurements[k].string()},
                            {"measured_share", one.deviation.measured_share},
                            {"lateral_shift", shift_json(one.shift)},
                            {"sq_measured_um", one.deviation.sq_measured * um_per_mm},
                            {"sq_true_um", one.deviation.sq_true * um_per_mm},
                            {"rms_deviation_um", one.deviation.rms * um_per_mm},
                            {"correlation", one.deviation.correlation},
                            {"regression_slope", one.deviation.slope},
                            {"regression_offset_um", one.deviation.offset * um_per_mm}});
    }
    report["measured"] = std::move(measured);
    report["truth"] = request.truth.string();
    report["treatment"] = report::treatment_json(request.band);
    report["aligned"] = request.align;
    report["removed_shift_um"] = {comparison.removed_shift.x * um_per_mm, comparison.removed_shift.y * um_per_mm};
    add(report, "measured_share", over(comparison, [](const auto& one) { return one.deviation.measured_share; }));
    add(report, "rms_deviation_um", over(comparison, [](const auto& one) { return one.deviation.rms * um_per_mm; }));
    add(report, "correlation", over(comparison, [](const auto& one) { return one.deviation.correlation; }));
    add(report, "regression_slope", over(comparison, [](const auto& one) { return one.deviation.slope; }));
    add(report, "regression_offset_um",
        over(comparison, [](const auto& one) { return one.deviation.offset * um_per_mm; }));
    if (comparison.parts) {
        report["systematic_um"] = comparison.parts->systematic * um_per_mm;
        report["systematic_um_standard_error"] = comparison.parts->systematic_error * um_per_mm;
        report["random_um"] = comparison.parts->random * um_per_mm;
        report["random_um_standard_error"] = comparison.parts->random_error * um_per_mm;
        report["repeated_points"] = comparison.parts->points;
    }
    for (const auto& row : compared_parameters(comparison)) {
        report["parameters"][row.named.key()] = {
            {"measured", row.measured.mean}, {"standard_error", row.measured.error}, {"true", row.truth}};
    }
    report["std_direction"] = report::std_direction;
    report["compared_by"] = fmt::format("vkfv {}", VKFV_VERSION);
    return report;
}

std::string with_error(const MeanAndError& value, double factor, const char* unit) {
    return std::isnan(value.error)
               ? fmt::format("{:.4g} {}", value.mean * factor, unit)
               : fmt::format("{:.4g} +- {:.2g} {}", value.mean * factor, value.error * factor, unit);
}

std::string ratio_text(double ratio) {
    return std::isnan(ratio) ? "-" : fmt::format("{:.3f}", ratio);
}

std::string text_of(const topography::Comparison& comparison, const ComparisonRequest& request) {
    const auto share = over(comparison, [](const auto& one) { return one.deviation.measured_share; });
    if (!(share.mean > 0)) {
        return "no point is present in both: the measurement or the truth has no heights where they overlap.\n";
    }
    std::string text = fmt::format("{:<22} {} of the points\n", "measured", with_error(share, 100, "%"));
    const auto& measurements = comparison.measurements;
    for (std::size_t k = 0; k < measurements.size(); ++k) {
        const auto& shift = measurements[k].shift;
        const auto where =
            measurements.size() > 1 ? " of " + safe_line(request.measurements[k].string()) : std::string();
        text += std::isnan(shift.x)
                    ? fmt::format("{:<22} not found{}\n", "lateral shift", where)
                    : fmt::format("{:<22} x {:+.4f} um, y {:+.4f} um (correlation {:.4f}){}\n", "lateral shift",
                                  shift.x * um_per_mm, shift.y * um_per_mm, shift.correlation, where);
    }
    text += fmt::format("{:<22} {}\n", "",
                        request.align
                            ? fmt::format("removed: x {:+.4f} um, y {:+.4f} um", comparison.removed_shift.x * um_per_mm,
                                          comparison.removed_shift.y * um_per_mm)
                            : "not removed (--align removes it)");
    text += fmt::format("{:<22} {}\n", "treatment", report::treatment_text(request.band));
    text +=
        fmt::format("{:<22} {}\n", "RMS deviation",
                    with_error(over(comparison, [](const auto& one) { return one.deviation.rms; }), um_per_mm, "um"));
    if (comparison.parts) {
        const auto& parts = *comparison.parts;
        text += fmt::format("{:<22} {}\n", "  systematic",
                            with_error({parts.systematic, parts.systematic_error}, um_per_mm, "um"));
        text += fmt::format("{:<22} {}\n", "  random", with_error({parts.random, parts.random_error}, um_per_mm, "um"));
    }
    text += fmt::format("{:<22} {}\n", "correlation",
                        with_error(over(comparison, [](const auto& one) { return one.deviation.correlation; }), 1, ""));
    // A true surface without relief has no slope of the measured on the true heights.
    if (const auto slope = over(comparison, [](const auto& one) { return one.deviation.slope; });
        std::isfinite(slope.mean)) {
        text += fmt::format(
            "{:<22} slope {}, offset {}\n", "measured on true", with_error(slope, 1, "um per um"),
            with_error(over(comparison, [](const auto& one) { return one.deviation.offset; }), um_per_mm, "um"));
    }
    text +=
        fmt::format("\n{:<21} {:>12} {:>12} {:>12} {:>8}\n", "ISO 25178-2", "measured", "std. error", "true", "ratio");
    for (const auto& row : compared_parameters(comparison)) {
        const double ratio = topography::ratio_to_truth(row.measured.mean, row.truth);
        text += fmt::format("{:<8} {:<12} {:>12} {:>12} {:>12} {:>8}\n", row.named.name, row.named.unit,
                            report::number_text(row.measured.mean), report::number_text(row.measured.error),
                            report::number_text(row.truth), row.named.unit == "deg" ? "-" : ratio_text(ratio));
    }
    return text;
}

std::string transfer_csv(const topography::Comparison& comparison) {
    std::string text = "frequency_per_mm,wavelength_um,transfer,standard_error,coherence,measured_power_um4,"
                       "true_power_um4\n";
    const double um4 = std::pow(um_per_mm, 4);
    for (const auto& band : comparison.transfer) {
        text += fmt::format("{:.6g},{:.6g},{:.6g},{:.3g},{:.6g},{:.6g},{:.6g}\n", band.frequency,
                            um_per_mm / band.frequency, band.transfer, band.standard_error, band.coherence,
                            band.measured_power * um4, band.true_power * um4);
    }
    return text;
}

// CSV of the deviation by slope. A field is empty where no point was measured.
std::string slope_csv(const topography::Comparison& comparison) {
    std::string text = "slope_from_deg,slope_to_deg,points,measured_share,bias_um,rms_um\n";
    for (const auto& bin : comparison.slopes) {
        const auto um = [](double value) { return std::isnan(value) ? "" : fmt::format("{:.6g}", value * um_per_mm); };
        text += fmt::format("{:g},{:g},{:.0f},{:.6g},{},{}\n", bin.from / radians_per_degree,
                            bin.to / radians_per_degree, bin.points, bin.measured_share, um(bin.bias), um(bin.rms));
    }
    return text;
}

Json profile_json(const ComparedProfile& profile) {
    return {{"y_um", profile.line.y_start * um_per_mm},
            {"section_length_um", profile.measured.section_length * um_per_mm},
            {"l_filter_um", profile.measured.l_filter * um_per_mm},
            {"measured", json_of(report::parameter_rows(profile.measured.parameters))},
            {"true", json_of(report::parameter_rows(profile.truth.parameters))}};
}

std::string profile_text(const ComparedProfile& profile) {
    std::string text = fmt::format("\nISO 21920-2, profile at y = {:.4g} um, {}\n", profile.line.y_start * um_per_mm,
                                   profile_filter_text(profile.measured));
    const auto measured = report::parameter_rows(profile.measured.parameters),
               truth = report::parameter_rows(profile.truth.parameters);
    for (std::size_t k = 0; k < measured.size(); ++k) {
        const double ratio = topography::ratio_to_truth(measured[k].value, truth[k].value);
        text += fmt::format("{:<8} {:<12} {:>12} {:>12} {:>12} {:>8}\n", measured[k].name, measured[k].unit,
                            report::number_text(measured[k].value), "-", report::number_text(truth[k].value),
                            ratio_text(ratio));
    }
    return text;
}

// CSV of the profiles. A field is empty where no point was measured.
std::string profile_csv(const ComparedProfile& profile, const surface::HeightMap& measured) {
    std::string text = "x_um,measured_um,true_um\n";
    const auto um = [](double value) { return std::isnan(value) ? "" : fmt::format("{:.6g}", value * um_per_mm); };
    const auto &a = profile.measured.profile.height, &b = profile.truth.profile.height;
    for (std::size_t k = 0; k < std::min(a.size(), b.size()); ++k) {
        text += fmt::format("{:.6g},{},{}\n", measured.x(static_cast<int>(k)) * um_per_mm, um(a[k]), um(b[k]));
    }
    return text;
}

// `pair` is the first measurement and the truth under it, both treated.
std::string picture_of(const topography::Comparison& comparison, topography::LevelledPair pair,
                       const std::string& title) {
    report::Curve transfer{.name = "transfer", .points = {}, .spreads = {}};
    report::Curve coherence{.name = "coherence", .points = {}, .spreads = {}};
    for (const auto& band : comparison.transfer) {
        transfer.points.emplace_back(band.frequency, band.transfer);
        coherence.points.emplace_back(band.frequency, band.coherence);
    }
    report::Curve bias{.name = "bias / um", .points = {}, .spreads = {}};
    report::Curve rms{.name = "RMS / um", .points = {}, .spreads = {}};
    report::Curve share{.name = "share measured", .points = {}, .spreads = {}};
    for (const auto& bin : comparison.slopes) {
        const double middle = 0.5 * (bin.from + bin.to) / radians_per_degree;
        bias.points.emplace_back(middle, bin.bias * um_per_mm);
        rms.points.emplace_back(middle, bin.rms * um_per_mm);
        share.points.emplace_back(middle, bin.measured_share);
    }
    return report::topography_picture(
        {.title = title,
         .measured = std::move(pair.measured),
         .truth = std::move(pair.truth),
         .deviation = comparison.deviation,
         .all_in_focus = {},
         .charts = {{"Height transfer", "spatial frequency / (1/mm)", "", {transfer, coherence}, true},
                    {"Deviation by slope", "slope of the truth / deg", "", {bias, rms, share}}}});
}

} // namespace

Json comparison_json(const ComparisonRequest& request, const ComparisonResult& result) {
    auto report = json_of(result.comparison, request);
    report["profile"] = profile_json(result.profile);
    report["warnings"] = result.warnings;
    return report;
}

std::string comparison_text(const ComparisonRequest& request, const ComparisonResult& result) {
    return text_of(result.comparison, request) + profile_text(result.profile);
}

void write_comparison(const std::filesystem::path& folder, const ComparisonRequest& request,
                      const ComparisonResult& result) {
    const auto& comparison = result.comparison;
    ResultFolder results(folder);
    results.write("compare.json", json_text(comparison_json(request, result)) + "\n");
    results.write("transfer.csv", transfer_csv(comparison));
    results.write("slope.csv", slope_csv(comparison));
    results.write("profile.csv", profile_csv(result.profile, result.pair.measured));
    results.write("deviation.tif", surface::height_map_bytes(comparison.deviation));
    results.write("compare.svg", picture_of(comparison, result.pair,
                                            fmt::format("{} against {}", request.measurements.front().string(),
                                                        request.truth.string())));
    if (comparison.parts) {
        results.write("random.tif", surface::height_map_bytes(comparison.parts->standard_deviation));
    }
    results.write_checksums();
}

} // namespace vkfv::measurement
