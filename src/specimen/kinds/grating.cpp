#include "specimen/kinds/grating.hpp"

#include "core/keys/section.hpp"

#include <algorithm>
#include <cmath>

namespace vkfv::specimen {
namespace {

const ChoiceKey<Grating::Profile>
    grating_profile_key("profile",
                        {{Grating::Profile::rectangular, "rectangular", "Lines and ground are level."},
                         {Grating::Profile::triangular, "triangular", "Straight flanks between edges."}},
                        Grating::Profile::rectangular, "Of the lines.");
const NumberKey grating_period_key =
    for_example("20.0", NumberKey("period_um", NumberRange::positive(), needed, "From line to line."));
const NumberKey grating_depth_key = for_example(
    "2.0", NumberKey("depth_um", NumberRange::finite(), needed, "Of the ground below the tops of the lines."));
const NumberKey grating_line_key("line_width_um", NumberRange::positive(), Default::in_words("half of period_um"),
                                 "Of a rectangular line at half depth.");
const NumberKey grating_wall_key("wall_um", NumberRange::at_least(0), 0.0,
                                 "Width of a rectangular line's flank; 0: one pitch.");

} // namespace

std::vector<const Key*> Grating::keys() {
    return square_keys(
        {&grating_profile_key, &grating_period_key, &grating_depth_key, &grating_line_key, &grating_wall_key});
}

Grating Grating::read(const Section& section) {
    Grating grating;
    read_square(section, grating);
    grating.profile = section.choice(grating_profile_key);
    const double period_um = section.number(grating_period_key);
    grating.period = from_um(period_um);
    grating.depth = from_um(section.number(grating_depth_key));
    if (grating.profile == Profile::rectangular) {
        grating.line_width = from_um(section.number(grating_line_key, 0.5 * period_um));
        grating.wall = from_um(section.number(grating_wall_key));
    } else {
        for (const Key* key : std::initializer_list<const Key*>{&grating_line_key, &grating_wall_key}) {
            if (section.has(*key)) {
                section.note(*key, "no such key for profile = \"triangular\"", "Remove it.");
            }
        }
    }
    return grating;
}

void Grating::raise(HeightField& field, double, const SourceLocation& where) const {
    const double flank = wall == 0 ? field.pitch_x : wall;
    require_um(positive(period) && period >= 2 * field.pitch_x, where, "period_um", period,
               "at least two points of the facets' grid");
    require_um(profile == Profile::triangular || (line_width >= flank && line_width + flank <= period), where,
               "line_width_um", line_width, "at least a flank's width, and with it at most the period");
    for (int column = 0; column < field.heights.columns; ++column) {
        const double x = field.x_min + column * field.pitch_x;
        const double from_line = std::abs(x - period * std::round(x / period));
        const double share = profile == Profile::triangular
                                 ? 2 * from_line / period
                                 : std::clamp((from_line - 0.5 * line_width) / flank + 0.5, 0.0, 1.0);
        for (int row = 0; row < field.heights.rows; ++row) {
            field.heights(column, row) = static_cast<float>(-depth * share);
        }
    }
}

dimensions::Grating Grating::feature() const {
    return {.frame = {}, .period = period, .depth = depth, .line_width = line_width};
}

} // namespace vkfv::specimen
