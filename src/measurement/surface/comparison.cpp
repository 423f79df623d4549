#include "measurement/surface/comparison.hpp"

#include "core/mathematics/units.hpp"
#include "core/messages/error.hpp"
#include "measurement/surface/surface_report.hpp"
#include "surface/resample.hpp"
#include "surface_files/surface_file.hpp"

#include <fmt/format.h>
#include <spdlog/spdlog.h>

#include <algorithm>
#include <cmath>
#include <iterator>
#include <string>

namespace vkfv::measurement {

namespace {

using surface::HeightMap;

std::string grid_text(const HeightMap& map) {
    return fmt::format("{} x {} points, {:.6g} x {:.6g} um apart, from x = {:.6g} um, y = {:.6g} um", map.columns(),
                       map.rows(), map.pitch_x * um_per_mm, map.pitch_y * um_per_mm, map.x0 * um_per_mm,
                       map.y0 * um_per_mm);
}

// Tells whether the grids agree to a hundredth of a pitch everywhere.
bool same_grid(const HeightMap& a, const HeightMap& b) {
    const auto near = [](double first, double pitch, int points, double other_first, double other_pitch) {
        return std::abs(first - other_first) + points * std::abs(pitch - other_pitch) < 0.01 * pitch;
    };
    return a.columns() == b.columns() && a.rows() == b.rows() && near(a.x0, a.pitch_x, a.columns(), b.x0, b.pitch_x) &&
           near(a.y0, a.pitch_y, a.rows(), b.y0, b.pitch_y);
}

HeightMap map_of(const std::filesystem::path& file, const ComparisonRequest& request,
                 std::vector<std::string>& warnings) {
    auto read = surface::read_surface(
        file, {}, request.accept_checksum ? surface::Checksums::may_be_stale : surface::Checksums::must_hold);
    std::ranges::move(read.warnings, std::back_inserter(warnings));
    return std::move(read.map);
}

// Reads the measurements. Throws InputError unless all stand on one grid and have heights.
std::vector<HeightMap> read_measurements(const ComparisonRequest& request, std::vector<std::string>& warnings) {
    const auto& files = request.measurements;
    std::vector<HeightMap> measurements;
    for (const auto& file : files) {
        measurements.push_back(map_of(file, request, warnings));
        if (!same_grid(measurements.front(), measurements.back())) {
            refuse_file(file, "vkfv compare", grid_text(measurements.back()),
                        fmt::format("the grid of {}: {}", files.front().string(), grid_text(measurements.front())),
                        "Compare repeated measurements of one field; other fields in runs of their own.");
        }
        if (!any_height(measurements.back())) {
            refuse_file(file, "vkfv compare", "no measured point", "a height map with heights",
                        "Measure again, or leave it out.");
        }
    }
    return measurements;
}

// Throws InputError where the truth has no heights under the measurements.
void check_place(const ComparisonRequest& request, const HeightMap& first, const HeightMap& truth) {
    const auto& measured_file = request.measurements.front();
    if (HeightMap moved = truth; !same_grid(first, truth)) {
        moved.x0 = first.x0;
        moved.y0 = first.y0;
        if (same_grid(first, moved)) {
            spdlog::warn("The grids are alike but begin at different places, {} at ({:.6g}, {:.6g}) um, {} at ({:.6g}, "
                         "{:.6g}) um: points at the same place are compared. SDF and AL3D files hold no place.",
                         measured_file.string(), first.x0 * um_per_mm, first.y0 * um_per_mm, request.truth.string(),
                         truth.x0 * um_per_mm, truth.y0 * um_per_mm);
        }
    }
    if (!any_height(surface::resampled(truth, first))) {
        refuse_file(request.truth, "vkfv compare", grid_text(truth),
                    fmt::format("heights where {} has them: {}", measured_file.string(), grid_text(first)),
                    "Give the truth of the same field, in the same frame.");
    }
}

ComparedProfile compared_profile(const topography::LevelledPair& pair) {
    const surface::ProfileLine line = surface::middle_row(pair.measured);
    return {line, surface::roughness_profile(pair.measured, line), surface::roughness_profile(pair.truth, line)};
}

} // namespace

ComparisonResult compare_files(const ComparisonRequest& request) {
    std::vector<std::string> warnings;
    const HeightMap truth = map_of(request.truth, request, warnings);
    const auto measurements = read_measurements(request, warnings);
    check_place(request, measurements.front(), truth);
    auto comparison = topography::compare_with_truth(measurements, truth, request.align, request.band);
    auto pair = topography::levelled_pair(measurements.front(), comparison.truth, request.band);
    if (request.band.form.kind == surface::Form::Kind::sphere &&
        std::ranges::any_of(comparison.measurements,
                            [](const auto& one) { return one.deviation.measured_share == 0; })) {
        refuse_file(request.measurements.front(), "vkfv compare", "no point on both spheres",
                    "a form that the points of both surfaces settle", "Choose --form plane or --form polynomial-2.");
    }
    auto profile = compared_profile(pair);
    return {.comparison = std::move(comparison),
            .pair = std::move(pair),
            .profile = std::move(profile),
            .warnings = std::move(warnings)};
}

} // namespace vkfv::measurement
