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

// A pixel sees the specimen by this displacement and magnification while the focal plane stands at one height.
struct Sight {
    glm::dvec2 beside{0};   // mm, displacement of the specimen by its stage
    double image_scale = 1; // magnification over that at z = 0
};

// Sight as a function of the height of the focal plane, mm.
class WayAside {
  public:
    WayAside(const Configuration& configuration, double magnification_rate) : magnification_rate_(magnification_rate) {
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
        if (std::ranges::all_of(points_, [](const Point& point) { return point.beside == glm::dvec2(0); })) {
            points_.clear();
        }
    }

    bool moves() const { return !points_.empty() || magnification_rate_ != 0; }

    Sight at(double height) const {
        return {.beside = beside_at(height), .image_scale = 1 + magnification_rate_ * height};
    }

  private:
    // The displacement is linear between images; below the first and above the last it is theirs.
    glm::dvec2 beside_at(double height) const {
        if (points_.empty()) {
            return glm::dvec2(0);
        }
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

    struct Point {
        double height;
        glm::dvec2 beside;
    };
    double magnification_rate_; // 1/mm
    std::vector<Point> points_; // images of a stage that moves sideways
};

class PixelTruth {
  public:
    PixelTruth(const optics::PixelMapping& mapping, const specimen::Specimen& specimen, const PixelGrid& nominal)
        : mapping_(mapping), specimen_(specimen), nominal_(nominal) {}

    // The heights of a specimen that each pixel sees as sight(column, row) tells while it is in focus.
    template <class SightOf>
    surface::HeightMap seen(const SightOf& sight) const {
        return specimen::truth(specimen_, nominal_, [&](int column, int row) {
            const glm::dvec2 at = nominal_at(column, row);
            const Sight one = sight(column, row);
            const glm::dmat2 rate = mapping_.rate(at, one.image_scale);
            return specimen::PixelArea{.middle = mapping_.place(at, one.image_scale) - one.beside,
                                       .along_row = rate[0] * nominal_.pitch_x,
                                       .along_column = rate[1] * nominal_.pitch_y};
        });
    }

    // The heights, with the mean sight of the pixels. The height of a pixel tells when it is in focus and so what it
    // sees then, which in turn tells the height. Repetition solves this; it converges where the specimen rises by less
    // than the focal plane does while the image moves by as much sideways.
    surface::HeightMap along(const WayAside& way, Sight& mean) const {
        constexpr int most_repetitions = 6;
        constexpr double enough = 0.005; // share of a pitch
        constexpr double most_unsettled_share = 1e-3;
        auto heights = seen([&](int, int) { return way.at(0); });
        Grid<Sight> sights(nominal_.columns, nominal_.rows, way.at(0));
        for (int repetition = 0; repetition < most_repetitions; ++repetition) {
            std::size_t unsettled = 0;
            for (int row = 0; row < nominal_.rows; ++row) {
                for (int column = 0; column < nominal_.columns; ++column) {
                    const double height = heights.height(column, row);
                    if (std::isfinite(height)) {
                        const glm::dvec2 at = nominal_at(column, row);
                        Sight& sight = sights(column, row);
                        const Sight there = way.at(height - mapping_.focus(at, sight.image_scale));
                        const double moved = glm::distance(there.beside, sight.beside) +
                                             std::abs(there.image_scale - sight.image_scale) * glm::length(at);
                        unsettled += moved > enough * nominal_.pitch_x ? 1 : 0;
                        sight = there;
                    }
                }
            }
            heights = seen([&](int column, int row) { return sights(column, row); });
            if (static_cast<double>(unsettled) <= most_unsettled_share * static_cast<double>(sights.values.size())) {
                break;
            }
        }
        mean = {.beside = glm::dvec2(0), .image_scale = 0};
        const double share = 1 / static_cast<double>(sights.values.size());
        for (const Sight& one : sights.values) {
            mean.beside += share * one.beside;
            mean.image_scale += share * one.image_scale;
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
    const WayAside way(configuration, instrument.magnification_rate);
    KnownTruth known{.heights = {}, .undistorted = {}, .mapping = mapping.deviation()};
    known.mapping.amplification *= pitch / true_pitch;
    if (way.moves()) {
        Sight mean;
        known.heights = truth.along(way, mean);
        known.mapping.shift -= mean.beside;
        known.mapping.amplification *= mean.image_scale;
    } else {
        known.heights = truth.seen([](int, int) { return Sight{}; });
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
