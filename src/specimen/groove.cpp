#include "core/units.hpp"
#include "specimen/standards.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace vkfv::specimen {

HeightField groove(const Description& d, double pitch) {
    HeightField field = level_field(d, pitch);
    const double wall = d.wall == 0 ? field.pitch_x : d.wall;
    if (!(d.width > wall && d.width + wall < d.size))
        throw InputError({d.where, "specimen.width_um", fmt::format("{} um", d.width * um_per_mm),
                          fmt::format("more than the flank's {} um, and less than the specimen without one, {} um",
                                      wall * um_per_mm, (d.size - wall) * um_per_mm),
                          "Correct the value in the configuration."});
    for (int column = 0; column < field.heights.columns; ++column) {
        const double x = std::abs(field.x_min + column * field.pitch_x);
        const double share = std::clamp((0.5 * (d.width + wall) - x) / wall, 0.0, 1.0);
        for (int row = 0; row < field.heights.rows; ++row)
            field.heights(column, row) = static_cast<float>(-d.depth * share);
    }
    return field;
}

} // namespace vkfv::specimen
