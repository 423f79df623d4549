#include "measurement/beginning/first_configuration.hpp"

#include "configuration/configuration.hpp"
#include "configuration/tables.hpp"
#include "core/mathematics/units.hpp"
#include "surface/form.hpp"
#include "surface_files/surface_file.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <utility>

namespace vkfv::measurement {

namespace {

constexpr int usual_side = 128, largest_side = 192, least_side = 32; // pixels
constexpr double rays_a_pixel = 512;               // makes the camera's noise three times the rays' under every light
constexpr double condenser = 26, field_lens = 150; // mm, of the ideal Köhler illumination
constexpr double usual_telecentric_distance = 65;  // mm
constexpr double usual_elevation = 30, barrel_radius = 15; // degrees; mm, of an objective's front

// Rounds to this number of significant digits, as people write lengths.
double tidy(double value, int digits) {
    if (value == 0) {
        return 0;
    }
    const double scale = std::pow(10, digits - 1 - static_cast<int>(std::floor(std::log10(std::abs(value)))));
    const double whole = std::round(value * scale);
    return whole / scale;
}

std::string tidy_number(double value, int digits = 3) {
    return shortest_toml(tidy(value, digits));
}

// A line of TOML whose comment stands in the same column as the other comments of its table.
std::string commented(const std::string& setting, const std::string& comment) {
    return comment.empty() ? setting + "\n" : fmt::format("{:<27} # {}\n", setting, comment);
}

// Lengths in the object plane, mm.
struct Scales {
    double pixel = 0;
    double resolution = 0; // 0.61 lambda / NA: Rayleigh's criterion
    double depth = 0;      // lambda / NA^2: the depth of field
    int columns = 0;
    int rows = 0;

