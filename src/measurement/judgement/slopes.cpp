#include "measurement/judgement/slopes.hpp"

#include "core/mathematics/pixel_grid.hpp"
#include "core/mathematics/units.hpp"
#include "measurement/scene/pupil_light.hpp"
#include "specimen/description.hpp"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <vector>

namespace vkfv::measurement {

namespace {

constexpr double least_light = 0.01; // share of the most light that a facet sends
constexpr double slope_step = 5;     // degrees

// The share of the paths that a facet of this tilt (rad) sends into the aperture.
double light_of_facet(const specimen::Material& material, const optics::InstrumentDescription& description,
                      const optics::Instrument& instrument, double aperture_sine, double tilt) {
    constexpr std::uint32_t paths = 4096, seed = 1, source_stream = 0, scatter_stream = 1;
    const auto record = specimen::material_record(material);
    const MaterialScene scene(material);
    const glm::dvec3 normal(std::sin(tilt), 0, std::cos(tilt));
    const double filling = instrument.first_order.pupil_radius_in_source;
    const double fill = filling > 0 ? std::min(1.0, description.source.outer_radius() / filling) : 1;
    std::uint32_t seen = 0;
    for (std::uint32_t path = 0; path < paths; ++path) {
        const auto random = physics::f64::draw(seed, source_stream, {path, 0}, 0);
        const double azimuth = 2 * pi * random.u1;
        const double sine = description.source.ring ? std::cos(description.source.ring->elevation)
                                                    : fill * aperture_sine * std::sqrt(random.u0);
        const glm::dvec3 incoming(sine * std::cos(azimuth), sine * std::sin(azimuth), -std::sqrt(1 - sine * sine));
        if (glm::dot(incoming, normal) >= 0) {
            continue;
        }
        const auto scattered =
            physics::f64::scatter(scene, record, incoming, normal, seed, scatter_stream, {path, 0}, 1);
        if (scattered.accepted && scattered.direction.z > 0 &&
            std::hypot(scattered.direction.x, scattered.direction.y) <= aperture_sine) {
            ++seen;
        }
    }
    return static_cast<double>(seen) / paths;
}

double steepest_seen(const Configuration& configuration, const optics::Instrument& instrument,
                     const specimen::Specimen& specimen) {
    const double aperture_sine =
        std::min(1.0, instrument.first_order.numerical_aperture / instrument.first_order.object_index);
    std::vector<double> light;
    for (double tilt = 0; tilt < 90; tilt += slope_step) {
        light.push_back(light_of_facet(specimen.material, configuration.instrument, instrument, aperture_sine,
                                       tilt * radians_per_degree));
    }
    const double least = least_light * *std::ranges::max_element(light);
    std::size_t last = light.size();
    while (last > 0 && !(light[last - 1] > least)) {
        --last;
    }
    if (last == 0) {
        return Expectation::unknown; // no facet sends light back
    }
    return std::min(90.0, static_cast<double>(last) * slope_step) * radians_per_degree;
}

} // namespace

void expect_slopes(const Configuration& configuration, const optics::Instrument& instrument,
                   const specimen::Specimen& specimen, Expectation& expected) {
    constexpr int most_points = 256; // a side
    const ImageSize pixels = configuration.instrument.detector_pixels;
    const double pitch = instrument.first_order.pixel_pitch;
    const int columns = std::min(pixels.columns, most_points), rows = std::min(pixels.rows, most_points);
    // The middle part of a large field stands for it, since slopes need neighbouring pixels.
    const auto grid = PixelGrid::centred(columns, rows, pitch);
    const auto truth = specimen::truth(specimen, columns, rows, grid.x0, grid.y0, pitch, pitch);
    const auto positions = configuration.scan->positions();
    expected.steepest = steepest_seen(configuration, instrument, specimen);
    const double steepest = std::isnan(expected.steepest) ? 0.5 * pi : expected.steepest;
    double sloped = 0, measurable = 0, all = 0;
    for (int row = 0; row < rows; ++row) {
        for (int column = 0; column < columns; ++column) {
            all += 1;
            const double height = truth.height(column, row);
            const auto gradient = [&](int dx, int dy) {
                const bool before = column >= dx && row >= dy;
                const bool after = column + dx < columns && row + dy < rows;
                const double from = before ? truth.height(column - dx, row - dy) : height;
                const double to = after ? truth.height(column + dx, row + dy) : height;
                return before || after ? (to - from) / (pitch * ((before ? 1 : 0) + (after ? 1 : 0))) : 0;
            };
            const double slope = std::atan(std::hypot(gradient(1, 0), gradient(0, 1)));
            if (!std::isfinite(height) || !std::isfinite(slope)) {
                continue;
            }
            const auto bound = std::ranges::lower_bound(Expectation::slope_bounds, slope / radians_per_degree);
            const auto place = std::min<std::ptrdiff_t>(bound - Expectation::slope_bounds.begin(),
                                                        std::ssize(Expectation::slope_bounds) - 1);
            expected.slope_shares[static_cast<std::size_t>(place)] += 1;
            sloped += 1;
            measurable += height >= positions.front() && height <= positions.back() && slope <= steepest ? 1 : 0;
        }
    }
    for (double& share : expected.slope_shares) {
        share = sloped > 0 ? share / sloped : 0;
    }
    expected.measurable_share = all > 0 ? measurable / all : 0;
}

} // namespace vkfv::measurement
