#include "specimen/kinds/radial_sinusoid.hpp"

#include "core/keys/section.hpp"

#include <algorithm>
#include <cmath>

namespace vkfv::specimen {
namespace {

const NumberKey radial_amplitude_key =
    for_example("1.0", NumberKey("amplitude_um", NumberRange::at_least(0), needed, "Half the height of the waves."));
const NumberKey radial_period_key =
    for_example("30.0", NumberKey("period_um", NumberRange::positive(), needed, "Along the radius."));

} // namespace

std::vector<const Key*> RadialSinusoid::keys() {
    return square_keys({&radial_amplitude_key, &radial_period_key});
}

RadialSinusoid RadialSinusoid::read(const Section& section) {
    RadialSinusoid waves;
    read_square(section, waves);
    waves.amplitude = from_um(section.number(radial_amplitude_key));
    waves.period = from_um(section.number(radial_period_key));
    return waves;
}

void RadialSinusoid::raise(HeightField& field, double, const SourceLocation& where) const {
    require_um(positive(period), where, "period_um", period, positive_um());
    for (int row = 0; row < field.heights.rows; ++row) {
        for (int column = 0; column < field.heights.columns; ++column) {
            const double x = field.x_min + column * field.pitch_x, y = field.y_min + row * field.pitch_y;
            field.heights(column, row) = static_cast<float>(amplitude * std::cos(2 * pi * std::hypot(x, y) / period));
        }
    }
}

dimensions::RadialSinusoid RadialSinusoid::feature() const {
    return {.frame = {}, .amplitude = amplitude, .period = period};
}

} // namespace vkfv::specimen
