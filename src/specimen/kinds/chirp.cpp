#include "specimen/kinds/chirp.hpp"

#include "core/keys/section.hpp"

#include <cmath>

namespace vkfv::specimen {
namespace {

const NumberKey chirp_amplitude_key = for_example("1.0", NumberKey("amplitude_um", NumberRange::at_least(0), needed,
                                                                   "Half the height from the valleys to the peaks."));
const NumberKey chirp_period_key =
    for_example("30.0", NumberKey("period_um", NumberRange::positive(), needed, "At the lowest x."));
const NumberKey period_stop_key =
    for_example("10.0", NumberKey("period_stop_um", NumberRange::positive(), needed, "At the highest x."));

} // namespace

std::vector<const Key*> Chirp::keys() {
    return continuous_keys({&chirp_amplitude_key, &chirp_period_key, &period_stop_key});
}

Chirp Chirp::read(const Section& section) {
    Chirp chirp;
    read_continuous(section, chirp);
    chirp.amplitude = from_um(section.number(chirp_amplitude_key));
    chirp.period = from_um(section.number(chirp_period_key));
    chirp.period_stop = from_um(section.number(period_stop_key));
    return chirp;
}

Analytic Chirp::function(const SourceLocation& where) const {
    require_um(std::isfinite(amplitude), where, "amplitude_um", amplitude, "a finite length");
    require_um(positive(period), where, "period_um", period, positive_um());
    require_um(positive(period_stop), where, "period_stop_um", period_stop, positive_um());
    return function_of(physics::f64::SHAPE_CHIRP, {amplitude, period, period_stop});
}

dimensions::Chirp Chirp::feature() const {
    return {.frame = {},
            .amplitude = amplitude,
            .start = -0.5 * size,
            .length = size,
            .period_start = period,
            .period_stop = period_stop};
}

} // namespace vkfv::specimen
