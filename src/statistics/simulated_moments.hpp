// Parameters of a model from the statistics of one measurement, where the model has no closed form but can be run with
// other seeds: the method of simulated moments (McFadden, Econometrica 57 (1989) 995).
#pragma once

#include "statistics/matrix.hpp"

#include <cstddef>
#include <vector>

namespace vkfv::statistics {

// Runs of the model about one point of its parameters. Runs of the same seed share their random numbers whatever the
// parameters are, so that their differences are smooth. All have the same statistics in the same order.
struct ModelRuns {
    // Runs by other seeds, at this point or one near it: they choose the directions in which statistics are looked at.
    // If they were the runs below, directions would be chosen in which these scatter little by chance.
    std::vector<std::vector<double>> pilot{};              // [seed][statistic]; at least least_seeds
    std::vector<std::vector<double>> centre{};             // [seed][statistic]; at least least_seeds
    std::vector<std::vector<std::vector<double>>> above{}; // [parameter][seed][statistic]: larger by its step
    std::vector<std::vector<std::vector<double>>> below{}; // smaller by its step
    std::vector<double> steps{};                           // of the parameters, positive
    // Width of the range in which each parameter is known to lie before the measurement; infinite: not known.
    std::vector<double> widths{};
};

// The least number of seeds for so many parameters: their covariance needs more seeds than it has rows.
constexpr std::size_t least_seeds(std::size_t parameters) {
    return 2 * parameters + 6;
}

// The parameters that explain a measurement, as a change from the point of the runs.
struct MomentFit {
    // Whether the statistics tell a parameter better than its range does. One that they do not tell stays at the point:
    // its change is 0, and its row and column in the matrices are 0.
    std::vector<bool> determined{};
    // Parameters that the statistics would tell, were not some of them alike: these move the statistics in one and the
    // same way to rounding, so that none is determined. All false where that is not so.
    std::vector<bool> alike{};
    std::vector<double> change{};
    Matrix covariance{};           // of the change, by the runs' own scatter
    double degrees_of_freedom = 0; // of the covariance
    // Cramer-Rao bound: inverse of the Fisher information of a normal distribution of the statistics, by its mean and
    // its covariance (Kay, Fundamentals of Statistical Signal Processing I, equation 3.31). Without rows where the
    // information is not positive.
    Matrix bound{};
    // Mean square of what the fit leaves of the standardised statistics, over that of runs fitted alike: about 1 if the
    // model describes the measurement.
    double misfit = 0;
    double misfit_probability = 0;   // of a misfit as large or larger, if the model describes the measurement
    std::vector<double> expected{};  // statistics at the fitted parameters
    std::vector<double> deviation{}; // standard deviations of the statistics of one measurement, at the point
};

// The fit, linear about the point of the runs. The statistics are reduced to the directions in which the parameters
// move them, and to the largest principal components of the pilot's scatter; in these their covariance weighs them. The
// covariance of the fit needs no assumption on the statistics' distribution: each run at the point is fitted by weights
// made from all others, and the fits' scatter is that of a measurement. The mean of the runs adds its share. The bound
// multiplies slopes of two halves of the seeds, whose noise is independent and so adds no information. Throws
// std::invalid_argument for shapes that differ or for fewer than least_seeds(), and std::domain_error if no statistic
// scatters.
MomentFit fit_moments(const ModelRuns& runs, const std::vector<double>& measured);

} // namespace vkfv::statistics
