#include "app/commands.hpp"
#include "measurement/surface_measurement.hpp"

#include "core/units.hpp"

#include <fmt/format.h>

#include <array>
#include <charconv>
#include <cmath>
#include <cstdio>

namespace vkfv::app {

namespace {

struct SurfaceOptions {
    std::optional<double> unit;               // mm per unit of an image's value
    std::optional<surface::ProfileLine> line; // none: the middle row
};

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
    options.of<SurfaceOptions>().line = surface::ProfileLine{ends[0], ends[1], ends[2], ends[3]};
}

} // namespace

Command surface_command() {
    const Option unit = {.name = "--unit_um,--unit-um",
                         .value = "UM",
                         .description = "Height of a pixel's value of one, of an image",
                         .target = in_mm(&SurfaceOptions::unit)};
    const Option profile = {.name = "--profile",
                            .value = "X0,Y0,X1,Y1",
                            .description = "Ends of the profile in um",
                            .target = Take<std::string>(take_profile),
                            .fallback = "the middle row"};
    return {.name = "surface",
            .summary = "A surface file (X3P, SUR, SDF, AL3D, TIFF, EXR): form removed and filtered, its ISO 25178-2 "
                       "parameters; with --out also written, in another format if so named",
            .operands = {{"FILE", "Surface", into(&CommandOptions::file)}},
            .options = together({{out_option("A .x3p, .sur, .sdf, .tif or .ply file"), json_option()},
                                 band_options(),
                                 {pitch_option(), unit, profile}}),
            .run = run_surface,
            .example = "vkfv surface measured.x3p --form polynomial-2 --s_filter_um 5 --out treated.sur"};
}

void run_surface(const CommandOptions& options) {
    const auto own = options.of<SurfaceOptions>();
    const auto figures =
        measurement::measure_surface({.file = options.file,
                                      .scale = {.pitch = options.of<PixelPitch>().value, .unit = own.unit},
                                      .band = options.of<surface::Band>(),
                                      .line = own.line,
                                      .out = options.out});
    fmt::print("{}", options.json ? measurement::surface_json(figures, options.file).dump(2) + "\n"
                                  : measurement::surface_text(figures));
}

} // namespace vkfv::app
