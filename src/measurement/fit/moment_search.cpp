#include "measurement/fit/moment_search.hpp"

#include "core/messages/error.hpp"
#include "core/messages/stages.hpp"
#include "statistics/nonlinear_least_squares.hpp"

#include <spdlog/spdlog.h>

#include <algorithm>
#include <cmath>
#include <utility>

namespace vkfv::measurement {

namespace {
namespace of_moment_search { // files of a unity build share the unnamed namespace

using Place = std::vector<double>;
using Runs = std::vector<std::vector<double>>;

constexpr int most_evaluations = 10, most_rounds = 3;
constexpr double furthest = 4; // on that scale: 2 to 98 % of a range, or a factor of 55
constexpr double least_step = 0.02, most_step = 0.4;
// The steps move all statistics together by so many standard deviations. That would be five standard uncertainties if
// statistics were independent; since neighbours scatter alike, it is about two.
constexpr double steps_in_deviations = 5;

int search_seeds(int replicates) {
    return std::max(4, replicates / 4);
}

Runs runs_at(const StackModel& model, const Place& place, int first, int count) {
    Runs runs;
    runs.reserve(static_cast<std::size_t>(count));
    for (int k = 0; k < count; ++k) {
        runs.push_back(model(place, first + k));
    }
    return runs;
}

Place moved(Place place, std::size_t parameter, double by) {
    place[parameter] += by;
    return place;
}

std::vector<double> mean_of(const Runs& runs) {
    std::vector<double> mean(runs.front().size());
    for (const auto& run : runs) {
        for (std::size_t k = 0; k < mean.size(); ++k) {
            mean[k] += run[k] / static_cast<double>(runs.size());
        }
    }
    return mean;
}

// Standard deviations of the statistics. Each is taken half from its own scatter and half from that of its neighbours,
// so that none weighs much because a few runs agree by chance; 0: the statistic never differs.
std::vector<double> deviations_of(const Runs& runs) {
    const auto mean = mean_of(runs);
    std::vector<double> own(mean.size());
    for (const auto& run : runs) {
        for (std::size_t k = 0; k < mean.size(); ++k) {
            own[k] += (run[k] - mean[k]) * (run[k] - mean[k]) / static_cast<double>(runs.size() - 1);
        }
    }
    std::vector<double> deviations(own.size());
    for (std::size_t k = 0; k < own.size(); ++k) {
        const std::size_t first = k > 0 ? k - 1 : k, last = std::min(k + 1, own.size() - 1);
        double sum = 0;
        for (std::size_t other = first; other <= last; ++other) {
            sum += own[other] / static_cast<double>(last - first + 1);
        }
        deviations[k] = own[k] > 0 ? std::sqrt(0.5 * (own[k] + sum)) : 0;
    }
    return deviations;
}

// The distance of the model from the measurement, in standard deviations.
class Distance {
  public:
    Distance(const std::vector<double>& measured, const StackModel& model, std::vector<double> deviations, int seeds)
        : measured_(measured), model_(model), deviations_(std::move(deviations)), seeds_(seeds) {}

    std::vector<double> residuals(const Place& place) const {
        constexpr double refused = 1e3; // standard deviations
        const bool far = std::ranges::any_of(place, [](double one) { return !(std::abs(one) <= furthest); });
        try {
            if (!far) {
                return difference(mean_of(runs_at(model_, place, 0, seeds_)));
            }
        } catch (const InputError& error) { // the configuration allows no such numbers together
            if (std::ranges::all_of(place, [](double one) { return one == 0; })) {
                throw;
            }
            spdlog::debug("a place of the search is refused: {}", error.what());
        }
        return std::vector<double>(measured_.size(), refused);
    }

    statistics::Matrix slopes(const Place& place) const {
        statistics::Matrix slopes(measured_.size(), place.size());
        for (std::size_t k = 0; k < place.size(); ++k) {
            const auto above = difference(mean_of(runs_at(model_, moved(place, k, moment_search_step), 0, seeds_)));
            const auto below = difference(mean_of(runs_at(model_, moved(place, k, -moment_search_step), 0, seeds_)));
            for (std::size_t row = 0; row < above.size(); ++row) {
                slopes(row, k) = (above[row] - below[row]) / (2 * moment_search_step);
            }
        }
        last_slopes_ = slopes;
        return slopes;
    }

