// Parts and rays that the tests of the optics share.
#pragma once

#include "optics/instrument/instrument.hpp"
#include "optics/prescriptions/ideal_lens.hpp"

#include <filesystem>
#include <fstream>
#include <sstream>
#include <string>
#include <utility>
#include <vector>

namespace vkfv::test {

inline std::filesystem::path source_folder() {
    return VKFV_SOURCE_DIR;
}

inline constexpr double d_line_um = 0.587562;

// The demo's microscope.
inline optics::InstrumentDescription microscope(const std::string& objective = "10x_0.28") {
    const auto base = source_folder() / "assets" / "stacks";
    optics::InstrumentDescription description;
    description.source.radius = 0.96;
    description.spectrum = optics::Spectrum::line(d_line_um);
    description.illumination = optics::load_prescription("koehler", "illuminators", base);
    description.field_stop_radius = 0.85;
    description.objective = optics::load_prescription(objective, "objectives", base);
    description.tube_lens = optics::load_prescription("200mm", "tube_lenses", base);
    description.detector_width = 1.3;
    description.detector_pixels = ImageSize::square(64);
    return description;
}

// The demo's microscope with a field of 0.8 mm, as the chain of the paper has.
inline optics::InstrumentDescription wide_microscope() {
    auto description = microscope();
    description.detector_width = 8;
    description.field_stop_radius = 4.3;
    return description;
}

// The demo's microscope with lenses without aberrations, f = 20 and 200 mm.
inline optics::InstrumentDescription ideal_microscope(double aperture) {
    auto description = microscope();
    description.spectrum = optics::Spectrum::line(0.55);
    description.objective = optics::ideal_objective(20, aperture);
    description.tube_lens = optics::ideal_lens(200);
    return description;
}

// The rows of a CSV file after its header.
inline std::vector<std::vector<double>> read_rows(const std::filesystem::path& file) {
    std::ifstream stream(file);
    std::string line;
    std::getline(stream, line);
    std::vector<std::vector<double>> rows;
    while (std::getline(stream, line)) {
        std::istringstream cells(line);
        std::vector<double> row;
        for (std::string cell; std::getline(cells, cell, ',');) {
            row.push_back(std::stod(cell));
        }
        rows.push_back(std::move(row));
    }
    return rows;
}

// A surface between two media, for closed forms.
inline physics::f64::Surface surface(double curvature, double distance, double index_before, double index_after,
                                     double conic = 0) {
    physics::f64::Surface result{};
    result.curvature = curvature;
    result.conic = conic;
    result.distance = distance;
    result.index_before = index_before;
    result.index_after = index_after;
    result.rotation_xx = result.rotation_yy = result.rotation_zz = 1;
    return result;
}

// A surface of a prescription, for closed forms.
inline optics::PrescribedSurface prescribed(double curvature, double thickness, const optics::Medium& after,
                                            std::vector<optics::CoordinateBreak> breaks = {}) {
    optics::PrescribedSurface result;
    result.breaks = std::move(breaks);
    result.curvature = curvature;
    result.thickness = thickness;
    result.medium_after = after;
    return result;
}

// A ball of glass with its stop in the middle in place of the objective, under a ring light; radius in mm.
inline optics::InstrumentDescription ball_microscope(double radius, double index) {
    auto description = ideal_microscope(0.05);
    const optics::Medium glass = optics::Medium::constant("glass", index);
    auto stop = prescribed(0, radius, glass);
    stop.semi_diameter = 0.4;
    stop.role = optics::PrescribedSurface::Role::aperture_stop;
    description.objective = {};
    description.objective.medium_before = optics::Medium::air();
    description.objective.surfaces = {prescribed(1 / radius, radius, glass), stop,
                                      prescribed(-1 / radius, 0, optics::Medium::air())};
    description.source.ring = optics::RingLightDescription{
        .distance = 30, .elevation = 0.5, .width = 1, .segments = 1, .fill = 1, .on = {true}, .lit_radius = 0.1};
    return description;
}

inline physics::f64::TrainResult trace(const std::vector<physics::f64::Surface>& train, glm::dvec3 position,
                                       glm::dvec3 direction, unsigned apertures = 0u) {
    physics::f64::Ray ray{};
    ray.position = position;
    ray.direction = glm::normalize(direction) * train.front().index_before;
    return physics::f64::trace_train(optics::TrainScene{.surfaces = train}, 0, static_cast<int>(train.size()), ray,
                                     train.front().index_before, apertures,
                                     {.spectral = 0, .wave_number = 1, .survival = 0});
}

// Light of this seed above a specimen whose top plane is `top_distance` mm below the front vertex, in focus.
inline physics::f64::Exposure exposure_of(double top_distance, std::uint32_t seed) {
    return {.top_distance = top_distance,
            .seed = seed,
            .image = 0,
            .focal_height = 0,
            .top_distance_residual = 0,
            .beside_x = 0,
            .beside_y = 0,
            .magnification_change = 0};
}

} // namespace vkfv::test
