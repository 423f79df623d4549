#include "app/commands.hpp"
#include "app/text_file.hpp"

#include "core/units.hpp"
#include "report/topography_picture.hpp"
#include "surface/image_file.hpp"
#include "surface/profile.hpp"
#include "surface/resample.hpp"
#include "surface/surface_file.hpp"
#include "topography/comparison.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>
#include <nlohmann/json.hpp>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <limits>

namespace vkfv::app {

namespace {

namespace fs = std::filesystem;
using Json = nlohmann::ordered_json;
using surface::HeightMap;

[[noreturn]] void refuse_file(const fs::path& file, std::string found, std::string expected, std::string remedy) {
    throw InputError({.where = {.file = file},
                      .key = "--compare",
                      .found = std::move(found),
                      .expected = std::move(expected),
                      .remedy = std::move(remedy)});
}

std::string grid_text(const HeightMap& map) {
    return fmt::format("{} x {} points, {:.6g} x {:.6g} um apart, from x = {:.6g} um, y = {:.6g} um", map.columns(),
                       map.rows(), map.pitch_x * um_per_mm, map.pitch_y * um_per_mm, map.x0 * um_per_mm,
                       map.y0 * um_per_mm);
}

// To a hundredth of a pitch everywhere.
bool same_grid(const HeightMap& a, const HeightMap& b) {
    const auto near = [](double first, double pitch, int points, double other_first, double other_pitch) {
        return std::abs(first - other_first) + points * std::abs(pitch - other_pitch) < 0.01 * pitch;
    };
    return a.columns() == b.columns() && a.rows() == b.rows() &&
           near(a.x0, a.pitch_x, a.columns(), b.x0, b.pitch_x) && near(a.y0, a.pitch_y, a.rows(), b.y0, b.pitch_y);
}

// A mean over the measurements; its standard error from their scatter, NaN for one alone.
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

struct ParameterRow {
    std::string name; // "Sa"
    std::string unit; // "um"
    MeanAndError measured;
    double truth = 0;
};

std::vector<ParameterRow> parameter_rows(const topography::Comparison& comparison) {
    using surface::ParameterUnit;
    std::vector<ParameterRow> rows;
    for (std::size_t k = 0; k < surface::named_parameters({}).size(); ++k) {
        const auto named = surface::named_parameters(comparison.measurements.front().measured)[k];
        const bool length = named.unit == ParameterUnit::length || named.unit == ParameterUnit::volume_per_area;
        const double factor = length                               ? um_per_mm
                              : named.unit == ParameterUnit::angle ? 1 / radians_per_degree
                              : named.unit == ParameterUnit::share ? 100
                                                                   : 1;
        const char* unit = named.unit == ParameterUnit::length            ? "um"
                           : named.unit == ParameterUnit::volume_per_area ? "um3_per_um2"
                           : named.unit == ParameterUnit::angle           ? "deg"
                           : named.unit == ParameterUnit::share           ? "percent"
                                                                          : "";
        const auto of = [&](const surface::ArealParameters& parameters) {
            return surface::named_parameters(parameters)[k].value * factor;
        };
        rows.push_back({std::string(named.name), unit,
                        over(comparison, [&](const auto& measurement) { return of(measurement.measured); }),
                        over(comparison, [&](const auto& measurement) { return of(measurement.truth); }).mean});
    }
    return rows;
}

Json shift_json(const topography::LateralShift& shift) {
    return {{"x_um", shift.x * um_per_mm}, {"y_um", shift.y * um_per_mm}, {"correlation", shift.correlation}};
}

// NaN (not measured, undefined) becomes null in JSON.
Json json_of(const topography::Comparison& comparison, const CommandOptions& options) {
    const auto add = [](Json& object, const std::string& name, const MeanAndError& value) {
        object[name] = value.mean;
        object[name + "_standard_error"] = value.error;
    };
    Json report;
    auto measured = Json::array();
    for (std::size_t k = 0; k < comparison.measurements.size(); ++k) {
        const auto& one = comparison.measurements[k];
        measured.push_back({{"file", options.compared_files[k].string()},
                            {"measured_share", one.deviation.measured_share},
                            {"lateral_shift", shift_json(one.shift)},
                            {"sq_measured_um", one.deviation.sq_measured * um_per_mm},
                            {"sq_true_um", one.deviation.sq_true * um_per_mm},
                            {"rms_deviation_um", one.deviation.rms * um_per_mm},
                            {"correlation", one.deviation.correlation}});
    }
    report["measured"] = std::move(measured);
    report["truth"] = options.compared_files.back().string();
    report["aligned"] = options.align;
    report["removed_shift_um"] = {comparison.removed_shift.x * um_per_mm, comparison.removed_shift.y * um_per_mm};
    add(report, "measured_share", over(comparison, [](const auto& one) { return one.deviation.measured_share; }));
    add(report, "rms_deviation_um", over(comparison, [](const auto& one) { return one.deviation.rms * um_per_mm; }));
    add(report, "correlation", over(comparison, [](const auto& one) { return one.deviation.correlation; }));
    if (comparison.parts) {
        report["systematic_um"] = comparison.parts->systematic * um_per_mm;
        report["systematic_um_standard_error"] = comparison.parts->systematic_error * um_per_mm;
        report["random_um"] = comparison.parts->random * um_per_mm;
        report["random_um_standard_error"] = comparison.parts->random_error * um_per_mm;
        report["repeated_points"] = comparison.parts->points;
    }
    for (const auto& row : parameter_rows(comparison)) {
        auto& entry = report["parameters"][row.unit.empty() ? row.name : row.name + "_" + row.unit];
        entry = {{"measured", row.measured.mean}, {"standard_error", row.measured.error}, {"true", row.truth}};
    }
    report["compared_by"] = fmt::format("vkfv {}", VKFV_VERSION);
    return report;
}

std::string with_error(const MeanAndError& value, double factor, const char* unit) {
    return std::isnan(value.error)
               ? fmt::format("{:.4g} {}", value.mean * factor, unit)
               : fmt::format("{:.4g} +- {:.2g} {}", value.mean * factor, value.error * factor, unit);
}

std::string text_of(const topography::Comparison& comparison, const CommandOptions& options) {
    const auto share = over(comparison, [](const auto& one) { return one.deviation.measured_share; });
    if (!(share.mean > 0)) {
        return "no point is present in both: the measurement or the truth has no heights where they overlap.\n";
    }
    std::string text = fmt::format("{:<22} {} of the points\n", "measured", with_error(share, 100, "%"));
    const auto& measurements = comparison.measurements;
    for (std::size_t k = 0; k < measurements.size(); ++k) {
        const auto& shift = measurements[k].shift;
        const auto where = measurements.size() > 1 ? " of " + options.compared_files[k].string() : std::string();
        text += std::isnan(shift.x) ? fmt::format("{:<22} not found{}\n", "lateral shift", where)
                                    : fmt::format("{:<22} x {:+.4f} um, y {:+.4f} um (correlation {:.4f}){}\n",
                                                  "lateral shift", shift.x * um_per_mm, shift.y * um_per_mm,
                                                  shift.correlation, where);
    }
    text += fmt::format("{:<22} {}\n", "",
                        options.align ? fmt::format("removed: x {:+.4f} um, y {:+.4f} um",
                                                    comparison.removed_shift.x * um_per_mm,
                                                    comparison.removed_shift.y * um_per_mm)
                                      : "not removed (--align removes it)");
    text += fmt::format("{:<22} {}\n", "RMS deviation",
                        with_error(over(comparison, [](const auto& one) { return one.deviation.rms; }), um_per_mm, "um"));
    if (comparison.parts) {
        const auto& parts = *comparison.parts;
        text += fmt::format("{:<22} {}\n", "  systematic",
                            with_error({parts.systematic, parts.systematic_error}, um_per_mm, "um"));
        text += fmt::format("{:<22} {}\n", "  random", with_error({parts.random, parts.random_error}, um_per_mm, "um"));
    }
    text += fmt::format("{:<22} {}\n", "correlation",
                        with_error(over(comparison, [](const auto& one) { return one.deviation.correlation; }), 1, ""));
    text += fmt::format("\n{:<18} {:>12} {:>12} {:>12} {:>8}\n", "ISO 25178-2", "measured", "std. error", "true",
                        "ratio");
    for (const auto& row : parameter_rows(comparison)) {
        const auto number = [](double value) { return std::isnan(value) ? std::string("-") : fmt::format("{:.6g}", value); };
        const double ratio = row.measured.mean / row.truth;
        text += fmt::format("{:<5} {:<12} {:>12} {:>12} {:>12} {:>8}\n", row.name, row.unit, number(row.measured.mean),
                            number(row.measured.error), number(row.truth),
                            std::isnan(ratio) || row.unit == "deg" ? "-" : fmt::format("{:.3f}", ratio));
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

// An empty field where no point was measured.
std::string slope_csv(const topography::Comparison& comparison) {
    std::string text = "slope_from_deg,slope_to_deg,points,measured_share,bias_um,rms_um\n";
    for (const auto& bin : comparison.slopes) {
        const auto um = [](double value) { return std::isnan(value) ? "" : fmt::format("{:.6g}", value * um_per_mm); };
        text += fmt::format("{:g},{:g},{:.0f},{:.6g},{},{}\n", bin.from / radians_per_degree,
                            bin.to / radians_per_degree, bin.points, bin.measured_share, um(bin.bias), um(bin.rms));
    }
    return text;
}

// Along the middle row, of the first measurement and of the truth under it, levelled; roughness after the Gaussian filter
// whose nesting index is the section length, a fifth of the profile (ISO 21920-2).
struct ComparedProfile {
    double y = 0;             // mm
    double section_length = 0; // mm
    surface::Profile measured, truth; // before the filter
    surface::ProfileParameters measured_parameters, true_parameters;
};

ComparedProfile compared_profile(const topography::Comparison& comparison, const HeightMap& measured) {
    const auto pair = topography::levelled_pair(measured, comparison.truth);
    ComparedProfile result;
    const int row = measured.rows() / 2, last = measured.columns() - 1;
    result.y = measured.y(row);
    result.section_length = last * measured.pitch_x / 5;
    const auto along = [&](const HeightMap& map) {
        return surface::extract_profile(map, map.x(0), result.y, map.x(last), result.y, map.pitch_x);
    };
    const auto parameters = [&](const surface::Profile& profile) {
        return surface::profile_parameters(surface::remove_long_waves(profile, result.section_length));
    };
    result.measured = along(pair.measured);
    result.truth = along(pair.truth);
    result.measured_parameters = parameters(result.measured);
    result.true_parameters = parameters(result.truth);
    return result;
}

Json profile_json(const ComparedProfile& profile) {
    const auto of = [](const surface::ProfileParameters& parameters) {
        return Json{{"Ra_um", parameters.ra * um_per_mm}, {"Rq_um", parameters.rq * um_per_mm}, {"Rz_um", parameters.rz * um_per_mm}};
    };
    return {{"y_um", profile.y * um_per_mm},
            {"section_length_um", profile.section_length * um_per_mm},
            {"measured", of(profile.measured_parameters)},
            {"true", of(profile.true_parameters)}};
}

std::string profile_text(const ComparedProfile& profile) {
    const auto line = [](const char* name, double measured, double truth) {
        return fmt::format("{:<5} {:<12} {:>12.6g} {:>12} {:>12.6g} {:>8.3f}\n", name, "um", measured * um_per_mm, "-",
                           truth * um_per_mm, measured / truth);
    };
    const auto &a = profile.measured_parameters, &b = profile.true_parameters;
    return fmt::format("\nISO 21920-2, profile at y = {:.4g} um, section length {:.4g} um\n", profile.y * um_per_mm,
                       profile.section_length * um_per_mm) +
           line("Ra", a.ra, b.ra) + line("Rq", a.rq, b.rq) + line("Rz", a.rz, b.rz);
}

// An empty field where no point was measured.
std::string profile_csv(const ComparedProfile& profile, const HeightMap& measured) {
    std::string text = "x_um,measured_um,true_um\n";
    const auto um = [](double value) { return std::isnan(value) ? "" : fmt::format("{:.6g}", value * um_per_mm); };
    for (std::size_t k = 0; k < std::min(profile.measured.height.size(), profile.truth.height.size()); ++k) {
        text += fmt::format("{:.6g},{},{}\n", measured.x(static_cast<int>(k)) * um_per_mm, um(profile.measured.height[k]),
                            um(profile.truth.height[k]));
    }
    return text;
}

// Of the first measurement and the truth under it, levelled.
std::string picture_of(const topography::Comparison& comparison, const HeightMap& measured, const std::string& title) {
    auto pair = topography::levelled_pair(measured, comparison.truth);
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

void run_compare(const CommandOptions& options) {
    const auto& files = options.compared_files;
    const HeightMap truth = surface::read_surface(files.back()).map;
    std::vector<HeightMap> measurements;
    for (std::size_t k = 0; k + 1 < files.size(); ++k) {
        measurements.push_back(surface::read_surface(files[k]).map);
        if (!same_grid(measurements.front(), measurements.back())) {
            refuse_file(files[k], grid_text(measurements.back()),
                        fmt::format("the grid of {}: {}", files.front().string(), grid_text(measurements.front())),
                        "Compare repeated measurements of one field; other fields in runs of their own.");
        }
        if (std::ranges::none_of(measurements.back().height.values, [](double z) { return std::isfinite(z); })) {
            refuse_file(files[k], "no measured point", "a height map with heights", "Measure again, or leave it out.");
        }
    }
    const HeightMap under = surface::resampled(truth, measurements.front());
    if (std::ranges::none_of(under.height.values, [](double z) { return std::isfinite(z); })) {
        refuse_file(files.back(), grid_text(truth),
                    fmt::format("heights where {} has them: {}", files.front().string(),
                                grid_text(measurements.front())),
                    "Give the truth of the same field, in the same frame.");
    }

    const auto comparison = topography::compare_with_truth(measurements, truth, options.align);
    const auto profile = compared_profile(comparison, measurements.front());
    auto figures = json_of(comparison, options);
    figures["profile"] = profile_json(profile);
    const auto report = figures.dump(2) + "\n";
    if (options.out) {
        fs::create_directories(*options.out);
        write_text_aside(*options.out / "compare.json", report);
        write_text_aside(*options.out / "transfer.csv", transfer_csv(comparison));
        write_text_aside(*options.out / "slope.csv", slope_csv(comparison));
        write_text_aside(*options.out / "profile.csv", profile_csv(profile, measurements.front()));
        surface::write_height_map(*options.out / "deviation.tif", comparison.deviation);
        write_text_aside(*options.out / "compare.svg",
                         picture_of(comparison, measurements.front(),
                                    fmt::format("{} against {}", files.front().string(), files.back().string())));
        if (comparison.parts) {
            surface::write_height_map(*options.out / "random.tif", comparison.parts->standard_deviation);
        }
    }
    fmt::print("{}", options.json ? report : text_of(comparison, options) + profile_text(profile));
}

} // namespace vkfv::app
