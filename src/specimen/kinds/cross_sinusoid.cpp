#include "specimen/kinds/cross_sinusoid.hpp"

#include "core/keys/section.hpp"

#include <algorithm>
#include <cmath>

namespace vkfv::specimen {
namespace {

const NumberKey cross_amplitude_key =
    for_example("0.5", NumberKey("amplitude_um", NumberRange::at_least(0), needed, "Of either wave: half its height."));
const NumberKey cross_wave_key =
    for_example("30.0", NumberKey("period_um", NumberRange::positive(), needed, "Of the wave along x."));
const NumberKey cross_wave_y_key("period_y_um", NumberRange::positive(), Default::in_words("as period_um"),
                                 "Of the wave along y.");

} // namespace

std::vector<const Key*> CrossSinusoid::keys() {
    return square_keys({&cross_amplitude_key, &cross_wave_key, &cross_wave_y_key});
}

CrossSinusoid CrossSinusoid::read(const Section& section) {
    CrossSinusoid waves;
    read_square(section, waves);
    waves.amplitude = from_um(section.number(cross_amplitude_key));
    const double period_um = section.number(cross_wave_key);
    waves.period = from_um(period_um);
    waves.period_y = from_um(section.number(cross_wave_y_key, period_um));
    return waves;
}

void CrossSinusoid::raise(HeightField& field, double, const SourceLocation& where) const {
    require_um(positive(period), where, "period_um", period, positive_um());
    require_um(positive(period_y), where, "period_y_um", period_y, positive_um());
    for (int row = 0; row < field.heights.rows; ++row) {
        for (int column = 0; column < field.heights.columns; ++column) {
            const double x = field.x_min + column * field.pitch_x, y = field.y_min + row * field.pitch_y;
            field.heights(column, row) =
                static_cast<float>(amplitude * (std::sin(2 * pi * x / period) + std::sin(2 * pi * y / period_y)));
        }
    }
}

dimensions::CrossSinusoid CrossSinusoid::feature() const {
    return {.frame = {}, .amplitude = amplitude, .period_u = period, .period_v = period_y};
}

} // namespace vkfv::specimen
