#include "specimen/kinds/sinusoid.hpp"

#include "core/keys/section.hpp"

#include <cmath>

namespace vkfv::specimen {
namespace {

const NumberKey sinusoid_amplitude_key =
    for_example("1.0", NumberKey("amplitude_um", NumberRange::at_least(0), needed,
                                 "Half the height from the valleys to the peaks."));
const NumberKey sinusoid_period_key =
    for_example("30.0", NumberKey("period_um", NumberRange::positive(), needed, "Of the wave."));

} // namespace

std::vector<const Key*> Sinusoid::keys() {
    return continuous_keys({&sinusoid_amplitude_key, &sinusoid_period_key});
}

Sinusoid Sinusoid::read(const Section& section) {
    Sinusoid wave;
    read_continuous(section, wave);
    wave.amplitude = from_um(section.number(sinusoid_amplitude_key));
    wave.period = from_um(section.number(sinusoid_period_key));
    return wave;
}

Analytic Sinusoid::function(const SourceLocation& where) const {
    require_um(std::isfinite(amplitude), where, "amplitude_um", amplitude, "a finite length");
    require_um(positive(period), where, "period_um", period, positive_um());
    return function_of(physics::f64::SHAPE_SINUSOID, {amplitude, period});
}

dimensions::Sinusoid Sinusoid::feature() const {
    return {.frame = {}, .amplitude = amplitude, .period = period};
}

} // namespace vkfv::specimen
