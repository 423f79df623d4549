#include "topography/lateral_shift.hpp"

#include "core/fourier.hpp"
#include "surface/resample.hpp"
#include "topography/compare.hpp"

#include <Eigen/Dense>

#include <algorithm>
#include <cmath>
#include <complex>
#include <limits>

namespace vkfv::topography {
namespace {

using surface::HeightMap;
using Complex = std::complex<double>;
using Vector = Eigen::Matrix<double, 5, 1>;
using Matrix = Eigen::Matrix<double, 5, 5>;

constexpr double undefined = std::numeric_limits<double>::quiet_NaN();

// To whole pitches, by the highest cross-correlation.
LateralShift nearest_shift(const LevelledPair& pair) {
    const int columns = pair.measured.columns(), rows = pair.measured.rows();
    const int reach_x = columns / 4, reach_y = rows / 4;
    // Zeros as wide as the reach keep the ends apart.
    Grid<Complex> grid(convenient_length(columns + reach_x + 1), convenient_length(rows + reach_y + 1));
    for (int row = 0; row < rows; ++row)
        for (int column = 0; column < columns; ++column)
            if (const double z = pair.measured.height(column, row); std::isfinite(z))
                grid(column, row) = {z, pair.truth.height(column, row)};
    fourier_transform(grid);
    // The transform of a + i b, a and b real, is A + i B; at the opposite frequency conj(A) + i conj(B).
    for (int row = 0; row < grid.rows; ++row)
        for (int column = 0; column < grid.columns; ++column) {
            const int opposite_column = column == 0 ? 0 : grid.columns - column;
            const int opposite_row = row == 0 ? 0 : grid.rows - row;
            if (grid.index(opposite_column, opposite_row) < grid.index(column, row))
                continue;
            const Complex here = grid(column, row), there = std::conj(grid(opposite_column, opposite_row));
            const Complex measured = (here + there) / 2.0, truth = (here - there) / Complex(0, 2);
            grid(column, row) = measured * std::conj(truth);
            grid(opposite_column, opposite_row) = std::conj(grid(column, row));
        }
    inverse_fourier_transform(grid);
    LateralShift best{.x = undefined, .y = undefined};
    double highest = 0;
    for (int j = -reach_y; j <= reach_y; ++j)
        for (int i = -reach_x; i <= reach_x; ++i)
            if (const double value = grid(i < 0 ? i + grid.columns : i, j < 0 ? j + grid.rows : j).real();
                value > highest) {
                highest = value;
                best = {.x = i * pair.measured.pitch_x, .y = j * pair.measured.pitch_y};
            }
    return best;
}

// The step of the shift that makes the linearised sum of squares least.
Eigen::Vector2d gauss_newton_step(const HeightMap& measured, const HeightMap& truth) {
    const double x_middle = measured.x(measured.columns() / 2), y_middle = measured.y(measured.rows() / 2);
    Matrix matrix = Matrix::Zero();
    Vector right = Vector::Zero();
    for (int row = 1; row + 1 < measured.rows(); ++row)
        for (int column = 1; column + 1 < measured.columns(); ++column) {
            const double residual = measured.height(column, row) - truth.height(column, row);
            const double slope_x =
                (truth.height(column + 1, row) - truth.height(column - 1, row)) / (2 * measured.pitch_x);
            const double slope_y =
                (truth.height(column, row + 1) - truth.height(column, row - 1)) / (2 * measured.pitch_y);
            if (!std::isfinite(residual + slope_x + slope_y))
                continue;
            Vector terms;
            terms << -slope_x, -slope_y, 1, measured.x(column) - x_middle, measured.y(row) - y_middle;
            matrix += terms * terms.transpose();
            right += residual * terms;
        }
    // Unknowns of unlike magnitude are brought to one; both shifts by the same factor, so that a direction without
    // slopes is seen as such and left at zero.
    Vector scale = matrix.diagonal().cwiseSqrt();
    scale[0] = scale[1] = std::max(scale[0], scale[1]);
    scale = scale.unaryExpr([](double value) { return value > 0 ? 1 / value : 0; });
    Eigen::CompleteOrthogonalDecomposition<Matrix> decomposition;
    decomposition.setThreshold(1e-8);
    decomposition.compute(scale.asDiagonal() * matrix * scale.asDiagonal());
    const Vector step = scale.asDiagonal() * decomposition.solve(Vector(scale.asDiagonal() * right));
    return {step[0], step[1]};
}

} // namespace

HeightMap shifted_onto(const HeightMap& truth, const HeightMap& measured, const LateralShift& shift) {
    HeightMap moved = truth;
    moved.x0 += shift.x;
    moved.y0 += shift.y;
    return surface::resampled(moved, measured);
}

LateralShift lateral_shift(const HeightMap& measured, const HeightMap& truth) {
    constexpr int most_iterations = 50;
    constexpr double settled = 1e-4; // pitches
    constexpr double basin = 2;      // pitches: farther from the start lies another peak
    const LateralShift none{undefined, undefined, undefined};
    const LateralShift start = nearest_shift(levelled_pair(measured, surface::resampled(truth, measured)));
    if (!std::isfinite(start.x))
        return none;
    LateralShift shift = start;
    for (int iteration = 0; iteration < most_iterations; ++iteration) {
        const HeightMap moved = shifted_onto(truth, measured, shift);
        const Eigen::Vector2d step = gauss_newton_step(measured, moved);
        const double pitches = std::max(std::abs(step.x()) / measured.pitch_x, std::abs(step.y()) / measured.pitch_y);
        const double share = std::min(1.0, 1 / pitches); // a pitch at most
        shift.x += share * step.x();
        shift.y += share * step.y();
        if (!(std::abs(shift.x - start.x) <= basin * measured.pitch_x &&
              std::abs(shift.y - start.y) <= basin * measured.pitch_y))
            return none;
        if (pitches < settled) {
            shift.correlation = compare(measured, shifted_onto(truth, measured, shift)).correlation;
            return shift;
        }
    }
    return none;
}

} // namespace vkfv::topography
