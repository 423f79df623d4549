#include "measurement/surface/surface_measurement.hpp"

#include "core/files/file.hpp"
#include "core/mathematics/units.hpp"
#include "core/messages/error.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <string>
#include <utility>

namespace vkfv::measurement {

namespace {

using surface::HeightMap;

surface::SurfaceFile requested_surface(const SurfaceRequest& request) {
    const auto check = [&](const char* option, const std::optional<double>& length) {
        if (length && !(std::isfinite(*length) && *length > 0)) {
            refuse_file(request.file, option, fmt::format("{:g}", *length * um_per_mm), "a positive length",
                        "Give the one that belongs to this image.");
        }
    };
    check("--pitch_um", request.scale.pitch);
    check("--unit_um", request.scale.unit);
    try {
        return surface::read_surface(request.file, request.scale,
                                     request.accept_checksum ? surface::Checksums::may_be_stale
                                                             : surface::Checksums::must_hold);
    } catch (const InputError& error) {
        throw error.with_each([](InputProblem& problem) {
            if (problem.key == surface::scale_pitch_key ||
                problem.key == surface::scale_unit_key) { // the file's reader has no options
                problem.key = "--" + problem.key + "_um";
            }
        });
    }
}

HeightMap treated(const SurfaceRequest& request, const HeightMap& map) {
    if (request.band.form.kind == surface::Form::Kind::truth) {
        refuse_file(request.file, "--form", "truth", "a form of one surface",
                    "Choose --form plane; vkfv compare has the truth beside it.");
    }
    if (!any_height(map)) {
        refuse_file(request.file, "", "no measured point", "a surface with heights", "Measure again.");
    }
    HeightMap result = surface::scale_limited(map, request.band);
    if (!any_height(result)) {
        refuse_file(request.file, "--form", surface::form_name(request.band.form),
                    "a form that the measured points settle", "Choose --form plane or --form polynomial-2.");
    }
    return result;
}

surface::ProfileLine line_of(const SurfaceRequest& request, const HeightMap& map) {
    if (!request.line) {
        return surface::middle_row(map);
    }
    const auto& line = *request.line;
    const auto within = [](double value, double first, double last, double pitch) {
        return value >= first - 1e-6 * pitch && value <= last + 1e-6 * pitch;
    };
    const double x_last = map.x(map.columns() - 1), y_last = map.y(map.rows() - 1);
    const bool inside =
        within(line.x_start, map.x0, x_last, map.pitch_x) && within(line.x_end, map.x0, x_last, map.pitch_x) &&
        within(line.y_start, map.y0, y_last, map.pitch_y) && within(line.y_end, map.y0, y_last, map.pitch_y);
    if (!inside ||
        !(std::hypot(line.x_end - line.x_start, line.y_end - line.y_start) > std::min(map.pitch_x, map.pitch_y))) {
        refuse_file(
            request.file, "--profile",
            fmt::format("{:.6g},{:.6g},{:.6g},{:.6g}", line.x_start * um_per_mm, line.y_start * um_per_mm,
                        line.x_end * um_per_mm, line.y_end * um_per_mm),
            fmt::format(
                "a line longer than a pitch on the surface: x from {:.6g} to {:.6g} um, y from {:.6g} to {:.6g} um",
                map.x0 * um_per_mm, x_last * um_per_mm, map.y0 * um_per_mm, y_last * um_per_mm),
            "Choose both ends on the surface, or leave it out for the middle row.");
    }
    return line;
}

// Throws InputError for a profile that is too short for its setting class, or rougher than all classes.
void check_class(const SurfaceRequest& request, const surface::RoughnessProfile& profile) {
    if (profile.setting_class == nullptr) {
        return;
    }
    const double length = static_cast<double>(profile.profile.height.size() - 1) * profile.profile.spacing;
    const double needed = 5 * profile.setting_class->l_filter;
    if (length < needed - 0.5 * profile.profile.spacing) {
        refuse_file(request.file, "--profile_setting", fmt::format("a profile of {:.4g} mm", length),
                    fmt::format("{:g} mm, the evaluation length of {}", needed, profile.setting_class->name),
                    "Choose a longer profile, a finer class, or leave it out for a fifth of the profile.");
    }
    if (request.setting.kind == surface::ProfileSetting::Kind::by_ra && std::isnan(profile.parameters.ra)) {
        refuse_file(request.file, "--profile_setting", "no class",
                    fmt::format("a profile with Ra up to {:g} um", profile.setting_class->greatest_ra * um_per_mm),
                    "Choose another profile, or name the nesting index by --profile_filter_um.");
    }
}

// The dimensions that the request seeks. Throws InputError where the surface has no such feature.
std::vector<StandardDimension> sought_dimensions(const SurfaceRequest& request, const HeightMap& original) {
    std::vector<StandardDimension> result;
    for (auto& one : dimensions::evaluate_found(original, *request.sought)) {
        result.push_back({.measured = std::move(one)});
    }
    if (std::ranges::none_of(result, [](const auto& one) { return std::isfinite(one.measured.value); })) {
        const std::string name = dimensions::sought_names[static_cast<std::size_t>(*request.sought)];
        refuse_file(request.file, "--dimensions", name, "a surface that shows one, with the levels or waves beside it",
                    "Seek what is there, or measure a larger field.");
    }
    return result;
}

} // namespace

SurfaceFigures measure_surface(const SurfaceRequest& request) {
    auto [original, provenance, warnings] = requested_surface(request);
    const HeightMap map = treated(request, original);
    const surface::ProfileLine line = line_of(request, map);
    if (request.out) {
        std::error_code none;
        if (std::filesystem::equivalent(*request.out, request.file, none)) {
            refuse_file(request.file, "--out", request.out->string(), "another file than the measurement itself",
                        "Name a new one.");
        }
        provenance.comment += fmt::format("\nvkfv {}: {}, {}", VKFV_VERSION, request.file.filename().string(),
                                          report::treatment_text(request.band));
        write_file(*request.out, surface::surface_bytes(*request.out, map, provenance));
    }
    auto figures = surface_figures(map, line, request.setting, request.band);
    figures.warnings = std::move(warnings);
    check_class(request, figures.profile);
    figures.asked = asked_rows(map, figures.profile, request.asked);
    if (request.sought) {
        figures.dimensions = sought_dimensions(request, original);
    }
    return figures;
}

} // namespace vkfv::measurement
