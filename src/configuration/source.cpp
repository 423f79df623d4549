// The tables [source] or [[source]], and [source.spectrum]: their keys and readers.
#include "configuration/ranges.hpp"
#include "configuration/tables.hpp"
#include "core/files/digest.hpp"
#include "core/parsing/number_table.hpp"
#include "optics/media/light_emitting_diodes.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <span>
#include <string>
#include <vector>

namespace vkfv {

namespace {

enum class SourceKind { disc, rectangle, ring };
enum class SpectrumKind { monochromatic, lines, gaussian, led, table };

constexpr double least_flux = 1e-15, largest_flux = 1e15; // W; the light of a pixel stays within a float32

const ChoiceKey<SourceKind> kind("kind",
                                 {{SourceKind::disc, "disc", "a Lambertian disc behind an illuminator"},
                                  {SourceKind::rectangle, "rectangle", "a Lambertian rectangle there: an LED's die"},
                                  {SourceKind::ring, "ring", "a ring light around the objective"}},
                                 SourceKind::disc, "What shines.");
const NumberKey flux("flux_W", NumberRange::within(least_flux, largest_flux), 1.0,
                     "Radiant flux that the source sends into its half space.");
const NumberKey radius = of_kinds(
    {"disc"}, for_example("5.0", NumberKey("radius_mm", NumberRange::positive(), needed, "Radius of the disc.")));
const NumberKey die_width =
    of_kinds({"rectangle"}, for_example("1.9", NumberKey("width_mm", NumberRange::positive(), needed,
                                                         "Width of the rectangle, along x of the specimen where no "
                                                         "mirror turns it.")));
const NumberKey die_height =
    of_kinds({"rectangle"},
             for_example("1.9", NumberKey("height_mm", NumberRange::positive(), needed, "Height of the rectangle.")));
const NumberKey illuminator_distance = of_kinds(
    {"disc", "rectangle"}, NumberKey("distance_mm", NumberRange::positive(), Default::in_words("the prescription's"),
                                     "From disc or rectangle to the illuminator's first vertex."));
const NumberKey ring_distance = of_kinds(
    {"ring"}, for_example("30.0", NumberKey("distance_mm", NumberRange::positive(), needed,
                                            "From the ring's middle line to the focus on the axis; or give the "
                                            "ring's diameters.")));
const NumberKey elevation = of_kinds(
    {"ring"}, for_example("45.0", NumberKey("elevation_deg", NumberRange::between(0, 90), needed,
                                            "Height of the light over the horizon, seen from the focus; with the "
                                            "diameters this or working_distance_mm.")));
const NumberKey width = of_kinds(
    {"ring"},
    for_example("5.0", NumberKey("width_mm", NumberRange::positive(), needed,
                                 "Width of the luminous band, at right angles to the direction from the focus; or "
                                 "give the ring's diameters.")));
const NumberKey inner_diameter =
    of_kinds({"ring"}, NumberKey("inner_diameter_mm", NumberRange::positive(),
                                 Default::in_words("distance_mm and width_mm are given"),
                                 "Inner diameter of the ring's luminous face, as its data sheet states it: a flat ring "
                                 "about the axis, in place of distance_mm and width_mm."));
const NumberKey outer_diameter =
    of_kinds({"ring"}, NumberKey("outer_diameter_mm", NumberRange::positive(),
                                 Default::in_words("distance_mm and width_mm are given"), "Outer diameter of it."));
const NumberKey ring_working_distance = of_kinds(
    {"ring"}, NumberKey("working_distance_mm", NumberRange::positive(), Default::in_words("as elevation_deg says"),
                        "With the diameters: height of the ring's face over the plane of focus, in place of "
                        "elevation_deg."));
const IntegerKey segments = of_kinds(
    {"ring"}, IntegerKey("segments", 1, physics::f64::RING_CAPACITY, 1, "Parts of equal angle, from +x towards +y."));
const NumberKey fill =
    of_kinds({"ring"}, NumberKey("fill", share_range, 1.0, "Share of a segment's angle that shines."));
const BooleansKey on =
    of_kinds({"ring"}, BooleansKey("on", Default::in_words("all"), "Which segments shine, one truth value each."));
const NumberKey wavelength("wavelength_um", wavelength_range_um, 0.5876,
                           "Wavelength in vacuum of monochromatic light; else see [source.spectrum].");

const ChoiceKey<SpectrumKind>
    spectrum_kind("kind",
                  {{SpectrumKind::gaussian, "gaussian",
                    fmt::format("a bell, cut off at {} standard deviations", optics::gaussian_reach)},
                   {SpectrumKind::led, "led", "a light-emitting diode, by its colour or by peak and width: a bell"},
                   {SpectrumKind::lines, "lines", "several lines"},
                   {SpectrumKind::monochromatic, "monochromatic", "one line"},
                   {SpectrumKind::table, "table", "a density by points, linear between them"}},
                  {}, "The spectrum's form.");
const NumberKey line =
    of_kinds({"monochromatic"}, NumberKey("wavelength_um", wavelength_range_um, needed, "Wavelength in vacuum."));
const NumbersKey wavelengths =
    of_kinds({"lines", "table"}, NumbersKey("wavelengths_um", wavelength_range_um, Default::none(),
                                            "Wavelengths in vacuum, ascending in a table."));
const NumbersKey weights = of_kinds({"lines"}, NumbersKey("weights", NumberRange::at_least(0), Default::none(),
                                                          "Flux of each line relative to the others."));
const NumberKey centre =
    of_kinds({"gaussian"}, NumberKey("centre_um", wavelength_range_um, needed, "Wavelength of the bell's maximum."));
const NumberKey full_width =
    of_kinds({"gaussian"}, NumberKey("full_width_um", NumberRange::positive(), needed,
                                     "Full width at half maximum, below the centre's wavelength."));
std::vector<ChoiceKey<const optics::LedColour*>::Option> colour_options() {
    constexpr double nm_per_um = 1e3;
    std::vector<ChoiceKey<const optics::LedColour*>::Option> options;
    for (const auto& colour : optics::led_colours()) {
        options.push_back({&colour, std::string(colour.name),
                           colour.full_width_um > 0
                               ? fmt::format("{:.4g} nm, {:.4g} nm wide", nm_per_um * colour.peak_um,
                                             nm_per_um * colour.full_width_um)
                               : fmt::format("blue of {:.4g} nm on phosphor", nm_per_um * colour.peak_um)});
    }
    return options;
}
const ChoiceKey<const optics::LedColour*> colour =
    with_default(Default::in_words("none: peak_um and full_width_um are given"),
                 of_kinds({"led"}, ChoiceKey<const optics::LedColour*>("colour", colour_options(), {},
                                                                       "Its colour, with typical values of peak_um and "
                                                                       "full_width_um where they are not given.")));
const Default of_colour = Default::in_words("the colour's; must be given without one");
const NumberKey led_peak =
    of_kinds({"led"}, NumberKey("peak_um", wavelength_range_um, of_colour, "Wavelength of its largest flux."));
const NumberKey led_width = of_kinds({"led"}, NumberKey("full_width_um", NumberRange::positive(), of_colour,
                                                        "Full width of its spectrum at half maximum, below the "
                                                        "peak's wavelength."));
const NumbersKey densities =
    of_kinds({"table"}, NumbersKey("densities", NumberRange::at_least(0), Default::none(),
                                   "Flux per wavelength at each wavelength, relative to the others."));
const FileKey spectrum_file =
    of_kinds({"table"}, FileKey("file", Default::in_words("the table in the configuration"),
                                "CSV file of wavelength_um,density, instead of a table in the configuration."));

optics::Spectrum read_led(const Section& section) {
    const optics::LedColour* const named =
        section.has(colour) ? section.choice(colour) : static_cast<const optics::LedColour*>(nullptr);
    if (named != nullptr && !(named->full_width_um > 0)) {
        for (const NumberKey* key : {&led_peak, &led_width}) {
            if (section.has(*key)) {
                section.note(*key,
                             fmt::format("no such key with colour = \"{}\", whose spectrum is no bell", named->name),
                             "Remove it, or the colour.");
            }
        }
        return optics::spectrum_of(*named);
    }
    const double peak = named != nullptr ? section.number(led_peak, named->peak_um) : section.number(led_peak);
    const double width = named != nullptr ? section.number(led_width, named->full_width_um) : section.number(led_width);
    if (!(width < peak)) { // also finds nanometres given as micrometres
        section.fail(led_width, fmt::format("a width below the peak's wavelength, {:.6g} um", peak),
                     "Give both in um: 0.035 for 35 nm.");
    }
    return optics::Spectrum::gaussian(peak, width);
}

optics::Spectrum read_spectrum_file(const Section& section) {
    const TomlTable& table = section.table();
    const auto file = looked_for(table.file_path(spectrum_file.name));
    Digest digest;
    std::vector<double> points;
    std::vector<double> values;
    as_named(table, spectrum_file.name, file, [&] {
        for (const auto& point :
             read_number_table(file, {"wavelength_um", "density"}, table.path() + ".file", "point")) {
            digest.add_values(std::span<const double>(point.values));
            points.push_back(point.values[0]);
            values.push_back(point.values[1]);
            if (!wavelength_range_um.contains(point.values[0])) {
                throw InputError(
                    {.where = {.file = file, .line = point.line, .column = 1},
                     .key = "wavelength_um",
                     .found = fmt::format("{}", point.values[0]),
                     .expected = "a wavelength " + wavelength_range_um.to_string() + " um",
                     .remedy =
                         remedy_for_length_um(point.values[0], wavelength_range_um).value_or("Correct this field.")});
            }
        }
    });
    section.record_reference(spectrum_file, absolute_path(file).string(), digest.text());
    return optics::Spectrum::table(points, values);
}

optics::Spectrum read_spectrum_table(const Section& section) {
    const TomlTable& table = section.table();
    switch (section.kind(spectrum_kind)) {
    case SpectrumKind::monochromatic:
        return optics::Spectrum::line(section.number(line));
    case SpectrumKind::lines: {
        const auto places = section.numbers(wavelengths);
        return optics::Spectrum::lines(places, section.numbers(weights));
    }
    case SpectrumKind::gaussian: {
        const double middle = section.number(centre);
        // A wider spectrum is not one about its centre. The limit also finds nanometres given as micrometres.
        const NumberRange widths = {.minimum = 0, .maximum = middle, .minimum_included = false};
        return optics::Spectrum::gaussian(
            middle,
            section.number_in(full_width, table.sound(table.path() + ".centre_um") ? widths : full_width.range));
    }
    case SpectrumKind::led:
        return read_led(section);
    case SpectrumKind::table:
        break;
    }
    if (section.has(spectrum_file)) {
        for (const NumbersKey* key : {&wavelengths, &densities}) {
            if (section.has(*key)) {
                section.note(*key, "the spectrum in a file or in the configuration, not both",
                             "Remove one of the two.");
            }
        }
        return read_spectrum_file(section);
    }
    const auto places = section.numbers(wavelengths);
    return optics::Spectrum::table(places, section.numbers(densities));
}

LightOfSource read_spectrum(const Section& source, Configuration& configuration) {
    const auto table = source.table().optional_table("spectrum");
    const std::string& path = source.table().path();
    if (!table) {
        return {path + "." + wavelength.name, optics::Spectrum::line(source.number(wavelength))};
    }
    if (source.has(wavelength)) {
        source.note(wavelength, "a wavelength or [source.spectrum], not both", "Remove one of the two.");
    }
    const Section section(*table, spectrum_keys(), configuration);
    LightOfSource light{table->path(), optics::Spectrum::line(*wavelength.value)};
    source.table().attempt("spectrum", [&] {
        at_its_place(configuration, table->where(), [&] { light.spectrum = read_spectrum_table(section); });
    });
    return light;
}

// Reads a flat ring with the figures of data sheets. Seen from the focus, the ring is taken as a band about its middle
// line, as wide as the ring's foreshortened face. A Lambertian face lights the focus by the solid angle that it covers
// there, in which ring and band differ by the square of the width (0.4 % for a ring of 30 to 34 mm, 3.5 % for a ring of
// 40 to 60 mm).
void read_flat_ring(const Section& source, optics::RingLightDescription& ring) {
    for (const NumberKey* key : {&ring_distance, &width}) {
        if (source.has(*key)) {
            source.note(*key, "either the ring's diameters, or distance_mm and width_mm", "Remove one of both.");
        }
    }
    const double inner = source.number(inner_diameter);
    const double outer = source.number(outer_diameter);
    const double radius = 0.25 * (inner + outer);
    double height = 0;
    if (source.has(ring_working_distance)) {
        if (source.has(elevation)) {
            source.note(elevation, "either working_distance_mm or elevation_deg", "Remove one of them.");
        }
        height = source.number(ring_working_distance);
        ring.elevation = std::atan2(height, radius);
    } else {
        ring.elevation = source.number(elevation) * radians_per_degree;
        height = radius * std::tan(ring.elevation);
    }
    if (source.has(inner_diameter) && source.has(outer_diameter) && !(outer > inner)) {
        source.fail(outer_diameter, fmt::format("more than the inner diameter, {:.6g}", inner),
                    "Exchange them, or correct one.");
    }
    ring.distance = std::hypot(radius, height);
    ring.width = 0.5 * (outer - inner) * std::sin(ring.elevation);
}

optics::RingLightDescription read_ring(const Section& source) {
    optics::RingLightDescription ring;
    if (source.has(inner_diameter) || source.has(outer_diameter) || source.has(ring_working_distance)) {
        read_flat_ring(source, ring);
    } else {
        ring.distance = source.number(ring_distance);
        ring.elevation = source.number(elevation) * radians_per_degree;
        ring.width = source.number(width);
    }
    ring.segments = static_cast<int>(source.integer(segments));
    ring.fill = source.number(fill);
    ring.on = source.booleans(on, std::vector<bool>(static_cast<std::size_t>(ring.segments), true));
    if (ring.on.size() != static_cast<std::size_t>(ring.segments) ||
        std::ranges::find(ring.on, true) == ring.on.end()) {
        source.fail(
            on, fmt::format("{} of true and false, one a segment from +x towards +y, at least one true", ring.segments),
            "Give each segment its state, and switch one on.");
    }
    return ring;
}

struct ReadSource {
    optics::SourceDescription source;
    LightOfSource light;
};

// has_illuminator: a source read before stands behind the illuminator.
ReadSource read_one(const Section& section, bool has_illuminator, Configuration& configuration) {
    optics::SourceDescription source;
    source.key = section.table().path();
    const SourceKind what = section.kind(kind);
    if (what != SourceKind::ring && has_illuminator) {
        section.fail(kind, "\"ring\", as another source stands behind the illuminator already",
                     "Make it a ring light, or leave one of the two out.");
    }
    source.flux = section.number(flux);
    switch (what) {
    case SourceKind::ring:
        source.ring = read_ring(section);
        break;
    case SourceKind::rectangle:
        source.rectangle = glm::dvec2(section.number(die_width), section.number(die_height));
        source.distance = section.number_if_given(illuminator_distance);
        break;
    case SourceKind::disc:
        source.radius = section.number(radius);
        source.distance = section.number_if_given(illuminator_distance);
        break;
    }
    return {source, read_spectrum(section, configuration)};
}

} // namespace

const KeyTable& source_keys() {
    static const KeyTable table{
        .path = "source",
        .presence = KeyTable::Presence::needed,
        .meaning = "The light. Each of several sources stands below a [[source]] of its own: one "
                   "disc or rectangle at most, and ring lights.",
        .subject = "a source",
        .kind = "kind",
        .keys = {&kind, &flux, &radius, &die_width, &die_height, &illuminator_distance, &ring_distance, &elevation,
                 &width, &inner_diameter, &outer_diameter, &ring_working_distance, &segments, &fill, &on, &wavelength},
        .several = true};
    return table;
}

const KeyTable& spectrum_keys() {
    static const KeyTable table{.path = "source.spectrum",
                                .presence = KeyTable::Presence::optional,
                                .meaning = "The light's wavelengths, instead of source.wavelength_um.",
                                .subject = "a spectrum",
                                .kind = "kind",
                                .keys = {&spectrum_kind, &line, &wavelengths, &weights, &centre, &full_width, &colour,
                                         &led_peak, &led_width, &densities, &spectrum_file}};
    return table;
}

std::vector<LightOfSource> read_source(const TomlTable& root, Configuration& configuration) {
    std::vector<ReadSource> read;
    for (const TomlTable& table : root.table_or_tables("source")) {
        root.attempt(table.path(), [&] {
            const bool has_illuminator =
                std::ranges::any_of(read, [](const ReadSource& other) { return !other.source.ring; });
            read.push_back(read_one(Section(table, source_keys(), configuration), has_illuminator, configuration));
        });
    }
    std::vector<LightOfSource> lights;
    if (read.empty()) {
        return lights; // the problems are noted already
    }
    std::vector<optics::Spectrum::Part> parts;
    for (const auto& [source, light] : read) {
        lights.push_back(light);
        parts.push_back({.flux = source.flux, .spectrum = light.spectrum});
    }
    auto& instrument = configuration.instrument;
    instrument.spectrum = optics::Spectrum::mixture(parts);
    for (auto& [source, light] : read) {
        if (!(light.spectrum == instrument.spectrum)) {
            source.spectrum = light.spectrum;
        }
    }
    // The source behind the illuminator comes first.
    std::stable_partition(read.begin(), read.end(), [](const ReadSource& one) { return !one.source.ring; });
    instrument.source = read.front().source;
    for (std::size_t further = 1; further < read.size(); ++further) {
        instrument.further_sources.push_back(read[further].source);
    }
    return lights;
}

} // namespace vkfv
