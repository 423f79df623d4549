// The equations of EMVA 1288, on sums over the images.
#include "camera/photon_transfer.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

namespace vkfv::camera {

namespace {

constexpr double quantisation_variance = 1.0 / 12; // DN^2
// Below this variance in the dark, quantisation noise is not that of uniformly distributed values.
constexpr double least_dark_variance = 0.24;            // DN^2
constexpr double bound_of_dark_noise = 0.40;            // DN
constexpr double dark_deviation_of_quantisation = 0.49; // DN
constexpr double linear_share = 0.7; // end of the fits of gain and responsivity, relative to saturation
constexpr double linearity_from = 0.05, linearity_to = 0.95;
constexpr double decibels = 20;

using Member = MeasuredFigure PhotonTransferFigures::*;
constexpr std::array<Member, 11> members = {&PhotonTransferFigures::gain,
                                            &PhotonTransferFigures::quantum_efficiency,
                                            &PhotonTransferFigures::read_noise,
                                            &PhotonTransferFigures::capacity,
                                            &PhotonTransferFigures::signal_to_noise_db,
                                            &PhotonTransferFigures::dynamic_range_db,
                                            &PhotonTransferFigures::threshold,
                                            &PhotonTransferFigures::dark_signal,
                                            &PhotonTransferFigures::photo_response,
                                            &PhotonTransferFigures::dark_current,
                                            &PhotonTransferFigures::linearity_error};

struct Point {
    double x = 0, y = 0, weight = 1;
};

// The slope of the weighted fit y = slope x.
double slope_through_origin(const std::vector<Point>& points) {
    double product = 0, square = 0;
    for (const auto& [x, y, weight] : points) {
        product += weight * x * y;
        square += weight * x * x;
    }
    return product / square;
}

struct Line {
    double offset = 0, slope = 0;
};

Line line_through(const std::vector<Point>& points) {
    double sum = 0, x_mean = 0, y_mean = 0;
    for (const auto& [x, y, weight] : points) {
        sum += weight;
        x_mean += weight * x;
        y_mean += weight * y;
    }
    x_mean /= sum;
    y_mean /= sum;
    double product = 0, square = 0;
    for (const auto& [x, y, weight] : points) {
        product += weight * (x - x_mean) * (y - y_mean);
        square += weight * (x - x_mean) * (x - x_mean);
    }
    return {.offset = y_mean - product / square * x_mean, .slope = product / square};
}

// The coefficients of the least-squares cubic, by elimination in the normal equations, for x within -1 ... 1.
std::array<double, 4> cubic_through(const std::vector<Point>& points) {
    std::array<std::array<double, 5>, 4> equations{};
    for (const auto& [x, y, weight] : points) {
        const std::array<double, 4> powers = {1, x, x * x, x * x * x};
        for (std::size_t row = 0; row < 4; ++row) {
            for (std::size_t column = 0; column < 4; ++column) {
                equations[row][column] += weight * powers[row] * powers[column];
            }
            equations[row][4] += weight * powers[row] * y;
        }
    }
    for (std::size_t pivot = 0; pivot < 4; ++pivot) { // positive definite, so no pivoting is needed
        for (std::size_t row = 0; row < 4; ++row) {
            if (row == pivot) {
                continue;
            }
            const double factor = equations[row][pivot] / equations[pivot][pivot];
            for (std::size_t column = pivot; column < 5; ++column) {
                equations[row][column] -= factor * equations[pivot][column];
            }
        }
    }
    std::array<double, 4> coefficients{};
    for (std::size_t row = 0; row < 4; ++row) {
        coefficients[row] = equations[row][4] / equations[row][row];
    }
    return coefficients;
}

struct Nonuniformity {
    double mean = 0;     // DN
    double variance = 0; // DN^2, of the pixels, without the remaining temporal noise
};

Nonuniformity nonuniformity_of(const std::vector<StackSums>& stack, int averaged, int left_out) {
    StackSums all;
    for (std::size_t band = 0; band < stack.size(); ++band) {
        if (static_cast<int>(band) != left_out) {
            all.pixels += stack[band].pixels;
            all.mean += stack[band].mean;
            all.squared_mean += stack[band].squared_mean;
            all.variance += stack[band].variance;
        }
    }
    const double mean = all.mean / all.pixels;
    return {.mean = mean,
            .variance = all.squared_mean / all.pixels - mean * mean - all.variance / all.pixels / averaged};
}

double linearity_of(const std::vector<PairLevel>& series, double saturation, double dark, int left_out) {
    std::vector<Point> points;
    for (const auto& level : series) {
        if (level.photons >= linearity_from * saturation && level.photons <= linearity_to * saturation) {
            const double value = mean_value(level, left_out) - dark;
            points.push_back({level.photons, value, 1 / (value * value)});
        }
    }
    const Line line = line_through(points);
    double error = 0;
    for (const auto& point : points) {
        const double fitted = line.offset + line.slope * point.x;
        error += std::abs(point.y - fitted) / fitted / static_cast<double>(points.size());
    }
    return error;
}

double root_of(double variance) {
    return std::sqrt(std::max(0.0, variance));
}

// The figures' values, without standard errors.
PhotonTransferFigures figures_without(const PhotonTransferData& data, int left_out) {
    const PairLevel& dark = data.series.front();
    const double dark_mean = mean_value(dark, left_out), dark_variance = temporal_variance(dark, left_out);
    const double saturation = photons_of_peak(data.peak, left_out);
    std::vector<Point> transfer, response;
    for (const auto& level : data.series) {
        if (level.photons > 0 && level.photons <= linear_share * saturation) {
            const double value = mean_value(level, left_out) - dark_mean, variance = temporal_variance(level, left_out);
            // The standard error of a variance is proportional to it, that of a mean to the variance's root; weights
            // are inverse squares.
            transfer.push_back({value, variance - dark_variance, 1 / (variance * variance)});
            response.push_back({level.photons, value, 1 / variance});
        }
    }
    PhotonTransferFigures figures;
    const double gain = slope_through_origin(transfer);
    const double efficiency = slope_through_origin(response) / gain;
    figures.gain.value = gain;
    figures.quantum_efficiency.value = efficiency;
    const bool quantised = dark_variance < least_dark_variance;
    figures.read_noise = {.value =
                              (quantised ? bound_of_dark_noise : root_of(dark_variance - quantisation_variance)) / gain,
                          .bounded = quantised};
    figures.capacity.value = efficiency * saturation;
    figures.signal_to_noise_db.value = decibels * std::log10(std::sqrt(efficiency * saturation));
    const double dark_deviation = quantised ? dark_deviation_of_quantisation : root_of(dark_variance);
    figures.threshold.value = (dark_deviation / gain + 0.5) / efficiency;
    figures.dynamic_range_db.value = decibels * std::log10(saturation / figures.threshold.value);
    const auto spatial_dark = nonuniformity_of(data.dark_stack, data.averaged, left_out);
    const auto spatial_flat = nonuniformity_of(data.flat_stack, data.averaged, left_out);
    figures.dark_signal.value = root_of(spatial_dark.variance) / gain;
    figures.photo_response.value =
        root_of(spatial_flat.variance - spatial_dark.variance) / (spatial_flat.mean - spatial_dark.mean);
    figures.dark_current.value = std::numeric_limits<double>::quiet_NaN();
    if (!data.dark.empty()) {
        std::vector<Point> points;
        for (const auto& level : data.dark) {
            points.push_back(
                {level.exposure_time, mean_value(level, left_out), 1 / temporal_variance(level, left_out)});
        }
        figures.dark_current.value = line_through(points).slope / gain;
    }
    figures.linearity_error.value = linearity_of(data.series, saturation, dark_mean, left_out);
    return figures;
}

} // namespace

double photons_of_peak(const std::vector<PairLevel>& levels, int left_out) {
    const double middle = (levels.front().photons + levels.back().photons) / 2;
    const double reach = (levels.back().photons - levels.front().photons) / 2;
    std::vector<Point> points;
    for (const auto& level : levels) {
        points.push_back({(level.photons - middle) / reach, temporal_variance(level, left_out)});
    }
    const auto c = cubic_through(points);
    // The maximum is the one of the slope's two zeros with a negative curvature.
    const double root = std::sqrt(std::max(0.0, c[2] * c[2] - 3 * c[1] * c[3]));
    const double place = -c[1] / (c[2] - root);
    return middle + reach * std::clamp(place, -1.0, 1.0);
}

// Standard errors follow by the jackknife: B. Efron, "The Jackknife, the Bootstrap and Other Resampling Plans" (1982),
// ch. 3.
PhotonTransferFigures photon_transfer_figures(const PhotonTransferData& data) {
    PhotonTransferFigures figures = figures_without(data, -1);
    const auto count = static_cast<int>(data.dark_stack.size());
    std::vector<PhotonTransferFigures> without;
    for (int band = 0; band < count; ++band) {
        without.push_back(figures_without(data, band));
    }
    for (const Member member : members) {
        double mean = 0, square = 0;
        for (const auto& one : without) {
            mean += (one.*member).value / count;
        }
        for (const auto& one : without) {
            square += ((one.*member).value - mean) * ((one.*member).value - mean);
        }
        if (!(figures.*member).bounded) {
            (figures.*member).error = std::sqrt(square * (count - 1) / count);
        }
    }
    return figures;
}

PhotonTransferFigures expected_figures(const Camera& camera) {
    const CameraOptions& options = camera.options();
    PhotonTransferFigures figures;
    figures.gain.value = options.gain;
    figures.quantum_efficiency.value = camera.quantum_efficiency();
    figures.read_noise.value = options.read_noise;
    figures.capacity.value = options.full_well;
    figures.signal_to_noise_db.value = decibels * std::log10(camera.largest_signal_to_noise());
    figures.dynamic_range_db.value = decibels * std::log10(camera.dynamic_range());
    figures.threshold.value = camera.least_electrons() / camera.quantum_efficiency();
    figures.dark_signal.value = options.dark_signal;
    figures.photo_response.value = options.photo_response;
    figures.dark_current.value =
        options.dark_current > 0 ? options.dark_current : std::numeric_limits<double>::quiet_NaN();
    figures.linearity_error.value = 0;
    return figures;
}

} // namespace vkfv::camera
