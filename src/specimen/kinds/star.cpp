#include "specimen/kinds/star.hpp"

#include "core/keys/section.hpp"

#include <cmath>

namespace vkfv::specimen {
namespace {

const NumberKey star_radius_key =
    for_example("100.0", NumberKey("radius_um", NumberRange::positive(), needed, "Of the sectors' outer end."));
const NumberKey star_height_key = for_example(
    "2.0", NumberKey("height_um", NumberRange::finite(), needed, "Of the raised sectors over those between them."));
const IntegerKey petals_key = for_example("36", IntegerKey("petals", 1, 360, needed, "Raised sectors."));

} // namespace

std::vector<const Key*> Star::keys() {
    return square_keys({&star_radius_key, &star_height_key, &petals_key});
}

Star Star::read(const Section& section) {
    Star star;
    read_square(section, star);
    star.radius = from_um(section.number(star_radius_key));
    star.height = from_um(section.number(star_height_key));
    star.petals = static_cast<int>(section.integer(petals_key));
    return star;
}

void Star::raise(HeightField& field, double, const SourceLocation&) const {
    for (int row = 0; row < field.heights.rows; ++row) {
        for (int column = 0; column < field.heights.columns; ++column) {
            const double x = field.x_min + column * field.pitch_x, y = field.y_min + row * field.pitch_y;
            const double petal = std::atan2(y, x) / (2 * pi) * petals; // angle in units of the period
            if (std::hypot(x, y) <= radius && petal - std::floor(petal) < 0.5) {
                field.heights(column, row) = static_cast<float>(height);
            }
        }
    }
}

dimensions::Star Star::feature() const {
    return {.frame = {}, .petals = petals, .radius = radius, .height = height};
}

} // namespace vkfv::specimen
