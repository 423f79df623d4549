#include "app/commands.hpp"
#include "measurement/surface_report.hpp"

#include "core/file.hpp"
#include "core/units.hpp"
#include "surface_files/surface_file.hpp"

#include <fmt/format.h>

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

HeightMap treated(const CommandOptions& options, const HeightMap& map) {
    if (!measurement::any_height(map)) {
        refuse(options, "", "no measured point", "a surface with heights", "Measure again.");
    }
    HeightMap result = surface::scale_limited(map, options.band);
    if (!measurement::any_height(result)) {
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
    const auto figures = measurement::surface_figures(map, line, options.band);
    fmt::print("{}", options.json ? measurement::surface_json(figures, options.file).dump(2) + "\n"
                                  : measurement::surface_text(figures));
}

} // namespace vkfv::app
