#include "topography/lateral_shift.hpp"

#include "core/mathematics/fourier.hpp"
#include "surface/height_parameters.hpp"
#include "surface/resample.hpp"
#include "topography/compare.hpp"

#include <Eigen/Eigenvalues>
#include <glm/glm.hpp>

#include <algorithm>
#include <array>
#include <cmath>
#include <complex>
#include <functional>
#include <limits>
#include <utility>
#include <vector>

namespace vkfv::topography {
namespace {

using surface::HeightMap;
using Complex = std::complex<double>;
// With sizes known when compiled, the few lines below would take ten seconds to compile.
using Eigen::MatrixXd;
using Eigen::VectorXd;

constexpr double undefined = std::numeric_limits<double>::quiet_NaN();

// Twice the logarithm of the likelihood ratio of correlated to uncorrelated surfaces with normal heights, for so many
// points. It balances a slightly better match against fewer points.
double evidence(double points, double correlation) {
    constexpr double least = 1e-3; // least unexplained share of the variance; interpolation alone leaves as much
    return correlation > 0 ? -points * std::log(std::max(1 - correlation * correlation, least)) : 0;
}

struct Starts {
    std::vector<LateralShift> shifts;   // whole pitches, the best first
    double significant_correlation = 1; // the best of unrelated surfaces hardly ever reaches it
};

// The farthest lags searched, in points to either side.
struct Reach {
    int x = 0;
    int y = 0;
};

// Sums over pairs of points by lag, for measured heights a and true ones b in units of their Sq: of presence and of a
// b; of a and of b where the other is present; of their squares there.
struct Correlations {
    Grid<Complex> first, second, third;
    double points = 0;                                  // at lag zero
    double powers_a = 0, powers_b = 0, powers_both = 0; // sums over frequencies
};

// Replaces the transforms of (presence and a), (b and a^2), (b^2) by those of the sums.
void correlate(Correlations& of) {
    for (int row = 0; row < of.first.rows; ++row)
        for (int column = 0; column < of.first.columns; ++column) {
            const int opposite_column = column == 0 ? 0 : of.first.columns - column;
            const int opposite_row = row == 0 ? 0 : of.first.rows - row;
            const std::size_t here = of.first.index(column, row), there = of.first.index(opposite_column, opposite_row);
            if (there < here)
                continue;
            // The transform of a + i b with real a and b is A + i B; at the opposite frequency it is conj(A) + i
            // conj(B).
            const auto parts = [&](const Grid<Complex>& grid) {
                const Complex value = grid.values[here], other = std::conj(grid.values[there]);
                return std::pair((value + other) / 2.0, (value - other) / Complex(0, 2));
            };
            const auto join = [&](Grid<Complex>& grid, Complex real, Complex imaginary) {
                const Complex i(0, 1);
                grid.values[there] = std::conj(real) + i * std::conj(imaginary);
                grid.values[here] = real + i * imaginary;
            };
            const auto [present, a] = parts(of.first);
            const auto [b, a_squared] = parts(of.second);
            const Complex b_squared = parts(of.third).first;
            join(of.first, present * std::conj(present), a * std::conj(b));
            join(of.second, a * std::conj(present), present * std::conj(b));
            join(of.third, a_squared * std::conj(present), present * std::conj(b_squared));
            const double times = here == there ? 1 : 2;
            of.powers_a += times * std::norm(a);
            of.powers_b += times * std::norm(b);
            of.powers_both += times * std::norm(a) * std::norm(b);
        }
}

// The sums by Fourier transform, after D. Padfield, "Masked object registration in the Fourier domain", 2012.
Correlations correlations(const LevelledPair& pair, double sq_measured, double sq_true, const Reach& reach) {
    const int columns = pair.measured.columns(), rows = pair.measured.rows();
    // Zeros as wide as the reach keep the ends apart. Two real grids go through one transform: presence and a; b and
    // a^2; b^2.
    Correlations of;
    of.first = of.second = of.third =
        Grid<Complex>(convenient_length(columns + reach.x + 1), convenient_length(rows + reach.y + 1));
    for (int row = 0; row < rows; ++row)
        for (int column = 0; column < columns; ++column)
            if (const double z = pair.measured.height(column, row); std::isfinite(z)) {
                const double a = z / sq_measured, b = pair.truth.height(column, row) / sq_true;
                of.first(column, row) = {1, a};
                of.second(column, row) = {b, a * a};
                of.third(column, row) = {b * b, 0};
                of.points += 1;
            }
    for (Grid<Complex>* grid : {&of.first, &of.second, &of.third})
        fourier_transform(*grid);
    correlate(of);
    for (Grid<Complex>* grid : {&of.first, &of.second, &of.third})
        inverse_fourier_transform(*grid);
    return of;
}

// The evidence of Pearson's correlation over the overlapping points at every lag; 0 for lags with too few points.
Grid<double> evidence_by_lag(const Correlations& of, const Reach& reach) {
    constexpr double least_overlap = 0.25; // share of the points at lag zero
    Grid<double> evidences(2 * reach.x + 1, 2 * reach.y + 1);
    for (int j = -reach.y; j <= reach.y; ++j)
        for (int i = -reach.x; i <= reach.x; ++i) {
            const std::size_t lag = of.first.index(i < 0 ? i + of.first.columns : i, j < 0 ? j + of.first.rows : j);
            const double n = std::round(of.first.values[lag].real());
            if (!(n >= least_overlap * of.points))
                continue;
            const double mean_a = of.second.values[lag].real() / n, mean_b = of.second.values[lag].imag() / n;
            const double variance_a = of.third.values[lag].real() / n - mean_a * mean_a;
            const double variance_b = of.third.values[lag].imag() / n - mean_b * mean_b;
            // Variances are 1 at lag zero; smaller ones than these are rounding.
            if (variance_a > 1e-9 && variance_b > 1e-9)
                evidences(i + reach.x, j + reach.y) = evidence(n, (of.first.values[lag].imag() / n - mean_a * mean_b) /
                                                                      std::sqrt(variance_a * variance_b));
        }
    return evidences;
}

// The lags of the highest peaks of evidence, the best first.
std::vector<LateralShift> shifts_of_peaks(const Grid<double>& evidences, const Reach& reach, double pitch_x,
                                          double pitch_y) {
    constexpr std::size_t most = 3;
    constexpr double worth_a_try = 0.5; // share of the best evidence
    struct Peak {
        double evidence;
        LateralShift shift;
    };
    std::vector<Peak> peaks;
    for (int row = 0; row < evidences.rows; ++row)
        for (int column = 0; column < evidences.columns; ++column) {
            const double here = evidences(column, row);
            bool highest = here > 0;
            for (int j = std::max(row - 1, 0); j <= std::min(row + 1, evidences.rows - 1); ++j)
                for (int i = std::max(column - 1, 0); i <= std::min(column + 1, evidences.columns - 1); ++i)
                    highest = highest && evidences(i, j) <= here;
            if (highest)
                peaks.push_back({here, {.x = (column - reach.x) * pitch_x, .y = (row - reach.y) * pitch_y}});
        }
    std::ranges::stable_sort(peaks, std::greater{}, &Peak::evidence);
    std::vector<LateralShift> shifts;
    for (const Peak& peak : peaks)
        if (shifts.size() < most && peak.evidence >= worth_a_try * peaks.front().evidence)
            shifts.push_back(peak.shift);
    return shifts;
}

// The correlation of unrelated surfaces has the variance 1 / n, where n is the number of independent points: all points
// over the summed product of both autocorrelations (M. S. Bartlett 1935), which by Parseval's theorem is a sum over
// frequencies. The largest of m independent lags exceeds sqrt(2 ln m) standard deviations of Fisher's z by little.
double significant_correlation(const Correlations& of, std::size_t looked_at) {
    const double patch = of.powers_both / (of.powers_a * of.powers_b) * static_cast<double>(of.first.values.size());
    const double independent = of.points / patch;
    const double lags = std::max(1.0, static_cast<double>(looked_at) / patch);
    return std::tanh((3 + std::sqrt(2 * std::log(lags))) / std::sqrt(independent));
}

Starts starting_shifts(const LevelledPair& pair) {
    const double sq_measured = surface::height_parameters(pair.measured).sq;
    const double sq_true = surface::height_parameters(pair.truth).sq;
    if (!(sq_measured > 0 && sq_true > 0))
        return {};
    const Reach reach{pair.measured.columns() / 4, pair.measured.rows() / 4};
    const Correlations of = correlations(pair, sq_measured, sq_true, reach);
    const Grid<double> evidences = evidence_by_lag(of, reach);
    return {.shifts = shifts_of_peaks(evidences, reach, pair.measured.pitch_x, pair.measured.pitch_y),
            .significant_correlation = significant_correlation(of, evidences.values.size())};
}

// The pseudo-inverse of a symmetric matrix without the directions in which the matrix is at most `least`.
struct PseudoInverse {
    MatrixXd inverse;
    MatrixXd known; // the projector on the other directions
};

PseudoInverse pseudo_inverse(const MatrixXd& matrix, double least) {
    const Eigen::SelfAdjointEigenSolver<MatrixXd> directions(matrix);
    PseudoInverse result{.inverse = MatrixXd::Zero(matrix.rows(), matrix.rows()), .known = {}};
    result.known = result.inverse;
    for (int k = 0; k < matrix.rows(); ++k) {
        if (const double curvature = directions.eigenvalues()[k]; curvature > least) {
            const MatrixXd along = directions.eigenvectors().col(k) * directions.eigenvectors().col(k).transpose();
            result.inverse += along / curvature;
            result.known += along;
        }
    }
    return result;
}

// Normal equations: sums of products of the residual's derivatives by shift in x and y, offset, tilt in x and y; and of
// these with the residual.
struct NormalEquations {
    MatrixXd matrix = MatrixXd::Zero(5, 5);
    VectorXd right = VectorXd::Zero(5);
};

NormalEquations normal_equations(const HeightMap& measured, const HeightMap& truth) {
    const double x_middle = measured.x(measured.columns() / 2), y_middle = measured.y(measured.rows() / 2);
    const int border_x = measured.columns() > 2 ? 1 : 0, border_y = measured.rows() > 2 ? 1 : 0;
    std::array<std::array<double, 6>, 5> sums{};
    for (int row = border_y; row + border_y < measured.rows(); ++row)
        for (int column = border_x; column + border_x < measured.columns(); ++column) {
            const double residual = measured.height(column, row) - truth.height(column, row);
            // The slope is zero along an axis of fewer than three points.
            const double slope_x =
                (truth.height(column + border_x, row) - truth.height(column - border_x, row)) / (2 * measured.pitch_x);
            const double slope_y =
                (truth.height(column, row + border_y) - truth.height(column, row - border_y)) / (2 * measured.pitch_y);
            if (!std::isfinite(residual + slope_x + slope_y))
                continue;
            const std::array<double, 6> terms{
                -slope_x, -slope_y, 1, measured.x(column) - x_middle, measured.y(row) - y_middle, residual};
            for (std::size_t i = 0; i < sums.size(); ++i)
                for (std::size_t j = 0; j < terms.size(); ++j)
                    sums[i][j] += terms[i] * terms[j];
        }
    NormalEquations equations;
    for (int i = 0; i < 5; ++i) {
        for (int j = 0; j < 5; ++j)
            equations.matrix(i, j) = sums[static_cast<std::size_t>(i)][static_cast<std::size_t>(j)];
        equations.right[i] = sums[static_cast<std::size_t>(i)][5];
    }
    return equations;
}

struct Step {
    glm::dvec2 shift;
    glm::dmat2 known; // projector on the directions in which the slopes determine a shift
};

// The step of the shift that makes the linearised sum of squares least.
Step gauss_newton_step(const HeightMap& measured, const HeightMap& truth) {
    // The least variation along a direction, without offset and tilt, over the mean square slope: interpolation causes
    // less.
    constexpr double telling = 1e-5;
    constexpr double rounding = 1e-12;
    const auto [matrix, right] = normal_equations(measured, truth);
    // Unknowns of unlike magnitude are scaled to one.
    MatrixXd scale = MatrixXd::Zero(3, 3);
    for (int k = 0; k < 3; ++k)
        scale(k, k) = matrix(k + 2, k + 2) > 0 ? 1 / std::sqrt(matrix(k + 2, k + 2)) : 0;
    const MatrixXd plane = scale * matrix.bottomRightCorner(3, 3) * scale;
    // Offset and tilt are eliminated first: a slope that they explain determines no shift.
    const MatrixXd explained =
        matrix.topRightCorner(2, 3) * scale * pseudo_inverse(plane, 3 * rounding).inverse * scale;
    const MatrixXd slopes = matrix.topLeftCorner(2, 2);
    const auto [inverse, known] =
        pseudo_inverse(slopes - explained * matrix.bottomLeftCorner(3, 2), telling * slopes.trace());
    const VectorXd shift = inverse * (right.head(2) - explained * right.tail(3));
    return {.shift = {shift[0], shift[1]}, .known = {known(0, 0), known(1, 0), known(0, 1), known(1, 1)}};
}

// The shift refined from `start`; NaN where the iteration finds no minimum within the searched range.
LateralShift refined_shift(const HeightMap& measured, const HeightMap& truth, const LateralShift& start) {
    constexpr int most_iterations = 50;
    constexpr double settled = 1e-4; // pitches
    constexpr double beyond = 2;     // pitches over the reach of the search
    const LateralShift none{undefined, undefined, undefined};
    const glm::dvec2 pitch(measured.pitch_x, measured.pitch_y);
    const glm::dvec2 reach = glm::dvec2(measured.columns() / 4, measured.rows() / 4) + beyond;
    glm::dvec2 place(start.x, start.y), share(1), before(0);
    for (int iteration = 0; iteration < most_iterations; ++iteration) {
        const Step step = gauss_newton_step(measured, shifted_onto(truth, measured, {.x = place.x, .y = place.y}));
        if (step.known == glm::dmat2(0))
            return none;
        if (iteration == 0)
            place = step.known * place;
        // The points present change with the shift, at the border even with its sign: between two steps in opposite
        // directions, each for its own points, half the step is taken.
        for (int axis = 0; axis < 2; ++axis)
            if (step.shift[axis] * before[axis] < 0)
                share[axis] /= 2;
        const glm::dvec2 taken =
            share * step.shift *
            std::min(1.0, 1 / std::max(std::abs(step.shift.x) / pitch.x, std::abs(step.shift.y) / pitch.y));
        before = step.shift;
        place += taken;
        if (!glm::all(glm::lessThanEqual(glm::abs(place) / pitch, reach)))
            return none;
        if (glm::all(glm::lessThan(glm::abs(taken) / pitch, glm::dvec2(settled)))) {
            LateralShift shift{.x = place.x, .y = place.y};
            shift.correlation = compare(measured, shifted_onto(truth, measured, shift)).correlation;
            return shift;
        }
    }
    return none;
}

} // namespace

HeightMap shifted_onto(const HeightMap& truth, const HeightMap& measured, const LateralShift& shift) {
    HeightMap moved = truth;
    moved.x0 += shift.x;
    moved.y0 += shift.y;
    return surface::resampled(moved, measured);
}

LateralShift lateral_shift(const HeightMap& measured, const HeightMap& truth) {
    const LevelledPair pair = levelled_pair(measured, surface::resampled(truth, measured));
    const Starts starts = starting_shifts(pair);
    LateralShift best{undefined, undefined, undefined};
    double most = 0;
    for (const LateralShift& start : starts.shifts) {
        const LateralShift shift = refined_shift(measured, truth, start);
        if (!(shift.correlation >= starts.significant_correlation))
            continue;
        const double overlap = (1 - std::abs(shift.x) / (measured.columns() * measured.pitch_x)) *
                               (1 - std::abs(shift.y) / (measured.rows() * measured.pitch_y));
        if (const double here = evidence(overlap, shift.correlation); here > most) {
            most = here;
            best = shift;
        }
    }
    return best;
}

} // namespace vkfv::topography
