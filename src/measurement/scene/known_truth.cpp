#include "measurement/scene/known_truth.hpp"

#include "measurement/scene/assembly.hpp"
#include "optics/instrument/image_quality.hpp"
#include "specimen/description.hpp"
#include "specimen/kinds.hpp"

#include <algorithm>
#include <cmath>
#include <vector>

namespace vkfv::measurement {

namespace {

// The sideways displacement of the specimen by its stage as a function of the height of the focal plane, mm.
class WayAside {
  public:
    explicit WayAside(const Configuration& configuration) {
        const auto motion = stage_motion(configuration);
        if (!motion || !configuration.scan) {
            return;
        }
        const auto positions = configuration.scan->positions();
        for (std::size_t k = 0; k < positions.size(); ++k) {
            const auto taken = motion->mean(positions[k], static_cast<std::uint32_t>(k));
            points_.push_back({.height = taken.height, .beside = taken.beside});
        }
        std::ranges::stable_sort(points_, {}, &Point::height);
        moves_ = std::ranges::any_of(points_, [](const Point& point) { return point.beside != glm::dvec2(0); });
    }

    bool moves() const { return moves_; }

    // The displacement is linear between images; below the first and above the last it is theirs.
    glm::dvec2 at(double height) const {
        const auto above = std::ranges::lower_bound(points_, height, {}, &Point::height);
        if (above == points_.begin()) {
            return points_.front().beside;
        }
        if (above == points_.end()) {
            return points_.back().beside;
        }
        const Point& below = *(above - 1);
        const double share = (height - below.height) / (above->height - below.height);
        return glm::mix(below.beside, above->beside, share);
    }

  private:
    struct Point {
        double height;
        glm::dvec2 beside;
    };
    std::vector<Point> points_;
    bool moves_ = false;
};

class PixelTruth {
  public:
    PixelTruth(const optics::PixelMapping& mapping, const specimen::Specimen& specimen, const PixelGrid& nominal)
        : mapping_(mapping), specimen_(specimen), nominal_(nominal) {}

    // The heights of a specimen that stands displaced by aside(column, row), mm, while that pixel is in focus.
    template <class Aside>
    surface::HeightMap displaced(const Aside& aside) const {
        return specimen::truth(specimen_, nominal_, [&](int column, int row) {
            const glm::dvec2 at = nominal_at(column, row);
            const glm::dmat2 rate = mapping_.rate(at);
            return specimen::PixelArea{.middle = mapping_.place(at) - aside(column, row),
                                       .along_row = rate[0] * nominal_.pitch_x,
                                       .along_column = rate[1] * nominal_.pitch_y};
        });
    }

    // The heights, with the specimen's mean displacement by the stage over the pixels. The height of a pixel tells when
    // it is in focus and so where the specimen stands then, which in turn tells the height. Repetition solves this; it
    // converges where the specimen rises by less than the stage does while it moves by as much sideways.
    surface::HeightMap along(const WayAside& way, glm::dvec2& mean_aside) const {
        constexpr int most_repetitions = 6;
        constexpr double enough = 0.005; // share of a pitch
        constexpr double most_unsettled_share = 1e-3;
        auto heights = displaced([&](int, int) { return way.at(0); });
        Grid<glm::dvec2> aside(nominal_.columns, nominal_.rows, way.at(0));
        for (int repetition = 0; repetition < most_repetitions; ++repetition) {
            std::size_t unsettled = 0;
            for (int row = 0; row < nominal_.rows; ++row) {
                for (int column = 0; column < nominal_.columns; ++column) {
                    const double height = heights.height(column, row);
                    if (std::isfinite(height)) {
                        const glm::dvec2 there = way.at(height - mapping_.focus(nominal_at(column, row)));
                        unsettled += glm::distance(there, aside(column, row)) > enough * nominal_.pitch_x ? 1 : 0;
                        aside(column, row) = there;
                    }
                }
            }
            heights = displaced([&](int column, int row) { return aside(column, row); });
            if (static_cast<double>(unsettled) <= most_unsettled_share * static_cast<double>(aside.values.size())) {
                break;
            }
        }
        mean_aside = glm::dvec2(0);
        for (const glm::dvec2& one : aside.values) {
            mean_aside += one / static_cast<double>(aside.values.size());
        }
        return heights;
    }

  private:
    glm::dvec2 nominal_at(int column, int row) const {
        return {nominal_.x0 + column * nominal_.pitch_x, nominal_.y0 + row * nominal_.pitch_y};
    }

    const optics::PixelMapping& mapping_;
    const specimen::Specimen& specimen_;
    const PixelGrid nominal_;
};

} // namespace

double height_pitch(const optics::Instrument& instrument, const Configuration& configuration) {
    return configuration.assumed_pitch.value_or(instrument.first_order.pixel_pitch);
}

PixelGrid grid_of_image(const optics::Instrument& instrument, const Configuration& configuration, double focal_height) {
    PixelGrid grid =
        PixelGrid::centred(configuration.instrument.detector_pixels, height_pitch(instrument, configuration));
    glm::dvec2 shift(0);
    if (!optics::imaging_of(instrument).symmetric) {
        shift = optics::PixelMapping(configuration.instrument, instrument).deviation().shift;
    }
    if (const auto motion = stage_motion(configuration)) {
        shift -= motion->mean(focal_height, image_index(configuration, focal_height)).beside;
    }
    grid.x0 += shift.x;
    grid.y0 += shift.y;
    return grid;
}

KnownTruth truth_on_pixels(const optics::Instrument& instrument, const Configuration& configuration,
                           const specimen::Specimen& specimen) {
    const optics::PixelMapping mapping(configuration.instrument, instrument);
    const ImageSize pixels = configuration.instrument.detector_pixels;
    const double true_pitch = instrument.first_order.pixel_pitch, pitch = height_pitch(instrument, configuration);
    const PixelTruth truth(mapping, specimen, PixelGrid::centred(pixels, true_pitch));
    const WayAside way(configuration);
    KnownTruth known{.heights = {}, .undistorted = {}, .mapping = mapping.deviation()};
    known.mapping.amplification *= pitch / true_pitch;
    if (way.moves()) {
        glm::dvec2 mean_aside(0);
        known.heights = truth.along(way, mean_aside);
        known.mapping.shift -= mean_aside;
    } else {
        known.heights = truth.displaced([](int, int) { return glm::dvec2(0); });
    }
    PixelGrid grid = PixelGrid::centred(pixels, pitch);
    grid.x0 += known.mapping.shift.x;
    grid.y0 += known.mapping.shift.y;
    known.heights.x0 = grid.x0;
    known.heights.y0 = grid.y0;
    known.heights.pitch_x = known.heights.pitch_y = pitch;
    if (specimen::feature_of(*configuration.specimen)) {
        known.undistorted =
            specimen::truth(specimen, grid.columns, grid.rows, grid.x0, grid.y0, grid.pitch_x, grid.pitch_y);
    }
    return known;
}

} // namespace vkfv::measurement
