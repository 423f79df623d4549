#include "topography/compare.hpp"

#include "surface/filter.hpp"
#include "surface/height_parameters.hpp"

#include <cmath>
#include <future>
#include <limits>
#include <stdexcept>
#include <utility>

namespace vkfv::topography {
namespace {

using surface::HeightMap;

// Points that are not measured in one map become not measured in both.
void keep_common_points(HeightMap& measured, HeightMap& truth) {
    for (std::size_t k = 0; k < measured.height.values.size(); ++k) {
        double& a = measured.height.values[k];
        double& b = truth.height.values[k];
        if (!std::isfinite(a) || !std::isfinite(b))
            a = b = std::numeric_limits<double>::quiet_NaN();
    }
}

HeightMap difference_of(HeightMap measured, const HeightMap& truth) {
    for (std::size_t k = 0; k < measured.height.values.size(); ++k)
        measured.height.values[k] -= truth.height.values[k];
    return measured;
}

} // namespace

LevelledPair levelled_pair(HeightMap measured, HeightMap truth, const Band& band) {
    if (measured.columns() != truth.columns() || measured.rows() != truth.rows())
        throw std::invalid_argument("compare: both height maps must stand on the same grid");
    keep_common_points(measured, truth);
    if (band.form.kind == surface::Form::Kind::truth) {
        measured = remove_plane(std::move(measured), least_squares_plane(difference_of(measured, truth)));
    } else {
        auto of_truth = std::async(std::launch::async, [&] { return remove_form(std::move(truth), band.form); });
        measured = remove_form(std::move(measured), band.form);
        truth = of_truth.get();
        keep_common_points(measured, truth); // the removal of a sphere leaves points beyond its edge undefined
    }
    return {.measured = filtered(std::move(measured), band),
            .truth = filtered(std::move(truth), band),
            .form_removed = band.form.kind != surface::Form::Kind::none};
}

double ratio_to_truth(double measured, double truth) {
    return truth == 0 ? std::numeric_limits<double>::quiet_NaN() : measured / truth;
}

Deviation compare(const LevelledPair& treated, const HeightMap& deviation) {
    auto of_truth = std::async(std::launch::async, [&] { return surface::height_parameters(treated.truth); });
    auto of_difference = std::async(std::launch::async, [&] { return surface::height_parameters(deviation); });
    const auto a = surface::height_parameters(treated.measured);
    const auto b = of_truth.get();
    double covariance = 0, count = 0;
    for (std::size_t k = 0; k < treated.measured.height.values.size(); ++k)
        if (const double z = treated.measured.height.values[k]; std::isfinite(z)) {
            covariance += (z - a.mean) * (treated.truth.height.values[k] - b.mean);
            count += 1;
        }
    const auto difference = of_difference.get();
    Deviation result;
    result.sq_measured = a.sq;
    result.sq_true = b.sq;
    // Sq is taken about the mean, which is a part of the deviation where no form was removed.
    result.rms = treated.form_removed ? difference.sq : std::hypot(difference.sq, difference.mean);
    if (count == 0)
        result.correlation = std::numeric_limits<double>::quiet_NaN();
    else if (a.sq > 0 && b.sq > 0)
        result.correlation = covariance / count / (a.sq * b.sq);
    result.measured_share = a.measured_share;
    if (count > 0 && b.sq > 0) {
        result.slope = covariance / count / (b.sq * b.sq);
        result.offset = a.mean - result.slope * b.mean;
    }
    return result;
}

Deviation compare(const LevelledPair& treated) {
    return compare(treated, deviation_map(treated));
}

Deviation compare(const HeightMap& measured, const HeightMap& truth, const Band& band) {
    return compare(levelled_pair(measured, truth, band));
}

HeightMap deviation_map(const LevelledPair& treated) {
    const HeightMap result = difference_of(treated.measured, treated.truth);
    // Levelled maps differ by a levelled map; after other forms or an L-filter some offset and tilt may remain.
    return treated.form_removed ? surface::remove_plane(result, surface::least_squares_plane(result)) : result;
}

HeightMap deviation_map(const HeightMap& measured, const HeightMap& truth, const Band& band) {
    return deviation_map(levelled_pair(measured, truth, band));
}

ComparedPair compared_pair(HeightMap measured, HeightMap truth, const Band& band) {
    ComparedPair result{
        .pair = levelled_pair(std::move(measured), std::move(truth), band), .difference = {}, .deviation = {}};
    result.difference = deviation_map(result.pair);
    result.deviation = compare(result.pair, result.difference);
    return result;
}

double share_beyond(const surface::HeightMap& deviation, const Grid<double>& uncertainty, double coverage_factor) {
    if (uncertainty.columns != deviation.columns() || uncertainty.rows != deviation.rows()) {
        throw std::invalid_argument("share_beyond: as many uncertainties as deviations are needed");
    }
    double points = 0, beyond = 0;
    for (std::size_t k = 0; k < uncertainty.values.size(); ++k) {
        const double off = std::abs(deviation.height.values[k]);
        if (std::isfinite(off)) {
            points += 1;
            beyond += off <= coverage_factor * uncertainty.values[k] ? 0 : 1;
        }
    }
    return beyond / points;
}

} // namespace vkfv::topography
