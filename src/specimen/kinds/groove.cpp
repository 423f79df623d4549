#include "specimen/kinds/groove.hpp"

#include "core/keys/section.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace vkfv::specimen {
namespace {

const NumberKey groove_wall_key("wall_um", NumberRange::at_least(0), 0.0, "Width of a flank; 0: one pitch.");
const NumberKey width_key =
    for_example("20.0", NumberKey("width_um", NumberRange::positive(), needed, "Between the middles of the flanks."));
const NumberKey depth_key =
    for_example("2.0", NumberKey("depth_um", NumberRange::finite(), needed, "Of the ground below the level."));

} // namespace

std::vector<const Key*> Groove::keys() {
    return square_keys({&groove_wall_key, &width_key, &depth_key});
}

Groove Groove::read(const Section& section) {
    Groove groove;
    read_square(section, groove);
    groove.wall = from_um(section.number(groove_wall_key));
    groove.width = from_um(section.number(width_key));
    groove.depth = from_um(section.number(depth_key));
    return groove;
}

void Groove::raise(HeightField& field, double, const SourceLocation& where) const {
    const double flank = wall == 0 ? field.pitch_x : wall;
    if (!(width > flank && width + flank < size)) {
        throw InputError({where, "specimen.width_um", fmt::format("{} um", width * um_per_mm),
                          fmt::format("more than the flank's {} um, and less than the specimen without one, {} um",
                                      flank * um_per_mm, (size - flank) * um_per_mm),
                          "Correct the value in the configuration."});
    }
    for (int column = 0; column < field.heights.columns; ++column) {
        const double x = std::abs(field.x_min + column * field.pitch_x);
        const double share = std::clamp((0.5 * (width + flank) - x) / flank, 0.0, 1.0);
        for (int row = 0; row < field.heights.rows; ++row) {
            field.heights(column, row) = static_cast<float>(-depth * share);
        }
    }
}

dimensions::Groove Groove::feature() const {
    return {.frame = {}, .width = width, .depth = depth};
}

} // namespace vkfv::specimen
