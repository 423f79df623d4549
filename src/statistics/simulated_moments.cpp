#include "statistics/simulated_moments.hpp"

#include <boost/math/distributions/students_t.hpp>

#include <Eigen/Dense>

#include <algorithm>
#include <cmath>
#include <limits>
#include <stdexcept>
#include <utility>

namespace vkfv::statistics {

namespace {
namespace of_simulated_moments { // files of a unity build share the unnamed namespace

using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::VectorXd;

// Runs of some seeds, a row a seed, of standardised statistics.
struct Scaled {
    MatrixXd components{}; // principal components of the pilot, the largest first: a column each
    MatrixXd centre{};
    std::vector<MatrixXd> above{}, below{}; // of the parameters
};

// The linear estimate of the parameters from standardised statistics: change = weights * (measured - mean).
struct Estimate {
    VectorXd mean{};
    MatrixXd slopes{};   // statistics x parameters
    MatrixXd basis{};    // statistics x directions
    MatrixXd scatter{};  // covariance in these directions
    MatrixXd weights{};  // parameters x statistics
    bool solved = false; // false: the slopes do not tell the parameters apart
};

struct Scatter {
    double mean = 0, deviation = 0;
};

// Mean and standard deviation of a statistic over runs.
Scatter scatter_of(const std::vector<std::vector<double>>& runs, std::size_t statistic) {
    double mean = 0, square = 0;
    const auto count = static_cast<double>(runs.size());
    for (const auto& run : runs) {
        mean += run[statistic] / count;
    }
    for (const auto& run : runs) {
        square += (run[statistic] - mean) * (run[statistic] - mean) / (count - 1);
    }
    return {.mean = mean, .deviation = std::sqrt(square)};
}

MatrixXd matrix_of(const std::vector<std::vector<double>>& rows, const std::vector<Index>& kept,
                   const VectorXd& deviation) {
    MatrixXd matrix(static_cast<Index>(rows.size()), static_cast<Index>(kept.size()));
    for (Index row = 0; row < matrix.rows(); ++row) {
        for (Index k = 0; k < matrix.cols(); ++k) {
            matrix(row, k) =
                rows[static_cast<std::size_t>(row)][static_cast<std::size_t>(kept[static_cast<std::size_t>(k)])] /
                deviation[k];
        }
    }
    return matrix;
}

Matrix plain(const MatrixXd& matrix) {
    Matrix result(static_cast<std::size_t>(matrix.rows()), static_cast<std::size_t>(matrix.cols()));
    for (std::size_t row = 0; row < result.rows; ++row) {
        for (std::size_t column = 0; column < result.columns; ++column) {
            result(row, column) = matrix(static_cast<Index>(row), static_cast<Index>(column));
        }
    }
    return result;
}

MatrixXd covariance_of(const MatrixXd& rows) {
    const MatrixXd about = rows.rowwise() - rows.colwise().mean();
    return about.transpose() * about / static_cast<double>(rows.rows() - 1);
}

// The rows of these seeds.
MatrixXd rows_of(const MatrixXd& matrix, const std::vector<Index>& seeds) {
    MatrixXd result(static_cast<Index>(seeds.size()), matrix.cols());
    for (Index row = 0; row < result.rows(); ++row) {
        result.row(row) = matrix.row(seeds[static_cast<std::size_t>(row)]);
    }
    return result;
}

MatrixXd slopes_of(const Scaled& scaled, const std::vector<double>& steps, const std::vector<Index>& seeds) {
    MatrixXd slopes(scaled.centre.cols(), static_cast<Index>(steps.size()));
    for (Index k = 0; k < slopes.cols(); ++k) {
        const auto parameter = static_cast<std::size_t>(k);
        const MatrixXd difference = rows_of(scaled.above[parameter], seeds) - rows_of(scaled.below[parameter], seeds);
        slopes.col(k) = difference.colwise().mean().transpose() / (2 * steps[parameter]);
    }
    return slopes;
}

// The principal components of rows about their mean, the largest first. There are fewer rows than columns mostly, so
// they come from the rows' products with each other.
MatrixXd principal_components(const MatrixXd& rows) {
    const MatrixXd about = rows.rowwise() - rows.colwise().mean();
    const Eigen::SelfAdjointEigenSolver<MatrixXd> solver(about * about.transpose()); // ascending
    const Index count = std::min(rows.rows() - 1, rows.cols());
    MatrixXd components(rows.cols(), count);
    Index filled = 0;
    for (Index k = rows.rows() - 1; filled < count && solver.eigenvalues()[k] > 0; --k) {
        components.col(filled++) =
            about.transpose() * solver.eigenvectors().col(k) / std::sqrt(solver.eigenvalues()[k]);
    }
    return components.leftCols(filled);
}

// Orthonormal directions: those of the slopes, then principal components. There are at most a third as many as seeds,
// so that the covariance along them is well known.
MatrixXd directions(const MatrixXd& slopes, const MatrixXd& components, Index seeds) {
    const Index count = std::min(slopes.rows(), std::max(slopes.cols() + 1, seeds / 3));
    MatrixXd all(slopes.rows(), count);
    Index filled = 0;
    for (Index k = 0; k < slopes.cols() && filled < count; ++k) {
        const double norm = slopes.col(k).norm();
        if (norm > 0) {
            all.col(filled++) = slopes.col(k) / norm;
        }
    }
    for (Index k = 0; k < components.cols() && filled < count; ++k) {
        all.col(filled++) = components.col(k);
    }
    const Eigen::HouseholderQR<MatrixXd> orthogonal(all.leftCols(filled));
    return orthogonal.householderQ() * MatrixXd::Identity(slopes.rows(), filled);
}

// determined: the parameters that are estimated; the weights of others are 0.
Estimate estimate_by(const Scaled& scaled, const std::vector<double>& steps, const std::vector<Index>& seeds,
                     const std::vector<bool>& determined) {
    Estimate estimate;
    const MatrixXd centre = rows_of(scaled.centre, seeds);
    estimate.mean = centre.colwise().mean().transpose();
    estimate.slopes = slopes_of(scaled, steps, seeds);
    const MatrixXd about = centre.rowwise() - estimate.mean.transpose();
    std::vector<Index> used;
    used.reserve(steps.size());
    for (Index k = 0; k < estimate.slopes.cols(); ++k) {
        if (determined[static_cast<std::size_t>(k)]) {
            used.push_back(k);
        }
    }
    MatrixXd slopes(estimate.slopes.rows(), static_cast<Index>(used.size()));
    for (Index k = 0; k < slopes.cols(); ++k) {
        slopes.col(k) = estimate.slopes.col(used[static_cast<std::size_t>(k)]);
    }
    estimate.basis = directions(slopes, scaled.components, centre.rows());
    estimate.scatter = covariance_of(about * estimate.basis);
    estimate.weights = MatrixXd::Zero(estimate.slopes.cols(), estimate.slopes.rows());
    if (used.empty()) { // Eigen's decompositions take no empty matrix
        estimate.solved = true;
        return estimate;
    }
    const MatrixXd reduced = estimate.basis.transpose() * slopes;
    const Eigen::LDLT<MatrixXd> scatter(estimate.scatter);
    const MatrixXd weighted = scatter.solve(reduced); // C^-1 J
    const MatrixXd normal = reduced.transpose() * weighted;
    // With a diagonal of ones the least eigenvalue tells how alike the parameters' effects are, however much better one
    // of them is told than another. A matrix that is singular to rounding must not pass: one of its parameters would
    // get the variance 0.
    const VectorXd unit = normal.diagonal().cwiseSqrt().cwiseInverse();
    const MatrixXd alike = unit.asDiagonal() * normal * unit.asDiagonal();
    if (!alike.allFinite()) { // a parameter moves nothing
        return estimate;
    }
    constexpr double least_eigenvalue = 1e-10;
    const Eigen::SelfAdjointEigenSolver<MatrixXd> solver(alike); // ascending
    estimate.solved = solver.info() == Eigen::Success && solver.eigenvalues()[0] > least_eigenvalue;
    if (estimate.solved) {
        const MatrixXd inverse = solver.eigenvectors() * solver.eigenvalues().cwiseInverse().asDiagonal() *
                                 solver.eigenvectors().transpose();
        const MatrixXd weights =
            unit.asDiagonal() * inverse * unit.asDiagonal() * weighted.transpose() * estimate.basis.transpose();
        for (Index k = 0; k < slopes.cols(); ++k) {
            estimate.weights.row(used[static_cast<std::size_t>(k)]) = weights.row(k);
        }
    }
    return estimate;
}

std::vector<Index> seeds_but(Index count, Index left_out) {
    std::vector<Index> seeds;
    seeds.reserve(static_cast<std::size_t>(count));
    for (Index seed = 0; seed < count; ++seed) {
        if (seed != left_out) {
            seeds.push_back(seed);
        }
    }
    return seeds;
}

std::vector<Index> every_second(Index count, Index first) {
    std::vector<Index> seeds;
    seeds.reserve(static_cast<std::size_t>(count));
    for (Index seed = first; seed < count; seed += 2) {
        seeds.push_back(seed);
    }
    return seeds;
}

// Information about all parameters along the estimate's directions. Products are of slopes of two halves of the seeds.
// The inverse of a covariance by so few seeds is too large in the mean, by Hartlap's factor (Astronomy & Astrophysics
// 464 (2007) 399).
MatrixXd information_of(const Scaled& scaled, const Estimate& estimate, const std::vector<double>& steps) {
    const Index seeds = scaled.centre.rows(), parameters = estimate.slopes.cols(), used = estimate.basis.cols();
    const double unbiased = static_cast<double>(seeds - used - 2) / static_cast<double>(seeds - 1);
    const MatrixXd inverse = std::max(unbiased, 0.0) * estimate.scatter.ldlt().solve(MatrixXd::Identity(used, used));
    struct Half {
        MatrixXd slopes;
        std::vector<MatrixXd> scatters; // C^-1 dC_i
    };
    const auto half_of = [&](const std::vector<Index>& of) {
        Half half{.slopes = estimate.basis.transpose() * slopes_of(scaled, steps, of), .scatters = {}};
        half.scatters.reserve(steps.size());
        for (std::size_t k = 0; k < steps.size(); ++k) {
            const MatrixXd difference = covariance_of(rows_of(scaled.above[k], of) * estimate.basis) -
                                        covariance_of(rows_of(scaled.below[k], of) * estimate.basis);
            half.scatters.emplace_back(inverse * difference / (2 * steps[k]));
        }
        return half;
    };
    const Half first = half_of(every_second(seeds, 0)), second = half_of(every_second(seeds, 1));
    const MatrixXd of_mean = first.slopes.transpose() * inverse * second.slopes;
    MatrixXd information = 0.5 * (of_mean + of_mean.transpose());
    for (Index row = 0; row < parameters; ++row) {
        for (Index column = 0; column < parameters; ++column) {
            const auto a = static_cast<std::size_t>(row), b = static_cast<std::size_t>(column);
            information(row, column) += 0.25 * ((first.scatters[a] * second.scatters[b]).trace() +
                                                (second.scatters[a] * first.scatters[b]).trace());
        }
    }
    return information;
}

// The inverse over the parameters of the choice, zero elsewhere; empty if it is not positive there.
MatrixXd inverse_over(const MatrixXd& information, const std::vector<bool>& chosen) {
    std::vector<Index> used;
    used.reserve(chosen.size());
    for (Index k = 0; k < information.rows(); ++k) {
        if (chosen[static_cast<std::size_t>(k)]) {
            used.push_back(k);
        }
    }
    const auto count = static_cast<Index>(used.size());
    if (count == 0) {
        return {};
    }
    MatrixXd part(count, count);
    for (Index row = 0; row < count; ++row) {
        for (Index column = 0; column < count; ++column) {
            part(row, column) =
                information(used[static_cast<std::size_t>(row)], used[static_cast<std::size_t>(column)]);
        }
    }
    const Eigen::LLT<MatrixXd> root(part);
    if (root.info() != Eigen::Success) {
        return {};
    }
    const MatrixXd inverse = root.solve(MatrixXd::Identity(count, count));
    MatrixXd whole = MatrixXd::Zero(information.rows(), information.cols());
    for (Index row = 0; row < count; ++row) {
        for (Index column = 0; column < count; ++column) {
            whole(used[static_cast<std::size_t>(row)], used[static_cast<std::size_t>(column)]) = inverse(row, column);
        }
    }
    return whole;
}

// Mean square of what the estimate leaves of standardised statistics.
double left_by(const Estimate& estimate, const VectorXd& statistics) {
    const VectorXd about = statistics - estimate.mean;
    return (about - estimate.slopes * (estimate.weights * about)).squaredNorm() /
           static_cast<double>(statistics.size());
}

void require_shapes(const ModelRuns& runs, const std::vector<double>& measured) {
    const std::size_t parameters = runs.steps.size(), seeds = runs.centre.size();
    const auto fits = [&](const std::vector<std::vector<double>>& rows) {
        return rows.size() == seeds &&
               std::ranges::all_of(rows, [&](const auto& row) { return row.size() == measured.size(); });
    };
    const bool pilot_fits =
        runs.pilot.size() >= least_seeds(parameters) &&
        std::ranges::all_of(runs.pilot, [&](const auto& row) { return row.size() == measured.size(); });
    if (seeds < least_seeds(parameters) || !pilot_fits || runs.above.size() != parameters ||
        runs.below.size() != parameters || runs.widths.size() != parameters || !fits(runs.centre) ||
        !std::ranges::all_of(runs.above, fits) || !std::ranges::all_of(runs.below, fits)) {
        throw std::invalid_argument("fit_moments: runs of different shapes, or of too few seeds");
    }
}

} // namespace of_simulated_moments
} // namespace

MomentFit fit_moments(const ModelRuns& runs, const std::vector<double>& measured) {
    using namespace of_simulated_moments;
    require_shapes(runs, measured);
    const auto parameters = static_cast<Index>(runs.steps.size()), seeds = static_cast<Index>(runs.centre.size());
    MomentFit fit{.determined = std::vector<bool>(runs.steps.size(), true),
                  .alike = std::vector<bool>(runs.steps.size(), false)};
    // Statistics are measured in their standard deviations; one that never differs tells nothing by its scatter.
    std::vector<Index> kept;
    std::vector<double> deviations;
    kept.reserve(measured.size());
    deviations.reserve(measured.size());
    fit.deviation.reserve(measured.size());
    for (std::size_t k = 0; k < measured.size(); ++k) {
        const Scatter pilot = scatter_of(runs.pilot, k);
        fit.deviation.push_back(scatter_of(runs.centre, k).deviation);
        constexpr double rounding = 1e-12;
        if (pilot.deviation > rounding * (1 + std::abs(pilot.mean))) {
            kept.push_back(static_cast<Index>(k));
            deviations.push_back(pilot.deviation);
        }
    }
    if (kept.empty()) {
        throw std::domain_error("fit_moments: no statistic scatters from seed to seed");
    }
    const VectorXd scale = VectorXd::Map(deviations.data(), static_cast<Index>(deviations.size()));
    Scaled scaled{.components = principal_components(matrix_of(runs.pilot, kept, scale)),
                  .centre = matrix_of(runs.centre, kept, scale)};
    scaled.above.reserve(runs.steps.size());
    scaled.below.reserve(runs.steps.size());
    for (std::size_t k = 0; k < runs.steps.size(); ++k) {
        scaled.above.push_back(matrix_of(runs.above[k], kept, scale));
        scaled.below.push_back(matrix_of(runs.below[k], kept, scale));
    }
    const VectorXd observed = matrix_of({measured}, kept, scale).row(0).transpose();

    const std::vector<Index> all = seeds_but(seeds, -1);
    Estimate estimate = estimate_by(scaled, runs.steps, all, fit.determined);
    MatrixXd information = information_of(scaled, estimate, runs.steps);
    for (Index k = 0; k < parameters; ++k) {
        const double width = runs.widths[static_cast<std::size_t>(k)];
        const double own = information(k, k); // with all others known
        fit.determined[static_cast<std::size_t>(k)] = own > 0 && 1 / std::sqrt(own) < width;
    }
    estimate = estimate_by(scaled, runs.steps, all, fit.determined);
    if (!estimate.solved) { // some parameters move the statistics in one and the same way
        fit.alike = fit.determined;
        fit.determined.assign(fit.determined.size(), false);
        estimate = estimate_by(scaled, runs.steps, all, fit.determined);
    }
    information = information_of(scaled, estimate, runs.steps);
    fit.bound = plain(inverse_over(information, fit.determined));

    const VectorXd change = estimate.weights * (observed - estimate.mean);
    fit.change.assign(change.begin(), change.end());
    // Each run is fitted as if it were the measurement. A run less the mean of the others scatters by 1 + 1 / (R - 1)
    // times the covariance, a measurement less the mean of all runs by 1 + 1 / R.
    MatrixXd covariance = MatrixXd::Zero(parameters, parameters);
    std::vector<double> logarithms;
    logarithms.reserve(runs.centre.size());
    for (Index seed = 0; seed < seeds; ++seed) {
        const Estimate others = estimate_by(scaled, runs.steps, seeds_but(seeds, seed), fit.determined);
        const VectorXd run = scaled.centre.row(seed).transpose();
        const VectorXd of_run = others.weights * (run - others.mean);
        covariance += of_run * of_run.transpose() / static_cast<double>(seeds);
        logarithms.push_back(std::log(left_by(others, run)));
    }
    const double count = static_cast<double>(seeds);
    covariance *= (1 + 1 / count) / (1 + 1 / (count - 1));
    fit.covariance = plain(covariance);
    // The weights take as many directions from what the scatter tells.
    fit.degrees_of_freedom = count - static_cast<double>(estimate.basis.cols());

    double mean = 0, square = 0, level = 0;
    for (const double logarithm : logarithms) {
        mean += logarithm / count;
        level += std::exp(logarithm) / count;
    }
    for (const double logarithm : logarithms) {
        square += (logarithm - mean) * (logarithm - mean) / (count - 1);
    }
    const double left = left_by(estimate, observed);
    fit.misfit = left / level;
    const double spread = std::sqrt(square * (1 + 1 / count));
    fit.misfit_probability = spread > 0 && left > 0
                                 ? boost::math::cdf(boost::math::complement(boost::math::students_t(count - 1),
                                                                            (std::log(left) - mean) / spread))
                                 : (left > level ? 0.0 : 1.0);

    // Statistics that never differ keep their value, those fitted follow the slopes.
    fit.expected = runs.centre.front();
    const VectorXd expected = estimate.mean + estimate.slopes * change;
    for (std::size_t k = 0; k < kept.size(); ++k) {
        fit.expected[static_cast<std::size_t>(kept[k])] = expected[static_cast<Index>(k)] * deviations[k];
    }
    return fit;
}

} // namespace vkfv::statistics
