#include "measurement/scene/pupil_light.hpp"

#include "core/mathematics/units.hpp"
#include "specimen/description.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <functional>
#include <numeric>
#include <optional>
#include <utility>
#include <vector>

namespace vkfv::measurement {

namespace {

constexpr std::uint32_t scattered_paths = 65536;
constexpr std::uint32_t source_points = 1024; // for lobes that are integrated
constexpr std::uint32_t seed = 1;
constexpr std::uint32_t source_stream = 0, scatter_stream = 1; // stand for the number of an image

// The least light, over what a Lambertian surface sends into the pupil. Less than this comes in by the specimen's
// slopes and not by its lobes.
constexpr double least_over_lambertian = 0.01;

// The coordinate of a cell's middle in the pupil, in radii of the pupil.
double middle_of(int cell) {
    return (2 * cell + 1.0) / pupil_light_cells - 1;
}

bool is_in_pupil(int column, int row) {
    return column >= 0 && column < pupil_light_cells && row >= 0 && row < pupil_light_cells &&
           std::hypot(middle_of(column), middle_of(row)) <= 1;
}

// Directions in which the source's light falls on the middle of the field: unit vectors towards the specimen, with z
// up.
class Illumination {
  public:
    Illumination(const optics::InstrumentDescription& description, const optics::SourceDescription& source,
                 const optics::Instrument& instrument, double aperture_sine)
        : ring_(instrument.constants.ring), is_ring_(source.ring.has_value()) {
        const double filling = instrument.first_order.pupil_radius_in_source;
        if (is_ring_ || !(filling > 0)) {
            return;
        }
        const double scale = aperture_sine / filling;
        half_ = scale * (source.rectangle ? 0.5 * *source.rectangle : glm::dvec2(source.radius));
        is_disc_ = !source.rectangle;
        stop_ = std::min(1.0, scale * description.illumination_aperture_radius.value_or(filling / aperture_sine));
    }

    // There is no direction where the aperture diaphragm stops the light.
    std::optional<glm::dvec3> direction(std::uint32_t path) const {
        const auto random = physics::f64::draw(seed, source_stream, {path, 0}, 0);
        if (is_ring_) {
            const auto place = physics::f64::ring_point(ring_, random.u0, random.u1).position;
            const glm::dvec3 from = glm::normalize(glm::dvec3(place.x, place.y, place.z));
            return glm::dvec3(-from.x, from.y, from.z);
        }
        glm::dvec2 sine = half_ * glm::dvec2(2 * random.u0 - 1, 2 * random.u1 - 1);
        if (is_disc_) {
            const double radius = half_.x * std::sqrt(random.u0);
            sine = {radius * std::cos(2 * pi * random.u1), radius * std::sin(2 * pi * random.u1)};
        }
        const double square = glm::dot(sine, sine);
        if (square > stop_ * stop_ || square >= 1) {
            return std::nullopt;
        }
        return glm::dvec3(sine, -std::sqrt(1 - square));
    }

