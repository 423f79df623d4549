// The tables [specimen.reflectance] and [illumination.field], which describe patterns over a plane: their keys and
// readers.
#include "configuration/ranges.hpp"
#include "configuration/tables.hpp"
#include "core/mathematics/units.hpp"

namespace vkfv {

namespace {

using specimen::Reflectance;
using Kind = Reflectance::Kind;

constexpr int most_cycles = 1024;

struct PatternKeys {
    static std::vector<std::string> patterns() { return {"grating", "checkerboard", "star", "image"}; }

    static std::vector<ChoiceKey<Kind>::Option> kinds(bool light) {
        std::vector<ChoiceKey<Kind>::Option> all = {
            {Kind::grating, "grating", "lines across the pattern's x, bright at its origin"},
            {Kind::checkerboard, "checkerboard", "squares, a corner of them at the origin"},
            {Kind::star, "star", "a Siemens star about the origin, without an end"},
            {Kind::noise, "noise",
             light ? "a random texture, mirrored beyond 1024 points" : "a random texture over all of the specimen"},
            {Kind::image, "image", "the grey values of an image, mirrored beyond its edge"}};
        if (light) {
            all.insert(all.begin(), {Kind::even, "even", "no pattern: what falloff says alone"});
        }
        return all;
    }

    bool light; // the pattern is of the light's field, not of the specimen
    ChoiceKey<Kind> kind =
        for_example("\"noise\"", ChoiceKey<Kind>("kind", kinds(light), needed,
                                                 light ? "The pattern." : "How the reflectance varies."));
    NumberKey period =
        of_kinds({"grating"},
                 for_example("8.0", NumberKey("period_um", NumberRange::positive(), needed, "Period of the grating.")));
    NumberKey side =
        of_kinds({"checkerboard"},
                 for_example("4.0", NumberKey("side_um", NumberRange::positive(), needed, "Side of a square.")));
    IntegerKey cycles = of_kinds({"star"}, for_example("36", IntegerKey("cycles", 1, most_cycles, needed,
                                                                        "Bright and dark sectors in one turn.")));
    ChoiceKey<bool> profile =
        of_kinds({"grating", "star"},
                 ChoiceKey<bool>("profile", {{false, "sinusoidal", "one frequency"}, {true, "square", "two levels"}},
                                 false, "How it goes from the lowest to the highest."));
    FileKey file = of_kinds(
        {"image"}, for_example("\"texture.png\"", FileKey("file", Default::none(),
                                                          "The image: black is the lowest factor, white (of floats "
                                                          "the value 1) the highest.")));
    NumberKey pitch = of_kinds({"noise", "image"},
                               for_example("0.5", NumberKey("pitch_um", NumberRange::positive(), needed,
                                                            "Distance of neighbouring points of the noise, at most "
                                                            "half its correlation length, or of the image's pixels; "
                                                            "linear in between.")));
    NumberKey correlation_length =
        of_kinds({"noise"}, NumberKey("correlation_length_um", NumberRange::at_least(0), 0.0,
                                      "Distance over which the autocorrelation exp(-(r/l)^2) falls to 1/e; 0: the "
                                      "points are independent."));
    NumberKey mean = of_kinds({"noise"}, NumberKey("mean", NumberRange::within(0, 1), 0.5,
                                                   "Of the factor, before it is clipped to 0 and 1."));
    NumberKey standard_deviation = of_kinds({"noise"}, NumberKey("standard_deviation", NumberRange::within(0, 1), 0.2,
                                                                 "Of the factor, before it is clipped."));
    IntegerKey seed =
        of_kinds({"noise"}, IntegerKey("seed", 0, largest_seed, 1, "Of the random numbers that the noise is made of."));
    NumberKey lowest = of_kinds(patterns(), NumberKey("lowest", NumberRange::within(0, 1), 0.0,
                                                      light ? "Share of the light that passes where it is darkest."
                                                            : "Factor of the material's reflectance where it is "
                                                              "darkest."));
    NumberKey highest = of_kinds(patterns(), NumberKey("highest", NumberRange::within(0, 1), 1.0,
                                                       "The same where it is brightest; at least the lowest."));
    NumberKey x = of_kinds(patterns(), NumberKey("x_um", NumberRange::finite(), 0.0,
                                                 "Where the pattern's origin, or the image's centre, stands."));
    NumberKey y = of_kinds(patterns(), NumberKey("y_um", NumberRange::finite(), 0.0, "Likewise."));
    NumberKey angle = of_kinds(patterns(), NumberKey("angle_deg", tilt_range_deg, 0.0,
                                                     light ? "Of the pattern's x against that of the plane, towards "
                                                             "its y."
                                                           : "Of the pattern's x against the specimen's, towards its "
                                                             "y."));
    NumberKey falloff{"falloff", NumberRange::within(0, 1), 0.0,
                      "Share of the light that is missing at falloff_radius_mm from the brightest place; it grows with "
                      "the square of the distance."};
    NumberKey falloff_radius{"falloff_radius_mm", NumberRange::positive(), Default::in_words("needed with falloff"),
                             "Distance at which falloff holds."};
    NumberKey brightest_x{"brightest_x_mm", NumberRange::finite(), 0.0, "Where the light is brightest."};
    NumberKey brightest_y{"brightest_y_mm", NumberRange::finite(), 0.0, "Likewise."};
    KeyTable table{.path = light ? "illumination.field" : "specimen.reflectance",
                   .presence = KeyTable::Presence::optional,
                   .meaning = light
                                  ? "What the plane of the field stop lets through: a pattern, which the lenses image "
                                    "onto the specimen, so that smooth surfaces are measured too, and uneven light. "
                                    "Lengths are of that plane; `vkfv check` tells its magnification."
                                  : "A map over x and y, for any kind of specimen: factors between 0 and 1 of the "
                                    "material's reflectance; what they take is absorbed.",
                   .subject = light ? "a field of light" : "a reflectance map",
                   .kind = "kind",
                   .keys = {&kind, &period, &side, &cycles, &profile, &file, &pitch, &correlation_length, &mean,
                            &standard_deviation, &seed, &lowest, &highest, &x, &y, &angle}};

