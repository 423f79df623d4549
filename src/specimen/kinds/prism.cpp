#include "specimen/kinds/prism.hpp"

#include "core/keys/section.hpp"

#include <algorithm>
#include <cmath>

namespace vkfv::specimen {
namespace {

const NumberKey prism_height_key =
    for_example("20.0", NumberKey("height_um", NumberRange::finite(), needed, "Over the plane; negative: a V-groove."));
const NumberKey prism_flank_key =
    for_example("45.0", NumberKey("flank_deg", {.minimum = 0, .maximum = 88, .minimum_included = false}, needed,
                                  "Angle of either flank against the plane."));
const NumberKey prism_top_key("top_um", NumberRange::at_least(0), 0.0, "Width of the level between the flanks.");

} // namespace

std::vector<const Key*> Prism::keys() {
    return square_keys({&prism_height_key, &prism_flank_key, &prism_top_key});
}

Prism Prism::read(const Section& section) {
    Prism prism;
    read_square(section, prism);
    prism.height = from_um(section.number(prism_height_key));
    prism.flank = section.number(prism_flank_key) * radians_per_degree;
    prism.top = from_um(section.number(prism_top_key));
    return prism;
}

void Prism::raise(HeightField& field, double, const SourceLocation& where) const {
    const double slope = std::tan(flank), side = height < 0 ? -1 : 1, size_of_height = std::abs(height);
    require_um(top + 2 * size_of_height / slope <= size, where, "height_um", height, "flanks that end on the specimen");
    for (int column = 0; column < field.heights.columns; ++column) {
        const double x = std::abs(field.x_min + column * field.pitch_x);
        const double z = side * std::clamp(size_of_height - slope * (x - 0.5 * top), 0.0, size_of_height);
        for (int row = 0; row < field.heights.rows; ++row) {
            field.heights(column, row) = static_cast<float>(z);
        }
    }
}

dimensions::Prism Prism::feature() const {
    return {.frame = {}, .height = height, .flank_angle = flank, .top_width = top};
}

} // namespace vkfv::specimen
