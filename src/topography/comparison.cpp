#include "topography/comparison.hpp"

#include "core/mathematics/units.hpp"
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

HeightMap mean_levelled_deviation(std::span<const HeightMap> measurements, const HeightMap& truth) {
    std::vector<HeightMap> deviations;
    for (const HeightMap& measured : measurements)
        deviations.push_back(deviation_map(measured, truth));
    return deviations.size() > 1 ? systematic_and_random(deviations).mean_deviation : std::move(deviations.front());
}

} // namespace

Comparison compare_with_truth(std::span<const HeightMap> measurements, const HeightMap& truth, bool align,
                              const Band& band) {
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
        const LevelledPair pair = levelled_pair(measurements[k], result.truth, band);
        comparison.deviation = compare(pair);
        comparison.measured = surface::areal_parameters(pair.measured);
        comparison.truth = surface::areal_parameters(pair.truth);
        deviations.push_back(deviation_map(pair));
    }
    if (deviations.size() > 1) {
        result.parts = systematic_and_random(deviations);
        result.deviation = result.parts->mean_deviation;
    } else {
        result.deviation = std::move(deviations.front());
    }

    const HeightMap levelled = band == Band{} ? result.deviation : mean_levelled_deviation(measurements, result.truth);
    HeightMap mean_measurement = result.truth;
    for (std::size_t k = 0; k < mean_measurement.height.values.size(); ++k)
        mean_measurement.height.values[k] += levelled.height.values[k];
    result.transfer = height_transfer(mean_measurement, result.truth);
    result.slopes = deviation_by_slope(levelled, result.truth, 2 * radians_per_degree);
    return result;
}

} // namespace vkfv::topography
