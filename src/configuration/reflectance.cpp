// [specimen.reflectance].
#include "configuration/ranges.hpp"
#include "configuration/tables.hpp"
#include "core/units.hpp"

namespace vkfv {

namespace {

using specimen::Reflectance;
using Kind = Reflectance::Kind;

constexpr int most_cycles = 1024;

struct ReflectanceKeys {
    static std::vector<std::string> patterns() { return {"grating", "checkerboard", "star", "image"}; }

    ChoiceKey<Kind> kind = for_example(
        "\"noise\"", ChoiceKey<Kind>("kind",
                                     {{Kind::grating, "grating", "lines across the pattern's x, bright at its origin"},
                                      {Kind::checkerboard, "checkerboard", "squares, a corner of them at the origin"},
                                      {Kind::star, "star", "a Siemens star about the origin, without an end"},
                                      {Kind::noise, "noise", "a random texture over all of the specimen"},
                                      {Kind::image, "image", "the grey values of an image, mirrored beyond its edge"}},
                                     needed, "How the reflectance varies."));
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
                                 false, "How the reflectance goes from the lowest to the highest."));
    FileKey file = of_kinds(
        {"image"}, for_example("\"texture.png\"", FileKey("file", Default::none(),
                                                          "The image: black is the lowest reflectance, white (of "
                                                          "floats the value 1) the highest.")));
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
                                                      "Factor of the material's reflectance where it is darkest."));
    NumberKey highest = of_kinds(patterns(), NumberKey("highest", NumberRange::within(0, 1), 1.0,
                                                       "The same where it is brightest; at least the lowest."));
    NumberKey x = of_kinds(patterns(), NumberKey("x_um", NumberRange::finite(), 0.0,
                                                 "Where the pattern's origin, or the image's centre, stands."));
    NumberKey y = of_kinds(patterns(), NumberKey("y_um", NumberRange::finite(), 0.0, "Likewise."));
    NumberKey angle = of_kinds(patterns(), NumberKey("angle_deg", tilt_range_deg, 0.0,
                                                     "Of the pattern's x against the specimen's, towards its y."));
    KeyTable table{.path = "specimen.reflectance",
                   .presence = KeyTable::Presence::optional,
                   .meaning = "A map over x and y, for any kind of specimen: factors between 0 and 1 of the material's "
                              "reflectance; what they take is absorbed.",
                   .subject = "a reflectance map",
                   .kind = "kind",
                   .keys = {&kind, &period, &side, &cycles, &profile, &file, &pitch, &correlation_length, &mean,
                            &standard_deviation, &seed, &lowest, &highest, &x, &y, &angle}};
};

const ReflectanceKeys& all_reflectance_keys() {
    static const ReflectanceKeys keys;
    return keys;
}

} // namespace

const KeyTable& reflectance_keys() {
    return all_reflectance_keys().table;
}

specimen::Reflectance read_reflectance(const TomlTable& table, ReadKeys& read) {
    const auto& keys = all_reflectance_keys();
    const Section section(table, keys.table, read);
    Reflectance map;
    map.kind = section.kind(keys.kind);
    switch (map.kind) {
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

} // namespace vkfv
