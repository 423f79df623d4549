#include "surface/spatial_parameters.hpp"

#include "core/mathematics/fourier.hpp"
#include "core/mathematics/units.hpp"
#include "core/threads/parallel_list.hpp"
#include "surface/height_parameters.hpp"

#include <algorithm>
#include <cmath>
#include <complex>
#include <cstdlib>
#include <future>
#include <vector>

namespace vkfv::surface {
namespace {

using Complex = std::complex<double>;

// Interpolates a function of a transform's values at fractional indices, which may be negative: transforms are periodic
// in the grid's size.
template <class Function>
double bilinear(const Grid<Complex>& grid, double x, double y, const Function& value) {
    const double column = std::floor(x), row = std::floor(y);
    const double u = x - column, v = y - row;
    const auto at = [&](int i, int k) {
        return value(grid((i % grid.columns + grid.columns) % grid.columns, (k % grid.rows + grid.rows) % grid.rows));
    };
    const int i = static_cast<int>(column), k = static_cast<int>(row);
    return (1 - v) * ((1 - u) * at(i, k) + u * at(i + 1, k)) + v * ((1 - u) * at(i, k + 1) + u * at(i + 1, k + 1));
}

// The sums of products at each lag (real part) and the numbers of pairs (imaginary part), by the Wiener-Khinchin
// theorem for both at once. Heights are in units of Sq, because rounding is relative to the larger part, and squares of
// nanometres in mm would vanish beside the pairs.
Grid<Complex> sums_and_pairs(const HeightMap& map, const HeightParameters& parameters) {
    // Zero padding as wide as the greatest lag prevents wrapping.
    Grid<Complex> grid(convenient_length(map.columns() + map.columns() / 2 + 1),
                       convenient_length(map.rows() + map.rows() / 2 + 1));
    for (int row = 0; row < map.rows(); ++row)
        for (int column = 0; column < map.columns(); ++column)
            if (const double z = map.height(column, row); std::isfinite(z))
                grid(column, row) = {(z - parameters.mean) / parameters.sq, 1};
    fourier_transform(grid);
    // The transform of a + i b with real a and b is A + i B, and at the opposite frequency conj(A) + i conj(B).
    for (int row = 0; row < grid.rows; ++row)
        for (int column = 0; column < grid.columns; ++column) {
            const int opposite_column = column == 0 ? 0 : grid.columns - column;
            const int opposite_row = row == 0 ? 0 : grid.rows - row;
            if (grid.index(opposite_column, opposite_row) < grid.index(column, row))
                continue;
            const Complex here = grid(column, row), there = std::conj(grid(opposite_column, opposite_row));
            const Complex power{std::norm((here + there) / 2.0), std::norm((here - there) / 2.0)};
            grid(column, row) = grid(opposite_column, opposite_row) = power;
        }
    inverse_fourier_transform(grid);
    return grid;
}

struct Falls {
    double shortest = undefined;
    double longest = undefined; // NaN unless all directions have a fall
};

Falls falls_of_autocorrelation(const HeightMap& map, const HeightParameters& parameters) {
    constexpr double s = 0.2;
    const Grid<Complex> sums = sums_and_pairs(map, parameters);
    const auto normalised = [&](Complex sum_and_pairs) {
        // Numbers of pairs are whole except for the transform's rounding.
        return sum_and_pairs.imag() > 0.5 ? sum_and_pairs.real() / sum_and_pairs.imag() : 1;
    };
    const int columns = map.columns() / 2, rows = map.rows() / 2;
    constexpr double rounding = 1e-9; // tolerance for lags along an axis, whose other component is rarely exactly zero
    // Neighbouring directions differ by a point at the greatest lag; opposite lags are equivalent.
    const int directions = 4 * std::max({columns, rows, 1});
    const auto found = parallel_list(directions, [&](int direction) {
        const double angle = pi * direction / directions;
        const double step_x = 0.5 * std::cos(angle), step_y = 0.5 * std::sin(angle);
        double before = 1;
        for (int k = 1; std::abs(k * step_x) <= columns + rounding && std::abs(k * step_y) <= rows + rounding; ++k) {
            const double here = bilinear(sums, k * step_x, k * step_y, normalised);
            if (here < s) {
                const double steps = k - 1 + (before - s) / (before - here);
                return steps * std::hypot(step_x * map.pitch_x, step_y * map.pitch_y);
            }
            before = here;
        }
        return undefined;
    });
    Falls falls;
    bool every = true;
    for (const double fall : found) {
        every = every && !std::isnan(fall);
        falls.shortest = std::fmin(falls.shortest, fall);
        falls.longest = std::fmax(falls.longest, fall);
    }
    if (!every)
        falls.longest = undefined;
    return falls;
}

double hann(int k, int n) {
    const double wave = std::sin(pi * (k + 0.5) / n);
    return wave * wave;
}

double texture_direction(const HeightMap& map, double mean) {
    Grid<Complex> spectrum(convenient_length(map.columns()), convenient_length(map.rows()));
    for (int row = 0; row < map.rows(); ++row)
        for (int column = 0; column < map.columns(); ++column)
            if (const double z = map.height(column, row); std::isfinite(z))
                spectrum(column, row) = (z - mean) * hann(column, map.columns()) * hann(row, map.rows());
    fourier_transform(spectrum);

    const double extent_x = spectrum.columns * map.pitch_x, extent_y = spectrum.rows * map.pitch_y;
    const double lowest = 2 / std::min(map.columns() * map.pitch_x, map.rows() * map.pitch_y);
    const double highest = 0.5 / std::max(map.pitch_x, map.pitch_y);
    const double step = 0.5 / std::max(extent_x, extent_y); // half the finer spacing of frequencies
    const int directions = static_cast<int>(std::ceil(2 * pi * highest / (2 * step)));
    if (!(highest > lowest))
        return undefined;
    const auto power = parallel_list(directions, [&](int direction) {
        const double angle = pi * direction / directions;
        const double cosine = std::cos(angle), sine = std::sin(angle);
        double sum = 0;
        for (double frequency = lowest; frequency <= highest; frequency += step)
            sum += frequency * bilinear(spectrum, frequency * cosine * extent_x, frequency * sine * extent_y,
                                        [](Complex value) { return std::norm(value); });
        return sum;
    });
    const auto greatest = std::max_element(power.begin(), power.end());
    // The direction of the waves, 0 to pi.
    const double angle = pi * static_cast<double>(greatest - power.begin()) / directions;
    return angle > 0 ? angle - pi / 2 : pi / 2;
}

} // namespace

SpatialParameters spatial_parameters(const HeightMap& map) {
    // The range decides whether the height is constant, as the mean's rounding keeps Sq above zero.
    double lowest = undefined, highest = undefined;
    for (const double z : map.height.values) {
        lowest = std::fmin(lowest, z);
        highest = std::fmax(highest, z);
    }
    if (!(highest > lowest))
        return {undefined, undefined, undefined};
    const HeightParameters parameters = height_parameters(map);
    auto direction = std::async(std::launch::async, [&] { return texture_direction(map, parameters.mean); });
    const Falls falls = falls_of_autocorrelation(map, parameters);
    return {falls.shortest, falls.shortest / falls.longest, direction.get()};
}

} // namespace vkfv::surface
