#include "core/units.hpp"
#include "specimen/standards.hpp"

#include <cmath>

namespace vkfv::specimen {

HeightField star(const Description& d, double pitch) {
    HeightField field = level_field(d, pitch);
    for (int row = 0; row < field.heights.rows; ++row)
        for (int column = 0; column < field.heights.columns; ++column) {
            const double x = field.x_min + column * field.pitch_x, y = field.y_min + row * field.pitch_y;
            const double petal = std::atan2(y, x) / (2 * pi) * d.petals; // in periods
            if (std::hypot(x, y) <= d.radius && petal - std::floor(petal) < 0.5)
                field.heights(column, row) = static_cast<float>(d.height);
        }
    return field;
}

} // namespace vkfv::specimen
