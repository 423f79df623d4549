#include "app/commands.hpp"
#include "report/parameter_table.hpp"

#include "core/file.hpp"
#include "core/units.hpp"
#include "surface_files/surface_file.hpp"

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>
#include <cstdio>

namespace vkfv::app {

namespace {

void take_profile(CommandOptions& options, const std::string& text) {
    if (text.empty()) {
        return;
    }
    std::array<double, 4> ends{};
    const char *at = text.data(), *end = text.data() + text.size();
    for (std::size_t k = 0; k < ends.size(); ++k) {
        const auto [after, error] = std::from_chars(at, end, ends[k]);
        const bool last = k + 1 == ends.size();
        if (error != std::errc() || !std::isfinite(ends[k]) || (last ? after != end : after == end || *after != ',')) {
            refuse_argument("--profile " + text, "four numbers X0,Y0,X1,Y1 in um",
                            "Write for example --profile 0,50,100,50.");
        }
        ends[k] /= um_per_mm;
        at = after + 1;
    }
    options.profile_line = surface::ProfileLine{ends[0], ends[1], ends[2], ends[3]};
}

} // namespace

Command surface_command() {
    const Option unit = {.name = "--unit_um,--unit-um",
                         .value = "UM",
                         .description = "Height of a pixel's value of one, of an image",
                         .target = in_mm(&CommandOptions::unit)};
    const Option profile = {.name = "--profile",
                            .value = "X0,Y0,X1,Y1",
                            .description = "Ends of the profile in um",
                            .target = Take<std::string>(take_profile),
                            .fallback = "the middle row"};
    return {.name = "surface",
            .summary = "A surface file (X3P, SUR, SDF, AL3D, TIFF, EXR): form removed and filtered, its ISO 25178-2 "
                       "parameters; with --out also written, in another format if so named",
            .operands = {{"FILE", "Surface", &CommandOptions::file}},
            .options = together({{out_option("A .x3p, .sur, .sdf, .tif or .ply file"), json_option()},
                                 band_options(),
                                 {pitch_option(), unit, profile}}),
            .run = run_surface,
            .example = "vkfv surface measured.x3p --form polynomial-2 --s_filter_um 5 --out treated.sur"};
}

namespace {

using Json = nlohmann::ordered_json;
using surface::HeightMap;

[[noreturn]] void refuse(const CommandOptions& options, std::string key, std::string found, std::string expected,
                         std::string remedy) {
    throw InputError({.where = {.file = options.file},
                      .key = std::move(key),
                      .found = std::move(found),
                      .expected = std::move(expected),
                      .remedy = std::move(remedy)});
}

surface::SurfaceFile read_file(const CommandOptions& options) {
    const auto check = [&](const char* option, const std::optional<double>& length) {
        if (length && !(std::isfinite(*length) && *length > 0)) {
            refuse(options, option, fmt::format("{:g}", *length * um_per_mm), "a positive length",
                   "Give the one that belongs to this image.");
        }
    };
    check("--pitch_um", options.pitch);
    check("--unit_um", options.unit);
    try {
        return surface::read_surface(options.file, {.pitch = options.pitch, .unit = options.unit});
    } catch (const InputError& error) {
        throw error.with_each([](InputProblem& problem) {
            if (problem.key == "pitch" || problem.key == "unit") { // the reader does not know the command line
                problem.key = "--" + problem.key + "_um";
            }
        });
    }
}

std::ptrdiff_t measured_points(const HeightMap& map) {
    return std::ranges::count_if(map.height.values, [](double z) { return std::isfinite(z); });
}

HeightMap treated(const CommandOptions& options, const HeightMap& map) {
    if (measured_points(map) == 0) {
        refuse(options, "", "no measured point", "a surface with heights", "Measure again.");
    }
    HeightMap result = surface::scale_limited(map, options.band);
    if (measured_points(result) == 0) {
        refuse(options, "--form", surface::form_name(options.band.form), "a form that the measured points settle",
               "Choose --form plane or --form polynomial-2.");
    }
    return result;
}

surface::ProfileLine line_of(const CommandOptions& options, const HeightMap& map) {
    if (!options.profile_line) {
        return surface::middle_row(map);
    }
    const auto& line = *options.profile_line;
    const auto within = [](double value, double first, double last, double pitch) {
        return value >= first - 1e-6 * pitch && value <= last + 1e-6 * pitch;
    };
    const double x_last = map.x(map.columns() - 1), y_last = map.y(map.rows() - 1);
    const bool inside =
        within(line.x_start, map.x0, x_last, map.pitch_x) && within(line.x_end, map.x0, x_last, map.pitch_x) &&
        within(line.y_start, map.y0, y_last, map.pitch_y) && within(line.y_end, map.y0, y_last, map.pitch_y);
    if (!inside ||
        !(std::hypot(line.x_end - line.x_start, line.y_end - line.y_start) > std::min(map.pitch_x, map.pitch_y))) {
        refuse(options, "--profile",
               fmt::format("{:.6g},{:.6g},{:.6g},{:.6g}", line.x_start * um_per_mm, line.y_start * um_per_mm,
                           line.x_end * um_per_mm, line.y_end * um_per_mm),
               fmt::format(
                   "a line longer than a pitch on the surface: x from {:.6g} to {:.6g} um, y from {:.6g} to {:.6g} um",
                   map.x0 * um_per_mm, x_last * um_per_mm, map.y0 * um_per_mm, y_last * um_per_mm),
               "Choose both ends on the surface, or leave it out for the middle row.");
    }
    return line;
}

// All that is said of the surface.
struct Figures {
    std::ptrdiff_t not_measured = 0; // beyond a sphere too
    std::vector<report::ParameterRow> parameters;
    surface::ProfileLine line;
    double section_length = 0; // mm
    std::vector<report::ParameterRow> profile;
};

Figures figures_of(const HeightMap& map, const surface::ProfileLine& line) {
    const auto profile = surface::roughness_profile(map, line);
    return {.not_measured = std::ssize(map.height.values) - measured_points(map),
            .parameters = report::parameter_rows(surface::areal_parameters(map)),
            .line = line,
            .section_length = profile.section_length,
            .profile = report::parameter_rows(profile.parameters)};
}

std::string json_text(const CommandOptions& options, const HeightMap& map, const Figures& figures) {
    Json report;
    report["file"] = options.file.string();
    report["columns"] = map.columns();
    report["rows"] = map.rows();
    report["pitch_um"] = {map.pitch_x * um_per_mm, map.pitch_y * um_per_mm};
    report["first_point_um"] = {map.x0 * um_per_mm, map.y0 * um_per_mm};
    report["not_measured_points"] = figures.not_measured;
    report["treatment"] = report::treatment_json(options.band);
    report["parameters"] = json_of(figures.parameters);
    const auto& line = figures.line;
    report["profile"] = {{"start_um", {line.x_start * um_per_mm, line.y_start * um_per_mm}},
                         {"end_um", {line.x_end * um_per_mm, line.y_end * um_per_mm}},
                         {"section_length_um", figures.section_length * um_per_mm}};
    report["profile"].update(json_of(figures.profile));
    report["evaluated_by"] = fmt::format("vkfv {}", VKFV_VERSION);
    return report.dump(2) + "\n";
}

std::string text_of(const CommandOptions& options, const HeightMap& map, const Figures& figures) {
    const auto size = [](int points, double pitch) { return points * pitch * um_per_mm; };
    std::string text = fmt::format("{:<14} {} x {} points, {:.6g} x {:.6g} um\n", "size", map.columns(), map.rows(),
                                   size(map.columns(), map.pitch_x), size(map.rows(), map.pitch_y));
    text += fmt::format("{:<14} {:.6g} x {:.6g} um, from x = {:.6g} um, y = {:.6g} um\n", "pitch",
                        map.pitch_x * um_per_mm, map.pitch_y * um_per_mm, map.x0 * um_per_mm, map.y0 * um_per_mm);
    text +=
        fmt::format("{:<14} {} points ({:.3g} %)\n", "not measured", figures.not_measured,
                    100.0 * static_cast<double>(figures.not_measured) / static_cast<double>(map.height.values.size()));
    text += fmt::format("{:<14} {}\n", "treatment", report::treatment_text(options.band));
    const auto table = [&text](const std::vector<report::ParameterRow>& rows) {
        for (const auto& row : rows) {
            text += fmt::format("{:<5} {:<12} {:>12}\n", row.name, row.unit, report::number_text(row.value));
        }
    };
    text += "\nISO 25178-2\n";
    table(figures.parameters);
    const auto& line = figures.line;
    text += fmt::format(
        "\nISO 21920-2, profile from ({:.6g}, {:.6g}) um to ({:.6g}, {:.6g}) um, section length {:.4g} um\n",
        line.x_start * um_per_mm, line.y_start * um_per_mm, line.x_end * um_per_mm, line.y_end * um_per_mm,
        figures.section_length * um_per_mm);
    table(figures.profile);
    return text;
}

} // namespace

void run_surface(const CommandOptions& options) {
    auto [original, provenance] = read_file(options);
    const HeightMap map = treated(options, original);
    const surface::ProfileLine line = line_of(options, map);
    if (options.out) {
        std::error_code none;
        if (std::filesystem::equivalent(*options.out, options.file, none)) {
            refuse(options, "--out", options.out->string(), "another file than the measurement itself",
                   "Name a new one.");
        }
        provenance.comment += fmt::format("\nvkfv {}: {}, {}", VKFV_VERSION, options.file.filename().string(),
                                          report::treatment_text(options.band));
        write_file(*options.out, surface::surface_bytes(*options.out, map, provenance));
    }
    const Figures figures = figures_of(map, line);
    fmt::print("{}", options.json ? json_text(options, map, figures) : text_of(options, map, figures));
}

} // namespace vkfv::app
