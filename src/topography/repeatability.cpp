#include "topography/repeatability.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <stdexcept>
#include <vector>

namespace vkfv::topography {
namespace {

using surface::HeightMap;

// Sums of one point over the repetitions that measured it.
struct PointSums {
    double count = 0, sum = 0, squares = 0;

    void add(double value, double sign) {
        count += sign;
        sum += sign * value;
        squares += sign * value * value;
    }
    double mean() const { return sum / count; }
    double residuals() const { return std::max(0.0, squares - sum * sum / count); }
};

// Sums over the whole map.
struct Totals {
    double points = 0, mean_squares = 0, mean_scatter = 0, residuals = 0, freedoms = 0;

    void add(const PointSums& point) {
        if (point.count < 2)
            return;
        const double residuals_here = point.residuals();
        points += 1;
        mean_squares += point.mean() * point.mean();
        mean_scatter += residuals_here / (point.count - 1) / point.count;
        residuals += residuals_here;
        freedoms += point.count - 1;
    }
    double systematic() const { return std::sqrt(std::max(0.0, (mean_squares - mean_scatter) / points)); }
    double random() const { return std::sqrt(residuals / freedoms); }
};

double jackknife_error(const std::vector<double>& without_one) {
    const double n = static_cast<double>(without_one.size());
    if (n < 3)
        return std::numeric_limits<double>::quiet_NaN();
    double mean = 0, squares = 0;
    for (const double value : without_one)
        mean += value / n;
    for (const double value : without_one)
        squares += (value - mean) * (value - mean);
    return std::sqrt((n - 1) / n * squares);
}

} // namespace

SystematicAndRandom systematic_and_random(std::span<const HeightMap> deviations) {
    if (deviations.size() < 2)
        throw std::invalid_argument("systematic_and_random: two repetitions or more");
    const HeightMap& first = deviations.front();
    for (const HeightMap& map : deviations)
        if (map.columns() != first.columns() || map.rows() != first.rows())
            throw std::invalid_argument("systematic_and_random: all height maps must stand on the same grid");

    SystematicAndRandom result{.mean_deviation = first, .standard_deviation = first};
    Totals all;
    std::vector<Totals> without(deviations.size());
    for (std::size_t k = 0; k < first.height.values.size(); ++k) {
        PointSums point;
        for (const HeightMap& map : deviations)
            if (const double d = map.height.values[k]; std::isfinite(d))
                point.add(d, 1);
        all.add(point);
        const bool counts = point.count >= 2;
        constexpr double not_measured = std::numeric_limits<double>::quiet_NaN();
        result.mean_deviation.height.values[k] = counts ? point.mean() : not_measured;
        result.standard_deviation.height.values[k] =
            counts ? std::sqrt(point.residuals() / (point.count - 1)) : not_measured;
        for (std::size_t left_out = 0; left_out < deviations.size(); ++left_out) {
            PointSums rest = point;
            if (const double d = deviations[left_out].height.values[k]; std::isfinite(d))
                rest.add(d, -1);
            without[left_out].add(rest);
        }
    }
    std::vector<double> systematic, random;
    for (const Totals& totals : without) {
        systematic.push_back(totals.systematic());
        random.push_back(totals.random());
    }
    result.systematic = all.systematic();
    result.random = all.random();
    result.systematic_error = jackknife_error(systematic);
    result.random_error = jackknife_error(random);
    result.points = all.points;
    return result;
}

} // namespace vkfv::topography