    explicit PatternKeys(bool of_light) : light(of_light) {
        if (light) {
            table.keys.insert(table.keys.end(), {&falloff, &falloff_radius, &brightest_x, &brightest_y});
        }
    }
};

const PatternKeys& all_reflectance_keys() {
    static const PatternKeys keys(false);
    return keys;
}

const PatternKeys& all_light_field_keys() {
    static const PatternKeys keys(true);
    return keys;
}

Reflectance read_pattern(const Section& section, const PatternKeys& keys) {
    Reflectance map;
    map.kind = section.kind(keys.kind);
    switch (map.kind) {
    case Kind::even:
        return map;
    case Kind::grating:
        map.period = from_um(section.number(keys.period));
        map.square = section.choice(keys.profile);
        break;
    case Kind::checkerboard:
        map.side = from_um(section.number(keys.side));
        break;
    case Kind::star:
        map.cycles = static_cast<int>(section.integer(keys.cycles));
        map.square = section.choice(keys.profile);
        break;
    case Kind::noise:
        map.pitch = from_um(section.number(keys.pitch));
        map.correlation_length = from_um(section.number(keys.correlation_length));
        map.mean = section.number(keys.mean);
        map.standard_deviation = section.number(keys.standard_deviation);
        map.seed = static_cast<std::uint32_t>(section.integer(keys.seed));
        return map;
    case Kind::image:
        map.file = section.file(keys.file);
        map.pitch = from_um(section.number(keys.pitch));
        break;
    }
    map.lowest = section.number(keys.lowest);
    map.highest = section.number(keys.highest);
    map.x = from_um(section.number(keys.x));
    map.y = from_um(section.number(keys.y));
    map.angle = section.number(keys.angle) * radians_per_degree;
    return map;
}

} // namespace

const KeyTable& reflectance_keys() {
    return all_reflectance_keys().table;
}

const KeyTable& light_field_keys() {
    return all_light_field_keys().table;
}

specimen::Reflectance read_reflectance(const TomlTable& table, ReadKeys& read) {
    const Section section(table, reflectance_keys(), read);
    return read_pattern(section, all_reflectance_keys());
}

LightFieldDescription read_light_field(const TomlTable& table, ReadKeys& read) {
    const auto& keys = all_light_field_keys();
    const Section section(table, keys.table, read);
    LightFieldDescription field;
    field.pattern = read_pattern(section, keys);
    const double falloff = section.number(keys.falloff);
    const auto radius_mm = section.number_if_given(keys.falloff_radius);
    if (falloff > 0 && !radius_mm) {
        section.fail(keys.falloff_radius, "the distance at which falloff holds", "Give it, or remove falloff.");
    }
    field.falloff = falloff > 0 ? falloff / (*radius_mm * *radius_mm) : 0;
    field.brightest = {section.number(keys.brightest_x), section.number(keys.brightest_y)};
    return field;
}

} // namespace vkfv
