#include "topography/comparison.hpp"

#include "core/units.hpp"
#include "surface/resample.hpp"

#include <cmath>
#include <utility>

namespace vkfv::topography {
namespace {

using surface::HeightMap;

LateralShift mean_shift(const std::vector<MeasurementComparison>& measurements) {
    LateralShift mean;
    double count = 0;
    for (const auto& measurement : measurements)
        if (std::isfinite(measurement.shift.x)) {
            mean.x += measurement.shift.x;
            mean.y += measurement.shift.y;
            mean.correlation += measurement.shift.correlation;
            count += 1;
        }
    return count > 0 ? LateralShift{mean.x / count, mean.y / count, mean.correlation / count} : mean;
}

} // namespace

Comparison compare_with_truth(std::span<const HeightMap> measurements, const HeightMap& truth, bool align) {
    Comparison result;
    for (const HeightMap& measured : measurements) {
        result.measurements.emplace_back();
        result.measurements.back().shift = lateral_shift(measured, truth);
    }
    if (align)
        result.removed_shift = mean_shift(result.measurements);
    result.truth = shifted_onto(truth, measurements.front(), result.removed_shift);

    std::vector<HeightMap> deviations;
    for (std::size_t k = 0; k < measurements.size(); ++k) {
        MeasurementComparison& comparison = result.measurements[k];
        const LevelledPair pair = levelled_pair(measurements[k], result.truth);
        comparison.deviation = compare(measurements[k], result.truth);
        comparison.measured = surface::areal_parameters(pair.measured);
        comparison.truth = surface::areal_parameters(pair.truth);
        deviations.push_back(deviation_map(measurements[k], result.truth));
    }
    if (deviations.size() > 1) {
        result.parts = systematic_and_random(deviations);
        result.deviation = result.parts->mean_deviation;
    } else {
        result.deviation = std::move(deviations.front());
    }

    HeightMap mean_measurement = result.truth;
    for (std::size_t k = 0; k < mean_measurement.height.values.size(); ++k)
        mean_measurement.height.values[k] += result.deviation.height.values[k];
    result.transfer = height_transfer(mean_measurement, result.truth);
    result.slopes = deviation_by_slope(result.deviation, result.truth, 2 * radians_per_degree);
    return result;
}

} // namespace vkfv::topography
