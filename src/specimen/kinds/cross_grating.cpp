#include "specimen/kinds/cross_grating.hpp"

#include "core/keys/section.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

namespace vkfv::specimen {
namespace {

const NumberKey cross_period_key =
    for_example("20.0", NumberKey("period_um", NumberRange::positive(), needed, "Across the lines along y."));
const NumberKey cross_period_y_key("period_y_um", NumberRange::positive(), Default::in_words("as period_um"),
                                   "Across the other lines.");
const NumberKey cross_angle_key("angle_deg", NumberRange::within(30, 150), 90.0, "Between the two directions.");
const NumberKey cross_line_key("line_width_um", NumberRange::positive(),
                               Default::in_words("half of the smaller period"), "Of either lines.");
const NumberKey cross_depth_key =
    for_example("2.0", NumberKey("depth_um", NumberRange::finite(), needed, "Of the ground below the raised areas."));

} // namespace

std::vector<const Key*> CrossGrating::keys() {
    return square_keys({&cross_period_key, &cross_period_y_key, &cross_angle_key, &cross_line_key, &cross_depth_key});
}

CrossGrating CrossGrating::read(const Section& section) {
    CrossGrating grating;
    read_square(section, grating);
    const double period_um = section.number(cross_period_key);
    const double period_y_um = section.number(cross_period_y_key, period_um);
    grating.period = from_um(period_um);
    grating.period_y = from_um(period_y_um);
    grating.angle = section.number(cross_angle_key) * radians_per_degree;
    grating.line_width = from_um(section.number(cross_line_key, 0.5 * std::min(period_um, period_y_um)));
    grating.depth = from_um(section.number(cross_depth_key));
    return grating;
}

void CrossGrating::raise(HeightField& field, double, const SourceLocation& where) const {
    for (const auto& [key, length] : {std::pair{"period_um", period}, std::pair{"period_y_um", period_y}}) {
        require_um(positive(length) && length >= 2 * field.pitch_x, where, key, length,
                   "at least two points of the facets' grid");
    }
    require_um(line_width < std::min(period, period_y), where, "line_width_um", line_width,
               "less than the smaller period");
    const auto on_line = [&](double across, double length) {
        return std::abs(across - length * std::round(across / length)) <= 0.5 * line_width;
    };
    for (int row = 0; row < field.heights.rows; ++row) {
        for (int column = 0; column < field.heights.columns; ++column) {
            const double x = field.x_min + column * field.pitch_x, y = field.y_min + row * field.pitch_y;
            const double other = x * std::cos(angle) + y * std::sin(angle);
            const bool raised = on_line(x, period) && on_line(other, period_y);
            field.heights(column, row) = static_cast<float>(raised ? 0 : -depth);
        }
    }
}

dimensions::CrossGrating CrossGrating::feature() const {
    return {.frame = {}, .pitch_u = period, .pitch_v = period_y, .angle = angle};
}

} // namespace vkfv::specimen
