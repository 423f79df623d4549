#include "measurement/instrument/wave_figures.hpp"

#include "core/mathematics/units.hpp"
#include "optics/waves/levelled_wavefront.hpp"
#include "optics/waves/zernike.hpp"

#include <fmt/format.h>

#include <cmath>
#include <future>
#include <limits>
#include <tuple>
#include <utility>

namespace vkfv::measurement {

namespace {

constexpr int half_heights = 20;
constexpr int frequency_steps = 48;
constexpr int half_places = 40;
constexpr double rings_shown = 5; // dark rings of an ideal lens within a point spread
constexpr int zernike_terms = 37;
constexpr int half_pupil = 64;

WaveAxes axes_of(const optics::PointWaves& on_axis, double reach) {
    WaveAxes axes;
    for (int i = -half_heights; i <= half_heights; ++i) {
        axes.heights.push_back(reach * i / half_heights);
    }
    for (int i = 0; i <= frequency_steps; ++i) {
        axes.frequencies.push_back(on_axis.cutoff() * i / frequency_steps);
    }
    // Dark rings of an ideal lens lie about 1 / cutoff apart.
    for (int i = -half_places; i <= half_places; ++i) {
        axes.places.push_back(rings_shown / on_axis.cutoff() * i / half_places);
    }
    return axes;
}

int count(const std::vector<double>& values) {
    return static_cast<int>(values.size());
}

void measure_wavefront(WavePoint& point, const optics::PointWaves& image) {
    const optics::Wavefront& wavefront = image.middle();
    point.aperture = std::sqrt(wavefront.area() / pi);
    point.wavelength_um = wavefront.wavelength() * um_per_mm;
    const optics::LevelledWavefront levelled = optics::levelled(wavefront);
    const optics::WavefrontQuality quality = optics::wavefront_quality(image);
    point.wavefront_rms = quality.rms;
    point.strehl = quality.strehl;
    point.zernike = optics::zernike_coefficients(wavefront, zernike_terms);
    const double along_disc = wavefront.smallest_rim() / 2; // Z2 = 2 x, Z3 = 2 y
    point.zernike[0] -= levelled.piston / wavefront.wavelength();
    point.zernike[1] -= along_disc * levelled.tilt.x / wavefront.wavelength();
    point.zernike[2] -= along_disc * levelled.tilt.y / wavefront.wavelength();
    point.pupil_radius = wavefront.largest_rim();
    point.wavefront = Grid<double>(2 * half_pupil + 1, 2 * half_pupil + 1);
    for (int row = 0; row < point.wavefront.rows; ++row) {
        for (int column = 0; column < point.wavefront.columns; ++column) {
            const glm::dvec2 p = point.pupil_radius / half_pupil * glm::dvec2(column - half_pupil, row - half_pupil);
            point.wavefront(column, row) =
                wavefront.passes(wavefront.chief() + p)
                    ? (wavefront.path(wavefront.chief() + p) - levelled.piston - glm::dot(levelled.tilt, p)) /
                          wavefront.wavelength()
                    : std::numeric_limits<double>::quiet_NaN();
        }
    }
}

// mirrored: the point spread is the same on both sides of the radial direction, as with a symmetric instrument.
void measure_spread(WavePoint& point, const WaveAxes& axes, const optics::PointWaves& image, bool mirrored) {
    const double reach = axes.places.back();
    const optics::PointSpread spread = image.point_spread(std::sqrt(2.0) * reach);
    const glm::dvec2 tangential(-point.radial.y, point.radial.x);
    point.dark_rings = spread.dark_rings(3);
    point.encircled_in_rings = spread.encircled(point.dark_rings);
    std::vector<double> radii;
    for (int i = 1; i <= half_places; ++i) {
        radii.push_back(reach * i / half_places);
    }
    const auto light = spread.encircled(radii);
    point.encircled.emplace_back(0, 0);
    for (std::size_t i = 0; i < radii.size(); ++i) {
        point.encircled.emplace_back(radii[i], light[i]);
    }
    point.spread = Grid<double>(count(axes.places), count(axes.places));
    for (int row = 0; row < point.spread.rows; ++row) {
        for (int column = 0; column < point.spread.columns; ++column) {
            if (mirrored && row > half_places) {
                point.spread(column, row) = point.spread(column, 2 * half_places - row);
                continue;
            }
            const glm::dvec2 at = axes.places[static_cast<std::size_t>(column)] * point.radial +
                                  axes.places[static_cast<std::size_t>(row)] * tangential;
            point.spread(column, row) = spread.value(at) / spread.ideal_peak();
        }
    }
}

// round: all directions across the axis are alike.
void measure_through_focus(WavePoint& point, const WaveAxes& axes, const optics::PointWaves& focused, bool round) {
    const glm::dvec2 tangential(-point.radial.y, point.radial.x);
    point.radial_transfer = Grid<std::complex<double>>(count(axes.frequencies), count(axes.heights));
    point.tangential_transfer = point.radial_transfer;
    point.spread_through_focus = Grid<double>(count(axes.places), count(axes.heights));
    for (int row = 0; row < count(axes.heights); ++row) {
        const optics::PointWaves image = focused.at_height(axes.heights[static_cast<std::size_t>(row)]);
        for (int column = 0; column < count(axes.frequencies); ++column) {
            const double frequency = axes.frequencies[static_cast<std::size_t>(column)];
            point.radial_transfer(column, row) = image.transfer(frequency * point.radial);
            point.tangential_transfer(column, row) =
                round ? point.radial_transfer(column, row) : image.transfer(frequency * tangential);
        }
        const optics::PointSpread spread = image.point_spread(axes.places.back());
        point.strehl_of_height.push_back(spread.strehl());
        for (int column = 0; column < count(axes.places); ++column) {
            point.spread_through_focus(column, row) =
                spread.value(axes.places[static_cast<std::size_t>(column)] * point.radial) / spread.ideal_peak();
        }
    }
}

} // namespace

WaveFigures wave_figures(const optics::Instrument& instrument, double reach) {
    const double edge = instrument.first_order.field_edge;
    const glm::dvec2 corner = instrument.first_order.field_corner;
    const bool symmetric = optics::imaging_of(instrument).symmetric;
    WaveFigures figures;
    std::vector<std::future<WavePoint>> points;
    for (const auto& [name, field, radial] : {std::tuple{"axis", glm::dvec2(0), glm::dvec2(1, 0)},
                                              std::tuple{"edge", glm::dvec2(edge, 0), glm::dvec2(1, 0)},
                                              std::tuple{"corner", corner, glm::normalize(corner)}}) {
        const optics::PointWaves image(instrument, field, optics::wavelengths_of_figures);
        if (image.middle().largest_rim() == 0) {
            continue;
        }
        if (points.empty()) {
            figures.axes = axes_of(image, reach);
        }
        points.push_back(std::async(std::launch::async, [=, axes = figures.axes] {
            WavePoint point;
            point.name = name;
            point.field = field;
            point.radial = radial;
            measure_wavefront(point, image);
            measure_spread(point, axes, image, symmetric);
            measure_through_focus(point, axes, image, symmetric && field == glm::dvec2(0));
            return point;
        }));
    }
    for (std::future<WavePoint>& point : points) {
        figures.points.push_back(point.get());
    }
    return figures;
}

std::string summary(const WaveFigures& figures) {
    std::string text = fmt::format("{:8} {:>18} {:>8} {:>16} {:>12} {:>16}\n", "point", "x, y / um", "NA",
                                   "wavefront / waves", "Strehl ratio", "dark ring / um");
    for (const WavePoint& point : figures.points) {
        text += fmt::format("{:8} {:>18} {:8.4f} {:16.4f} {:12.4f} {:>16}\n", point.name,
                            fmt::format("{:.4g}, {:.4g}", point.field.x * um_per_mm, point.field.y * um_per_mm),
                            point.aperture, point.wavefront_rms, point.strehl,
                            point.dark_rings.empty() ? std::string("-")
                                                     : fmt::format("{:.4f}", point.dark_rings.front() * um_per_mm));
    }
    return text;
}

nlohmann::ordered_json wave_json(const WaveFigures& figures) {
    auto points = nlohmann::ordered_json::array();
    for (const WavePoint& point : figures.points) {
        auto rings = nlohmann::ordered_json::array();
        for (std::size_t i = 0; i < point.dark_rings.size(); ++i) {
            rings.push_back({{"radius_um", point.dark_rings[i] * um_per_mm}, {"light", point.encircled_in_rings[i]}});
        }
        auto focus = nlohmann::ordered_json::array();
        for (std::size_t i = 0; i < figures.axes.heights.size(); ++i) {
            focus.push_back({{"z_um", figures.axes.heights[i] * um_per_mm}, {"strehl", point.strehl_of_height[i]}});
        }
        nlohmann::ordered_json entry = {{"point", point.name},
                                        {"x_um", point.field.x * um_per_mm},
                                        {"y_um", point.field.y * um_per_mm},
                                        {"aperture", point.aperture},
                                        {"wavelength_um", point.wavelength_um},
                                        {"wavefront_rms_waves", point.wavefront_rms},
                                        {"strehl", point.strehl},
                                        {"dark_rings", rings},
                                        {"through_focus", focus}};
        points.push_back(std::move(entry));
    }
    return {{"cutoff_per_mm", figures.axes.frequencies.empty() ? 0 : figures.axes.frequencies.back()},
            {"points", points}};
}

} // namespace vkfv::measurement