    // The result of the last call of slopes(), which the algorithm does not give back.
    const statistics::Matrix& last_slopes() const { return last_slopes_; }

  private:
    std::vector<double> difference(const std::vector<double>& mean) const {
        std::vector<double> result(mean.size());
        for (std::size_t k = 0; k < mean.size(); ++k) {
            result[k] = deviations_[k] > 0 ? (mean[k] - measured_[k]) / deviations_[k] : 0;
        }
        return result;
    }

    const std::vector<double>& measured_;
    const StackModel& model_;
    std::vector<double> deviations_;
    int seeds_;
    mutable statistics::Matrix last_slopes_{};
};

std::vector<double> steps_by(const statistics::Matrix& slopes) {
    std::vector<double> steps(slopes.columns);
    for (std::size_t k = 0; k < slopes.columns; ++k) {
        double square = 0;
        for (std::size_t row = 0; row < slopes.rows; ++row) {
            square += slopes(row, k) * slopes(row, k);
        }
        const double wanted = square > 0 ? steps_in_deviations / std::sqrt(square) : most_step;
        steps[k] = std::clamp(wanted, least_step, most_step);
    }
    return steps;
}

} // namespace of_moment_search
} // namespace

int most_stacks(std::size_t parameters, int replicates) {
    using namespace of_moment_search;
    const int places = 1 + 2 * static_cast<int>(parameters);
    return replicates + most_evaluations * places * search_seeds(replicates) + most_rounds * places * replicates;
}

MomentSearch search_moments(const std::vector<FreeParameter>& parameters, const std::vector<double>& measured,
                            const StackModel& model, int replicates) {
    using namespace of_moment_search;
    const Place start(parameters.size(), 0.0);
    enter_stage("scatter of the model");
    statistics::ModelRuns runs;
    runs.pilot = runs_at(model, start, 0, replicates);
    enter_stage("search");
    const Distance distance(measured, model, deviations_of(runs.pilot), search_seeds(replicates));
    constexpr double tolerance = 1e-2; // of the sum of squares, and of the place
    const auto end =
        statistics::nonlinear_least_squares({.values = [&](const Place& place) { return distance.residuals(place); },
                                             .slopes = [&](const Place& place) { return distance.slopes(place); }},
                                            start, tolerance, most_evaluations);
    MomentSearch search{.place = end.unknowns, .steps = steps_by(distance.last_slopes())};
    runs.steps = search.steps;
    for (int round = 0; round < most_rounds && !search.settled; ++round) {
        enter_stage("covariance of the parameters");
        runs.centre = runs_at(model, search.place, replicates, replicates);
        runs.above.clear();
        runs.below.clear();
        runs.widths.clear();
        runs.above.reserve(parameters.size());
        runs.below.reserve(parameters.size());
        runs.widths.reserve(parameters.size());
        for (std::size_t k = 0; k < parameters.size(); ++k) {
            runs.above.push_back(runs_at(model, moved(search.place, k, runs.steps[k]), replicates, replicates));
            runs.below.push_back(runs_at(model, moved(search.place, k, -runs.steps[k]), replicates, replicates));
            runs.widths.push_back(parameters[k].known_width(search.place[k]));
        }
        search.fit = statistics::fit_moments(runs, measured);
        search.settled = true;
        Place next = search.place;
        for (std::size_t k = 0; k < next.size(); ++k) {
            const double change = search.fit.change[k], most = 3 * search.steps[k];
            search.settled = search.settled && std::abs(change) <= search.steps[k];
            next[k] = std::clamp(next[k] + std::clamp(change, -most, most), -furthest, furthest);
        }
        if (!search.settled && round + 1 < most_rounds) {
            search.place = next;
        }
    }
    return search;
}

} // namespace vkfv::measurement
