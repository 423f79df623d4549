// The combination of standard uncertainties (JCGM 100, clause 5 and annex G), and the statistics of trials in which all
// inputs deviate at once (JCGM 101, clause 7).
#pragma once

#include "configuration/configuration.hpp"

#include <span>
#include <vector>

namespace vkfv::measurement {

// A term of a budget: what an input with its standard uncertainty changes in the result.
struct Contribution {
    double value = 0; // sensitivity times standard uncertainty, with the sensitivity's sign
    double degrees_of_freedom = 0;
};

struct CombinedUncertainty {
    double standard_uncertainty = 0;
    double degrees_of_freedom = 0; // effective ones, by Welch and Satterthwaite
    double coverage_factor = 0;    // for 95 %, by Student's distribution

    double expanded_uncertainty() const { return coverage_factor * standard_uncertainty; }
};

// JCGM 100, equations (13), (16) and (G.2b). Correlations name contributions by their place.
CombinedUncertainty combined(std::span<const Contribution> contributions,
                             std::span<const Uncertainty::Correlation> correlations = {});

struct TrialStatistics {
    int trials = 0;
    double mean = 0;
    double standard_deviation = 0;
    double low = 0, high = 0; // ends of the probabilistically symmetric interval of 95 %
    // Standard deviation of these ends themselves, for results that are normal.
    double end_uncertainty = 0;
};

// JCGM 101, equations (16) and (17) and clause 7.7. values: at least 2.
TrialStatistics statistics_of(std::vector<double> values);

// Half a unit of the last digit of a positive uncertainty that is written with so many significant digits (JCGM 101,
// clause 7.9.2): 0.0005 for 0.0539 and two digits, so 0.054.
double numerical_tolerance(double uncertainty, int digits);

} // namespace vkfv::measurement