    double width() const { return columns * pixel; }
    double half_diagonal() const { return 0.5 * pixel * std::hypot(columns, rows); }
};

// The extent of a specimen within the field, mm: its lowest and its highest place, the side of the square that it
// covers, and a height of the focal plane for a first image.
struct FieldExtent {
    double lowest = 0;
    double highest = 0;
    double size = 0;
    double focus = 0; // much of the specimen is sharp there
};

Scales scales_of(const DataSheets& sheets, int side) {
    const double aperture = sheets.objective.numerical_aperture;
    const double wavelength = sheets.led.peak_um * mm_per_um;
    return {.pixel = sheets.camera.pixel_um * mm_per_um / sheets.objective.magnification,
            .resolution = 0.61 * wavelength / aperture,
            .depth = wavelength / (aperture * aperture),
            .columns = std::min(side, sheets.camera.columns),
            .rows = std::min(side, sheets.camera.rows)};
}

// The side (mm) of the square to cover: the whole field and a rim that its edges see out of focus, unless so wide a rim
// would waste light.
double covered(const Scales& scales, double height) {
    const double field = std::max(scales.width(), scales.rows * scales.pixel);
    return std::min(1.5 * field + 4 * height, 1.9 * field);
}

FieldExtent extent_of_surface(const surface::HeightMap& map, double size) {
    const auto level = surface::remove_form(map, {.kind = surface::Form::Kind::plane});
    FieldExtent extent{.lowest = 0, .highest = 0, .size = size, .focus = 0};
    const double middle_x = level.x0 + 0.5 * (level.columns() - 1) * level.pitch_x;
    const double middle_y = level.y0 + 0.5 * (level.rows() - 1) * level.pitch_y;
    for (int row = 0; row < level.rows(); ++row) {
        for (int column = 0; column < level.columns(); ++column) {
            const double height = level.height(column, row);
            if (std::max(std::abs(level.x(column) - middle_x), std::abs(level.y(row) - middle_y)) <= 0.5 * size &&
                std::isfinite(height)) {
                extent.lowest = std::min(extent.lowest, height);
                extent.highest = std::max(extent.highest, height);
            }
        }
    }
    return extent;
}

struct FirstSpecimen {
    Scales scales;
    FieldExtent extent;
    std::string lines;
};

FirstSpecimen first_sphere(const DataSheets& sheets) {
    const double radius = sheets.specimen.length;
    const double pixel = scales_of(sheets, usual_side).pixel;
    const double wanted = std::ceil(radius / pixel / least_side) * least_side;
    FirstSpecimen made{.scales =
                           scales_of(sheets, static_cast<int>(std::clamp<double>(wanted, usual_side, largest_side))),
                       .extent = {},
                       .lines = {}};
    // The cap reaches the corners of the field, but not beyond a slope of 50 degrees.
    constexpr double beyond = 1.1, steepest = 0.77;
    const double reach = std::min(beyond * made.scales.half_diagonal(), steepest * radius);
    const double height = tidy(radius - std::sqrt(radius * radius - reach * reach), 2);
    made.extent = {.lowest = 0,
                   .highest = height,
                   .size = tidy(2.2 * std::max(reach, made.scales.half_diagonal()), 2),
                   .focus = height};
    made.lines = commented("kind = \"sphere\"", "a cap on a plane") +
                 commented("representation = \"analytic\"", "the sphere itself, not facets") +
                 commented("radius_um = " + tidy_number(radius * um_per_mm, 6), "") +
                 commented("height_um = " + tidy_number(height * um_per_mm), "of the cap");
    return made;
}

FirstSpecimen measured_surface(const DataSheets& sheets) {
    const auto map = surface::read_surface(sheets.specimen.file).map;
    const double side = std::min((map.columns() - 1) * map.pitch_x, (map.rows() - 1) * map.pitch_y);
    const double pixel = scales_of(sheets, usual_side).pixel;
    const int fitting = static_cast<int>(std::min<double>(usual_side, std::floor(side / pixel)));
    FirstSpecimen made{.scales = scales_of(sheets, fitting), .extent = {}, .lines = {}};
    if (fitting < least_side) {
        throw InputError(
            {.where = {.file = "command line"},
             .key = "--specimen",
             .found = fmt::format("{}, {:.3g} mm wide", sheets.specimen.text, side),
             .expected = fmt::format("a surface of at least {} pixels, {:.3g} mm", least_side, least_side * pixel),
             .remedy = "Choose an objective of a larger magnification, or a larger surface."});
    }
    made.extent = extent_of_surface(map, std::min(side, covered(made.scales, 0)));
    made.extent.size = std::min(tidy(made.extent.size, 3), tidy(0.99 * side, 3)); // within the file after rounding
    made.lines =
        commented("kind = \"surface\"", "measured; its least-squares plane is removed") +
        commented("file = " + toml_quoted(std::filesystem::absolute(sheets.specimen.file).lexically_normal().string()),
                  "");
    return made;
}

FirstSpecimen specimen_of(const DataSheets& sheets) {
    using Kind = SheetSpecimen::Kind;
    const SheetSpecimen& specimen = sheets.specimen;
    if (specimen.kind == Kind::sphere) {
        return first_sphere(sheets);
    }
    if (specimen.kind == Kind::surface) {
        return measured_surface(sheets);
    }
    FirstSpecimen made{.scales = scales_of(sheets, usual_side), .extent = {}, .lines = {}};
    made.extent = {.lowest = -0.5 * specimen.height,
                   .highest = 0.5 * specimen.height,
                   .size = tidy(covered(made.scales, specimen.height), 2),
                   .focus = 0.5 * specimen.height};
    if (specimen.kind == Kind::plane) {
        made.lines = commented("kind = \"plane\"", "");
    } else if (specimen.kind == Kind::step) {
        made.lines = commented("kind = \"step\"", "along y, the upper level at x > 0") +
                     commented("height_um = " + tidy_number(specimen.height * um_per_mm, 6), "");
    } else {
        made.lines =
            commented("kind = \"sinusoid\"", "along x") +
            commented("amplitude_um = " + tidy_number(0.5 * specimen.height * um_per_mm, 6), "half its height") +
            commented("period_um = " + tidy_number(specimen.length * um_per_mm, 6), "");
    }
    return made;
}

std::string source_lines(const DataSheets& sheets, const Scales& scales) {
    const SheetObjective& objective = sheets.objective;
    std::string text = "[source]\n";
    if (sheets.light.ring) {
        const SheetLight& light = sheets.light;
        text += commented("kind = \"ring\"", "round the objective") +
                commented("inner_diameter_mm = " + tidy_number(light.inner_diameter, 6), "of its luminous face") +
                commented("outer_diameter_mm = " + tidy_number(light.outer_diameter, 6), "");
        if (light.working_distance) {
            text += commented("working_distance_mm = " + tidy_number(*light.working_distance, 6),
                              "of the face over the focus");
        } else {
            // The light passes the front of the objective.
            const double highest = std::atan2(0.9 * objective.working_distance.value_or(barrel_radius), barrel_radius);
            const double elevation = std::min(usual_elevation, std::floor(highest / radians_per_degree));
            text += commented("elevation_deg = " + tidy_number(light.elevation.value_or(elevation), 6),
                              "of its light over the specimen's plane");
        }
    } else {
        const double radius = objective.focal_length() * objective.numerical_aperture * condenser / field_lens;
        text += commented("radius_mm = " + tidy_number(radius), "fills the objective's pupil");
    }
    const std::string spectrum =
        sheets.led.colour.empty() ? fmt::format("peak_um = {}, full_width_um = {}", tidy_number(sheets.led.peak_um, 6),
                                                tidy_number(sheets.led.full_width_um, 6))
                                  : "colour = " + toml_quoted(sheets.led.colour);
    text += commented(fmt::format("spectrum = {{ kind = \"led\", {} }}", spectrum),
                      sheets.led.colour.empty() ? "" : "vkfv list leds");
    if (sheets.light.ring) {
        return text + "\n[beam_splitter]\n" + commented("reflectance = 0.0", "a ring light does without") +
               commented("transmittance = 1.0", "");
    }
    constexpr double margin = 1.2;
    const double stop = margin * scales.half_diagonal() * field_lens / objective.focal_length();
    return text + "\n[illumination]\n" +
           commented("kind = \"ideal\"", "Köhler illumination by lenses without aberrations") +
           commented("condenser_focal_length_mm = " + tidy_number(condenser), "") +
           commented("field_stop_radius_mm = " + tidy_number(stop), "lights a little more than the field");
}

std::string objective_lines(const SheetObjective& objective) {
    using Kind = SheetObjective::Kind;
    std::string text = "\n[objective]\n";
    if (objective.kind == Kind::prescription) {
        return text +
               commented("prescription = " + toml_quoted(objective.text), "by its surfaces, with its aberrations") +
               "\n[tube_lens]\n" + commented("prescription = \"200mm\"", "");
    }
    const bool telecentric = objective.kind == Kind::telecentric;
    text += commented(telecentric ? "kind = \"telecentric\"" : "kind = \"ideal\"",
                      "without aberrations, with diffraction") +
            commented("magnification = " + tidy_number(objective.magnification, 6), "") +
            commented("numerical_aperture = " + tidy_number(objective.numerical_aperture, 6), "");
    if (!telecentric && objective.tube_length != SheetObjective{}.tube_length) {
        text += commented("tube_length_mm = " + tidy_number(objective.tube_length, 6),
                          "that the magnification is stated for");
    }
    if (objective.working_distance) {
        text += commented("working_distance_mm = " + tidy_number(*objective.working_distance, 6), "");
    }
    if (objective.parfocal_length) {
        text += commented("parfocal_length_mm = " + tidy_number(*objective.parfocal_length, 6), "");
    }
    return telecentric ? text
                       : text + "\n[tube_lens]\n" + commented("kind = \"ideal\"", "") +
                             commented("focal_length_mm = " + tidy_number(objective.tube_length, 6), "");
}

// Tells whether vkfv has a noise preset for a camera with this sensor.
bool has_preset(const std::string& sensor) {
    for (const Key* key : camera_keys().keys) {
        if (key->name == "preset") {
            const auto names = key->choice_names();
            return std::ranges::find(names, sensor) != names.end();
        }
    }
    return false;
}

std::string detector_lines(const SheetCamera& camera, const Scales& scales) {
    std::string text = "\n[detector]\n";
    if (camera.sensor.empty()) {
        text += commented("pixel_um = " + tidy_number(camera.pixel_um, 6), "");
    } else {
        text += commented("camera = " + toml_quoted(camera.sensor), "vkfv list cameras");
    }
    text += commented(fmt::format("pixels = [{}, {}]", scales.columns, scales.rows),
                      fmt::format("its middle, {:.3g} um wide; all of it: [{}, {}]", scales.width() * um_per_mm,
                                  camera.columns, camera.rows));
    if (has_preset(camera.sensor)) {
        text += "\n[camera]\n" +
                commented("preset = " + toml_quoted(camera.sensor), "its noise; without [camera] images are light");
    }
    return text;
}

std::string scan_lines(const Scales& scales, const FieldExtent& extent) {
    const double step = tidy(0.2 * scales.depth, 2);
    const double margin = 2.5 * scales.depth;
    const auto steps = [&](double height) { return std::ceil((height + margin) / step); };
    const double start = -steps(-extent.lowest) * step, stop = steps(extent.highest) * step;
    return "\n[scan]\n" +
           commented("z_start_um = " + tidy_number(start * um_per_mm, 6),
                     fmt::format("{:.2g} um, the depth of field, is 5 steps", scales.depth * um_per_mm)) +
           commented("z_stop_um = " + tidy_number(stop * um_per_mm, 6), "") +
           commented("z_step_um = " + tidy_number(step * um_per_mm, 6),
                     fmt::format("{} images", std::lround((stop - start) / step) + 1));
}

} // namespace

std::string first_configuration(const DataSheets& given, const std::string& name) {
    DataSheets sheets = given;
    if (sheets.objective.kind == SheetObjective::Kind::telecentric && !sheets.objective.working_distance) {
        sheets.objective.working_distance = usual_telecentric_distance;
    }
    const FirstSpecimen specimen = specimen_of(sheets);
    const Scales& scales = specimen.scales;
    const double resolution_um = scales.resolution * um_per_mm;
    constexpr double window_in_resolutions = 5;
    constexpr int least_window = 7, largest_window = 31;
    const int window =
        std::clamp(2 * static_cast<int>(0.5 * window_in_resolutions * scales.resolution / scales.pixel) + 1,
                   least_window, largest_window);
    const double rays = tidy(rays_a_pixel * scales.columns * scales.rows, 2);
    std::string text =
        fmt::format("# {}, {}, {} light of {}, {}: written by vkfv new.\n"
                    "# vkfv check {} | vkfv image {} --z {} | vkfv stack {}; vkfv explain KEY tells of each key.\n\n",
                    sheets.objective.text, sheets.camera.text, sheets.light.ring ? "ring" : "coaxial", sheets.led.text,
                    sheets.specimen.kind == SheetSpecimen::Kind::surface ? sheets.specimen.file.filename().string()
                                                                         : sheets.specimen.text,
                    name, name, tidy(specimen.extent.focus * um_per_mm, 3), name) +
        source_lines(sheets, scales) + objective_lines(sheets.objective) + detector_lines(sheets.camera, scales) +
        "\n[specimen]\n" + specimen.lines +
        commented("size_mm = " + tidy_number(specimen.extent.size), "more than the field") +
        commented(
            fmt::format("reflectance = {{ kind = \"noise\", pitch_um = {}, correlation_length_um = {} }}",
                        tidy_number(0.5 * resolution_um, 2), tidy_number(2 * resolution_um, 2)),
            fmt::format("a printed texture, by which focus is seen; the optics resolve {:.2g} um", resolution_um)) +
        scan_lines(scales, specimen.extent) + "\n[trace]\n" +
        commented(fmt::format("rays = {:.0f}", rays), fmt::format("an image: {:.0f} paths a pixel", rays_a_pixel)) +
        "\n[topography]\n" +
        commented(fmt::format("window_px = {}", window),
                  fmt::format("{:.2g} um, five times what the optics resolve", window * scales.pixel * um_per_mm));
    (void)read_configuration(TomlTable::parse(text, name)); // throws for parts that do not fit together
    return text;
}

} // namespace vkfv::measurement
