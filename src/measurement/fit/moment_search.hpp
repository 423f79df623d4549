// The search for the parameters whose model explains the statistics of a measurement.
#pragma once

#include "measurement/fit/free_parameter.hpp"
#include "statistics/simulated_moments.hpp"

#include <functional>
#include <vector>

namespace vkfv::measurement {

// Statistics of a stack that the model makes by this seed, counted from 0, at a place of the parameters' scales. Stacks
// of one seed share their random numbers wherever the place is. Throws InputError for a place that the model refuses.
using StackModel = std::function<std::vector<double>(const std::vector<double>& place, int seed)>;

struct MomentSearch {
    std::vector<double> place{}; // about which the last fit is linear, on the parameters' scales
    std::vector<double> steps{}; // by which its slopes were taken
    statistics::MomentFit fit{}; // its change is from `place`
    bool settled = false;        // the change is smaller than the steps, so the fit is linear as far as it goes
};

// How far a search goes to either side of a place for its slopes, on a parameter's scale.
inline constexpr double moment_search_step = 0.1;

// The stacks that a search makes at most.
int most_stacks(std::size_t parameters, int replicates);

// Searches from 0 by Levenberg and Marquardt's algorithm with a quarter of the replicates, at least four, whose mean
// difference from the measurement is weighed by single standard deviations. At the place that it finds, the replicates
// are made by other seeds, and as many above and below each parameter; they give the fit (statistics::fit_moments). The
// fit is repeated about its own result if that is further away than the steps. Steps are about two standard
// uncertainties, so that differences stand above the model's scatter. replicates: at least statistics::least_seeds().
// Throws what the model throws, but for an InputError at a place to which only a trial step leads.
MomentSearch search_moments(const std::vector<FreeParameter>& parameters, const std::vector<double>& measured,
                            const StackModel& model, int replicates);

} // namespace vkfv::measurement