  private:
    physics::f64::RingLight ring_;
    bool is_ring_;
    bool is_disc_ = true;
    glm::dvec2 half_{0, 0}; // sines of the disc's radius, or of half the rectangle's sides
    double stop_ = 1;
};

// Each cell's share of the source's light, by paths that the lobe scatters.
PupilLight scattered_light(const Illumination& illumination, const specimen::Material& lobe, double aperture_sine) {
    const auto record = specimen::material_record(lobe);
    const MaterialScene scene(lobe);
    PupilLight light(pupil_light_cells, pupil_light_cells);
    const auto cell_of = [aperture_sine](double sine) {
        return static_cast<int>(std::floor(0.5 * (sine / aperture_sine + 1) * pupil_light_cells));
    };
    for (std::uint32_t path = 0; path < scattered_paths; ++path) {
        const auto incoming = illumination.direction(path);
        if (!incoming) {
            continue;
        }
        const auto scattered =
            physics::f64::scatter(scene, record, *incoming, {0, 0, 1}, seed, scatter_stream, {path, 0}, 1);
        const int column = cell_of(scattered.direction.x), row = cell_of(scattered.direction.y);
        if (scattered.accepted && is_in_pupil(column, row)) {
            light(column, row) += 1.0 / scattered_paths;
        }
    }
    return light;
}

// Each cell's share of the source's light, by the lobe's density at the middle of the cell. Mirror lobes have no
// density.
PupilLight integrated_light(const Illumination& illumination, const specimen::Material& lobe, double aperture_sine) {
    const auto record = specimen::material_record(lobe);
    const MaterialScene scene(lobe);
    PupilLight light(pupil_light_cells, pupil_light_cells);
    const double side = 2 * aperture_sine / pupil_light_cells;
    for (std::uint32_t point = 0; point < source_points; ++point) {
        const auto incoming = illumination.direction(point);
        for (int row = 0; incoming && row < light.rows; ++row) {
            for (int column = 0; column < light.columns; ++column) {
                if (is_in_pupil(column, row)) {
                    const glm::dvec2 sine = aperture_sine * glm::dvec2(middle_of(column), middle_of(row));
                    const glm::dvec3 outgoing(sine, std::sqrt(1 - glm::dot(sine, sine)));
                    // The solid angle is the area of direction cosines over the cosine, and the density has the cosine
                    // already.
                    light(column, row) += physics::f64::scatter_bsdf(scene, record, *incoming, {0, 0, 1}, outgoing) *
                                          side * side / source_points;
                }
            }
        }
    }
    return light;
}

double sum_of(const PupilLight& light) {
    return std::accumulate(light.values.begin(), light.values.end(), 0.0);
}

} // namespace

PupilLight pupil_light(const optics::InstrumentDescription& description, const optics::SourceDescription& source,
                       const optics::Instrument& instrument, const specimen::Material& material, double aperture_sine) {
    // A lobe that sends this share of its light into the pupil is sharp enough to be sampled by paths.
    constexpr double sharp = 0.25;
    const Illumination illumination(description, source, instrument, aperture_sine);
    PupilLight light(pupil_light_cells, pupil_light_cells);
    for (const auto& lobe : material.lobes) {
        const specimen::Material alone{{lobe}};
        PupilLight of_lobe = scattered_light(illumination, alone, aperture_sine);
        if (sum_of(of_lobe) < sharp * lobe.weight) {
            PupilLight integrated = integrated_light(illumination, alone, aperture_sine);
            of_lobe = sum_of(integrated) > 0 ? std::move(integrated) : std::move(of_lobe);
        }
        std::ranges::transform(light.values, of_lobe.values, light.values.begin(), std::plus<>());
    }
    const double sum = sum_of(light);
    const bool arrives = sum >= least_over_lambertian * aperture_sine * aperture_sine;
    for (double& share : light.values) {
        share = arrives ? share / sum : 0;
    }
    return light;
}

double contrast_error_of(const PupilLight& light) {
    constexpr std::array<std::pair<int, int>, 4> directions = {{{1, 0}, {0, 1}, {1, 1}, {1, -1}}};
    if (!(sum_of(light) > 0)) {
        return 1;
    }
    double largest = 0;
    for (const auto& [along_columns, along_rows] : directions) {
        for (int half = 1; half <= light.columns / 2; ++half) {
            const int aside = half * along_columns, up = half * along_rows;
            double of_middles = 0, of_ends = 0;
            for (int row = 0; row < light.rows; ++row) {
                for (int column = 0; column < light.columns; ++column) {
                    if (is_in_pupil(column - aside, row - up) && is_in_pupil(column + aside, row + up)) {
                        of_middles += light(column, row);
                        of_ends += 0.5 * (light(column - aside, row - up) + light(column + aside, row + up));
                    }
                }
            }
            largest = std::max(largest, std::abs(of_middles - of_ends));
        }
    }
    return largest;
}

} // namespace vkfv::measurement
