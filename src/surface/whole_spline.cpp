#include "surface/whole_spline.hpp"

#include "core/mathematics/fourier.hpp"
#include "core/mathematics/units.hpp"
#include "surface/filter.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

namespace vkfv::surface {
namespace {

// Longer nesting indices leave a plane, to 1e-8 of the part that bends.
constexpr double longest = 100; // in units of the map's length

// The factor 1 / (2 sin(pi pitch / L)) of ISO 16610-22; below the Nyquist wavelength it has the value there.
double stiffness(double nesting_index, double pitch) {
    return 0.5 / std::sin(pi * std::min(0.5, pitch / nesting_index));
}

// The second point minus the first, of cosine k of n points, normalised to a sum of squares of 1.
double end_slope(int k, int n) {
    return k == 0 ? 0 : -2 * std::sqrt(2.0 / n) * std::sin(pi * k / n) * std::sin(pi * k / (2 * n));
}

double norm(int k, int n) {
    return std::sqrt((k == 0 ? 1.0 : 2.0) / n);
}

template <class Slopes, class Function>
void for_each(Slopes& slopes, const Function& function) {
    for (const int parity : {0, 1}) {
        function(
            slopes.at_x[static_cast<std::size_t>(parity)], [parity](auto& other) -> auto& {
                return other.at_x[static_cast<std::size_t>(parity)];
            });
        function(
            slopes.at_y[static_cast<std::size_t>(parity)], [parity](auto& other) -> auto& {
                return other.at_y[static_cast<std::size_t>(parity)];
            });
    }
}

template <class Slopes>
double dot(const Slopes& a, const Slopes& b) {
    double sum = 0;
    for_each(a, [&](const std::vector<double>& values, const auto& same) {
        for (std::size_t k = 0; k < values.size(); ++k)
            sum += values[k] * same(b)[k];
    });
    return sum;
}

// Adds factor * from to `to`.
template <class Slopes>
void add(Slopes& to, double factor, const Slopes& from) {
    for_each(to, [&](std::vector<double>& values, const auto& same) {
        for (std::size_t k = 0; k < values.size(); ++k)
            values[k] += factor * same(from)[k];
    });
}

template <class Slopes>
Slopes over(Slopes slopes, const Slopes& diagonal) {
    for_each(slopes, [&](std::vector<double>& values, const auto& same) {
        for (std::size_t k = 0; k < values.size(); ++k)
            values[k] /= same(diagonal)[k];
    });
    return slopes;
}

} // namespace

WholeSpline::WholeSpline(const HeightMap& map, double nesting_index, SplineEnds ends)
    : columns_(map.columns()), rows_(map.rows()), ends_(ends), transmission_(columns_, rows_) {
    if (ends == SplineEnds::mirrored) {
        for (int row = 0; row < rows_; ++row)
            for (int column = 0; column < columns_; ++column) {
                const double frequency =
                    std::hypot(column / (2 * columns_ * map.pitch_x), row / (2 * rows_ * map.pitch_y));
                transmission_(column, row) = 1 / (1 + std::pow(nesting_index * frequency, 4));
            }
        return;
    }
    const double index = std::min(nesting_index, longest * std::max(columns_ * map.pitch_x, rows_ * map.pitch_y));
    const double a_x = stiffness(index, map.pitch_x), a_y = stiffness(index, map.pitch_y);
    missing_x_ = 2 * std::pow(a_x, 4);
    missing_y_ = 2 * std::pow(a_y, 4);
    std::vector<double> bend_x, bend_y; // eigenvalues of -1 times the second difference, times a^2
    for (int k = 0; k < columns_; ++k) {
        end_x_.push_back(end_slope(k, columns_));
        bend_x.push_back(std::pow(2 * a_x * std::sin(pi * k / (2 * columns_)), 2));
    }
    for (int k = 0; k < rows_; ++k) {
        end_y_.push_back(end_slope(k, rows_));
        bend_y.push_back(std::pow(2 * a_y * std::sin(pi * k / (2 * rows_)), 2));
    }
    diagonal_ = slopes_of({});
    for (int l = 0; l < rows_; ++l)
        for (int k = 0; k < columns_; ++k) {
            const auto i = static_cast<std::size_t>(k), j = static_cast<std::size_t>(l);
            const double bend = bend_x[i] + bend_y[j], passes = 1 / (1 + bend * bend);
            transmission_(k, l) = passes;
            diagonal_.at_x[i % 2][j] += end_x_[i] * end_x_[i] * passes;
            diagonal_.at_y[j % 2][i] += end_y_[j] * end_y_[j] * passes;
        }
    constexpr double rounding = 1e-14;
    for (const std::size_t parity : {0u, 1u}) {
        for (double& value : diagonal_.at_x[parity])
            value = missing_x_ * std::max(rounding, 1 - missing_x_ * value);
        for (double& value : diagonal_.at_y[parity])
            value = missing_y_ * std::max(rounding, 1 - missing_y_ * value);
    }
}

WholeSpline::Slopes WholeSpline::slopes_of(const Grid<double>& amplitudes) const {
    Slopes slopes;
    for (const std::size_t parity : {0u, 1u}) {
        slopes.at_x[parity].resize(static_cast<std::size_t>(rows_));
        slopes.at_y[parity].resize(static_cast<std::size_t>(columns_));
    }
    if (amplitudes.values.empty())
        return slopes;
    for (std::size_t j = 0; j < end_y_.size(); ++j) {
        const double* const row = amplitudes.values.data() + j * end_x_.size();
        std::vector<double>& along_x = slopes.at_y[j % 2];
        double sums[2] = {0, 0};
        for (std::size_t i = 0; i < end_x_.size(); ++i) {
            sums[i % 2] += end_x_[i] * row[i];
            along_x[i] += end_y_[j] * row[i];
        }
        slopes.at_x[0][j] = sums[0];
        slopes.at_x[1][j] = sums[1];
    }
    return slopes;
}

WholeSpline::Slopes WholeSpline::times_correction(const Slopes& slopes) const {
    Slopes result = slopes_of({});
    for (std::size_t j = 0; j < end_y_.size(); ++j) {
        const double* const row = transmission_.values.data() + j * end_x_.size();
        const std::vector<double>& along_x = slopes.at_y[j % 2];
        std::vector<double>& result_along_x = result.at_y[j % 2];
        const double factor = missing_x_ * missing_y_ * end_y_[j];
        const double across[2] = {factor * slopes.at_x[0][j], factor * slopes.at_x[1][j]};
        double sums[2] = {0, 0};
        for (std::size_t i = 0; i < end_x_.size(); ++i) {
            const double both = end_x_[i] * row[i];
            sums[i % 2] += both * along_x[i];
            result_along_x[i] -= both * across[i % 2];
        }
        for (const std::size_t parity : {0u, 1u})
            result.at_x[parity][j] = -factor * sums[parity];
    }
    for_each(result, [&](std::vector<double>& values, const auto& same) {
        for (std::size_t k = 0; k < values.size(); ++k)
            values[k] += same(diagonal_)[k] * same(slopes)[k];
    });
    return result;
}

WholeSpline::Slopes WholeSpline::solved(const Slopes& right) const {
    constexpr double goal = 1e-26; // squared
    constexpr int most_steps = 2000;
    Slopes solution = slopes_of({}), residual = right;
    Slopes smooth = over(residual, diagonal_), direction = smooth;
    const double first = dot(residual, smooth);
    double now = first;
    for (int step = 0; step < most_steps && now > goal * first; ++step) {
        const Slopes image = times_correction(direction);
        const double length = now / dot(direction, image);
        add(solution, length, direction);
        add(residual, -length, image);
        smooth = over(residual, diagonal_);
        const double next = dot(residual, smooth), share = next / now;
        now = next;
        Slopes turned = smooth;
        add(turned, share, direction);
        direction = std::move(turned);
    }
    return solution;
}

// Corrects the ends, from mirrored to natural; the amplitudes are already multiplied by the transmission.
void WholeSpline::free_ends(Grid<double>& amplitudes) const {
    for (int l = 0; l < rows_; ++l)
        for (int k = 0; k < columns_; ++k)
            amplitudes(k, l) *= norm(k, columns_) * norm(l, rows_);
    Slopes right = slopes_of(amplitudes);
    for (const std::size_t parity : {0u, 1u}) {
        for (double& value : right.at_x[parity])
            value *= missing_x_;
        for (double& value : right.at_y[parity])
            value *= missing_y_;
    }
    const Slopes slopes = solved(right);
    for (int l = 0; l < rows_; ++l)
        for (int k = 0; k < columns_; ++k) {
            const auto i = static_cast<std::size_t>(k), j = static_cast<std::size_t>(l);
            const double bent =
                missing_x_ * end_x_[i] * slopes.at_x[i % 2][j] + missing_y_ * end_y_[j] * slopes.at_y[j % 2][i];
            amplitudes(k, l) = (amplitudes(k, l) + transmission_(k, l) * bent) / (norm(k, columns_) * norm(l, rows_));
        }
}

std::vector<double> WholeSpline::low_pass(std::vector<double> heights) const {
    Grid<double> grid;
    grid.columns = columns_;
    grid.rows = rows_;
    grid.values = std::move(heights);
    // With natural ends a plane passes unchanged, so it is removed first and does not enter the rounding.
    HeightMap map{.height = std::move(grid), .pitch_x = 1, .pitch_y = 1};
    Plane plane;
    if (ends_ == SplineEnds::natural) {
        plane = least_squares_plane(map);
        map = remove_plane(std::move(map), plane);
    }
    Grid<double>& rest = map.height;
    cosine_transform(rest);
    for (std::size_t k = 0; k < rest.values.size(); ++k)
        rest.values[k] *= transmission_.values[k];
    if (ends_ == SplineEnds::natural)
        free_ends(rest);
    inverse_cosine_transform(rest);
    if (ends_ == SplineEnds::natural) {
        plane.offset = -plane.offset;
        plane.slope_x = -plane.slope_x;
        plane.slope_y = -plane.slope_y;
        map = remove_plane(std::move(map), plane);
    }
    return std::move(map.height.values);
}

} // namespace vkfv::surface
