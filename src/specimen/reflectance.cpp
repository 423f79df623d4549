#include "specimen/reflectance.hpp"

#include "specimen/files.hpp"
#include "specimen/lengths.hpp"
#include "specimen/random_heights.hpp"

#include <fmt/format.h>
#include <spdlog/spdlog.h>

#include <algorithm>
#include <cmath>
#include <string>

namespace vkfv::specimen {
namespace {

using physics::f64::PATTERN_CHECKERBOARD;
using physics::f64::PATTERN_GRATING;
using physics::f64::PATTERN_GRID;
using physics::f64::PATTERN_STAR;

// Refusals as in lengths.hpp, for keys of [specimen.reflectance].
void require_share(const char* key, double value, const SourceLocation& where) {
    require(value >= 0 && value <= 1, where, std::string("reflectance.") + key, value, "a number in [0, 1]");
}
void require_length(const char* key, double value, const SourceLocation& where) {
    require_um(positive(value), where, std::string("reflectance.") + key, value, positive_um());
}

void check_factors(const Reflectance& reflectance, const SourceLocation& where) {
    require_share("lowest", reflectance.lowest, where);
    require_share("highest", reflectance.highest, where);
    require(reflectance.lowest <= reflectance.highest, where, "reflectance.lowest", reflectance.lowest,
            fmt::format("at most highest = {:.6g}", reflectance.highest));
    require_um(std::abs(reflectance.x) <= largest_length, where, "reflectance.x_um", reflectance.x,
               "a length within a kilometre");
    require_um(std::abs(reflectance.y) <= largest_length, where, "reflectance.y_um", reflectance.y,
               "a length within a kilometre");
    require(std::isfinite(reflectance.angle), where, "reflectance.angle_deg", reflectance.angle, "a finite angle");
}

void check_noise(const Reflectance& noise, const Rectangle& footprint, const SourceLocation& where) {
    require_share("mean", noise.mean, where);
    require_share("standard_deviation", noise.standard_deviation, where);
    require_length("pitch_um", noise.pitch, where);
    const double width = footprint.x_max - footprint.x_min, height = footprint.y_max - footprint.y_min;
    require_um(noise.correlation_length >= 0 && noise.correlation_length <= std::max(width, height), where,
               "reflectance.correlation_length_um", noise.correlation_length,
               "a length, 0 or more, at most the specimen's");
    // On a coarser grid linear interpolation would be visible.
    require_um(
        noise.correlation_length <= 0 || noise.pitch <= 0.5 * noise.correlation_length, where, "reflectance.pitch_um",
        noise.pitch,
        fmt::format("at most half the correlation length, {:.6g} um", 0.5 * noise.correlation_length * um_per_mm));
    check_work_of_noise(width, height, noise.pitch, 0.5 * noise.correlation_length, where, "reflectance.pitch_um");
}

Grid<float> noise_values(const Reflectance& noise, const Rectangle& footprint, const SourceLocation& where) {
    check_noise(noise, footprint, where);
    // Lengths that agree to 1e-9 count as equal, to allow for the rounding of a quotient.
    const auto points = [&](double length) {
        return static_cast<int>(std::ceil(length / noise.pitch * (1 - 1e-9))) + 1;
    };
    Grid<double> random =
        filtered_noise(points(footprint.x_max - footprint.x_min), points(footprint.y_max - footprint.y_min),
                       0.5 * noise.correlation_length / noise.pitch, noise.seed);
    subtract_mean(random);
    const double scale = noise.standard_deviation / root_mean_square(random);
    Grid<float> values(random.columns, random.rows);
    double sum = 0, squares = 0;
    std::size_t clipped = 0;
    for (std::size_t k = 0; k < values.values.size(); ++k) {
        const double wanted = noise.mean + scale * random.values[k];
        const double value = std::clamp(wanted, 0.0, 1.0);
        clipped += value != wanted ? 1 : 0;
        sum += value;
        squares += value * value;
        values.values[k] = static_cast<float>(value);
    }
    const auto count = static_cast<double>(values.values.size());
    const double mean = sum / count;
    spdlog::info("pattern: noise on {} x {} points, mean {:.4g}, standard deviation {:.4g}, {:.3g} % clipped",
                 values.columns, values.rows, mean, std::sqrt(std::max(0.0, squares / count - mean * mean)),
                 100.0 * static_cast<double>(clipped) / count);
    return values;
}

Grid<float> image_values(const Reflectance& image, const SourceLocation& where) {
    require_length("pitch_um", image.pitch, where);
    const std::string bytes = specimen_bytes(image.file, where, "specimen.reflectance.file");
    Grid<float> values = parse_image(bytes, image.file);
    const auto outside = std::ranges::find_if(values.values, [](float value) { return !(value >= 0 && value <= 1); });
    if (outside != values.values.end()) {
        const auto index = static_cast<int>(outside - values.values.begin());
        throw InputError({{image.file, 0, 0, {}},
                          fmt::format("column {}, row {} from below", index % values.columns, index / values.columns),
                          fmt::format("{}", *outside),
                          "reflectances in [0, 1]",
                          "Scale the image, or store it as integers, of which the largest means 1."});
    }
    return values;
}

} // namespace

ReflectanceMap make_reflectance_map(const Reflectance& reflectance, const Rectangle& footprint,
                                    const SourceLocation& where) {
    using enum Reflectance::Kind;
    check_factors(reflectance, where);
    ReflectanceMap map;
    map.record = {.lowest = reflectance.lowest,
                  .highest = reflectance.highest,
                  .centre_x = reflectance.x,
                  .centre_y = reflectance.y,
                  .axis_x = std::cos(reflectance.angle),
                  .axis_y = std::sin(reflectance.angle),
                  .per_mm = 1,
                  .cycles = reflectance.cycles,
                  .columns = 0,
                  .rows = 0,
                  .square = reflectance.square ? 1u : 0u,
                  .of_light = 0,
                  .kind = PATTERN_GRID};
    switch (reflectance.kind) {
    case even:
        map.record.kind = PATTERN_GRATING;
        map.record.lowest = map.record.highest;
        return map;
    case grating:
        require_length("period_um", reflectance.period, where);
        map.record.kind = PATTERN_GRATING;
        map.record.per_mm = 1 / reflectance.period;
        return map;
    case checkerboard:
        require_length("side_um", reflectance.side, where);
        map.record.kind = PATTERN_CHECKERBOARD;
        map.record.per_mm = 1 / reflectance.side;
        return map;
    case star:
        require(reflectance.cycles >= 1, where, "reflectance.cycles", reflectance.cycles, "at least 1");
        map.record.kind = PATTERN_STAR;
        return map;
    case noise:
        map.values = noise_values(reflectance, footprint, where);
        map.record.lowest = 0;
        map.record.highest = 1;
        map.record.centre_x = 0.5 * (footprint.x_min + footprint.x_max);
        map.record.centre_y = 0.5 * (footprint.y_min + footprint.y_max);
        map.record.axis_x = 1;
        map.record.axis_y = 0;
        break;
    case image:
        map.values = image_values(reflectance, where);
        break;
    }
    map.record.per_mm = 1 / reflectance.pitch;
    map.record.columns = map.values.columns;
    map.record.rows = map.values.rows;
    return map;
}

} // namespace vkfv::specimen
