// The tables [illumination], [beam_splitter], [[fold_mirror]] and [interfaces]: their keys and readers.
#include "configuration/optical_parts.hpp"
#include "configuration/ranges.hpp"
#include "configuration/tables.hpp"
#include "optics/prescriptions/ideal_lens.hpp"

#include <fmt/format.h>

namespace vkfv {

namespace {

using SplitterKind = optics::BeamSplitter::Kind;
using MirrorPath = optics::FoldMirror::Path;
using InterfaceModel = optics::Interfaces::Model;

constexpr double default_splitter_reflectance = 0.5;
constexpr double share_rounding = 1e-12; // covers the rounding of 0.7 + 0.3

enum class IlluminatorKind { prescription, ideal };

constexpr double default_field_lens = 150; // mm

const ChoiceKey<IlluminatorKind>
    illuminator_kind("kind",
                     {{IlluminatorKind::ideal, "ideal", "Köhler illumination by two lenses without aberrations"},
                      {IlluminatorKind::prescription, "prescription", "an illuminator by its surfaces"}},
                     IlluminatorKind::prescription, "How the illuminator is described.");
const TextKey illuminator = of_kinds(
    {"prescription"}, TextKey("prescription", Default::of(std::string("koehler")),
                              "Prescription of the illuminator, from the source on: a name in assets/illuminators, or "
                              "a path."));
const NumberKey condenser_focal_length = of_kinds(
    {"ideal"},
    for_example("26.0", NumberKey("condenser_focal_length_mm", NumberRange::positive(), needed,
                                  "Focal length of the condenser. The source, or the aperture stop before it, "
                                  "stands in its front focal plane, the field stop in its back focal plane.")));
const NumberKey field_lens_focal_length =
    of_kinds({"ideal"}, NumberKey("field_lens_focal_length_mm", NumberRange::positive(), default_field_lens,
                                  "Focal length of the field lens, which images the source towards the objective's "
                                  "pupil, as many times larger as its focal length is longer than the condenser's."));
const NumberKey field_stop("field_stop_radius_mm", NumberRange::positive(), Default::in_words("the prescription's"),
                           "Radius of the field stop.");
const NumberKey aperture("aperture_radius_mm", NumberRange::positive(), Default::in_words("the source's edge"),
                         "Radius of an aperture stop at the source.");
const NumberKey
    objective_distance("objective_distance_mm", NumberRange::at_least(0),
                       Default::in_words("where the source is imaged into the objective's pupil"),
                       "From the illuminator's last vertex to the objective's back vertex, along the axis.");

const ChoiceKey<SplitterKind>
    splitter_kind("kind",
                  {{SplitterKind::cube, "cube", "a glass cube"},
                   {SplitterKind::ideal, "ideal", "a surface without thickness, which takes no room"},
                   {SplitterKind::plate, "plate", "a glass plate at 45 degrees"}},
                  SplitterKind::ideal, "What joins illumination and imaging.");
const NumberKey splitter_reflectance("reflectance",
                                     {.minimum = 0, .maximum = 1, .minimum_included = false, .maximum_included = false},
                                     default_splitter_reflectance,
                                     "Share of the illumination that is sent to the specimen; 0 only with ring "
                                     "lights alone.");
const NumberKey splitter_transmittance("transmittance", share_range, Default::in_words("1 - reflectance"),
                                       "Share of the light from the specimen that passes to the detector.");
const TextKey splitter_glass =
    of_kinds({"plate", "cube"}, TextKey("glass", Default::of(std::string("N-BK7")), "Glass of the splitter."));
const NumberKey thickness =
    of_kinds({"plate"},
             for_example("1.0", NumberKey("thickness_mm", NumberRange::positive(), needed, "Thickness of the plate.")));
const NumberKey edge =
    of_kinds({"cube"}, for_example("25.0", NumberKey("edge_mm", NumberRange::positive(), needed, "Edge of the cube.")));
const NumberKey splitter_semi_diameter =
    of_kinds({"plate", "cube"}, NumberKey("semi_diameter_mm", NumberRange::positive(), Default::in_words("unbounded"),
                                          "Half width of the splitter's clear aperture."));
const NumberKey splitter_distance("distance_mm", NumberRange::at_least(0),
                                  Default::in_words("half way to the tube lens"),
                                  "From the objective's back vertex to the splitter.");

const ChoiceKey<MirrorPath> path =
    for_example("\"imaging\"", ChoiceKey<MirrorPath>("path",
                                                     {{MirrorPath::imaging, "imaging", "to the detector"},
                                                      {MirrorPath::illumination, "illumination", "from the source"}},
                                                     {}, "Which way is folded."));
const NumberKey mirror_distance =
    for_example("30.0", NumberKey("distance_mm", NumberRange::at_least(0), needed,
                                  "Behind the objective's back vertex; in the illumination behind the illuminator's "
                                  "last vertex."));
const NumberKey incidence("incidence_deg", NumberRange::between(0, 90), 45.0, "Angle of incidence of the axis.");
const NumberKey azimuth("azimuth_deg", tilt_range_deg, 0.0, "Of the plane of incidence, about the axis.");
const NumberKey mirror_semi_diameter =
    for_example("20.0", NumberKey("semi_diameter_mm", NumberRange::positive(), needed, "Half width of the mirror."));
const NumberKey mirror_reflectance("reflectance", share_range, 1.0, "Share of the light that the mirror keeps.");

const ChoiceKey<InterfaceModel>
    model("model",
          {{InterfaceModel::fresnel, "fresnel", "uncoated, by Fresnel's equations"},
           {InterfaceModel::ideal, "ideal", "nothing is reflected"},
           {InterfaceModel::quarter_wave, "quarter-wave", "coated with one layer of a quarter wave"}},
          InterfaceModel::ideal, "What refracting surfaces reflect.");
const TextKey layer =
    of_kinds({"quarter-wave"}, TextKey("layer", Default::of(std::string("MgF2")), "Material of the layer."));
const NumberKey design_wavelength =
    of_kinds({"quarter-wave"}, NumberKey("design_wavelength_um", wavelength_range_um, 0.55,
                                         "Wavelength of which the layer is a quarter, at normal incidence."));

} // namespace

const KeyTable& illumination_keys() {
    static const KeyTable table{.path = "illumination",
                                .presence = KeyTable::Presence::optional,
                                .meaning = "The illuminator between a disc or rectangle and the beam splitter.",
                                .subject = "an illumination",
                                .kind = "kind",
                                .keys = {&illuminator_kind, &illuminator, &condenser_focal_length,
                                         &field_lens_focal_length, &field_stop, &aperture, &objective_distance}};
    return table;
}

const KeyTable& beam_splitter_keys() {
    static const KeyTable table{.path = "beam_splitter",
                                .presence = KeyTable::Presence::optional,
                                .meaning = "Between objective and tube lens.",
                                .subject = "a beam splitter",
                                .kind = "kind",
                                .keys = {&splitter_kind, &splitter_reflectance, &splitter_transmittance,
                                         &splitter_glass, &thickness, &edge, &splitter_semi_diameter,
                                         &splitter_distance}};
    return table;
}

const KeyTable& fold_mirror_keys() {
    static const KeyTable table{
        .path = "fold_mirror",
        .presence = KeyTable::Presence::repeated,
        .meaning = "Plane mirrors that fold the illumination or the imaging.",
        .subject = "a fold mirror",
        .kind = "",
        .keys = {&path, &mirror_distance, &incidence, &azimuth, &mirror_semi_diameter, &mirror_reflectance}};
    return table;
}

const KeyTable& interfaces_keys() {
    static const KeyTable table{.path = "interfaces",
                                .presence = KeyTable::Presence::optional,
                                .meaning = "Reflection losses at refracting surfaces.",
                                .subject = "interfaces",
                                .kind = "model",
                                .keys = {&model, &layer, &design_wavelength}};
    return table;
}

void read_illumination(const TomlTable& root, Configuration& configuration) {
    auto& instrument = configuration.instrument;
    const bool is_given = root.has("illumination");
    // A source that could not be read may be the one behind this illumination.
    if (instrument.source.ring && (root.sound("source") || !is_given)) {
        if (is_given) {
            root.fail("illumination",
                      "no [illumination] with sources of kind \"ring\" alone, which shine past the objective",
                      "Remove it, or add a source of kind \"disc\" or \"rectangle\".");
        }
        return;
    }
    const Section section(root.table_or_empty("illumination"), illumination_keys(), configuration);
    if (section.kind(illuminator_kind) == IlluminatorKind::ideal) {
        const double condenser = section.number(condenser_focal_length);
        instrument.illumination = optics::ideal_koehler(condenser, section.number(field_lens_focal_length));
    } else {
        instrument.illumination =
            read_prescription(section, illuminator, configuration, "illuminators", illuminator.fallback_text());
    }
    instrument.field_stop_radius = section.number_if_given(field_stop);
    instrument.illumination_aperture_radius = section.number_if_given(aperture);
    instrument.illumination_to_objective = section.number_if_given(objective_distance);
    if (const auto field = root.table_or_empty("illumination").optional_table("field")) {
        configuration.light_field = read_light_field(*field, configuration);
    }
}

void read_beam_splitter(const TomlTable& root, Configuration& configuration) {
    auto& splitter = configuration.instrument.splitter;
    const Section section(root.table_or_empty("beam_splitter"), beam_splitter_keys(), configuration);
    splitter.kind = section.kind(splitter_kind);
    // A ring light does not need the splitter's reflection, so the reflectance may be 0.
    auto reflectances = splitter_reflectance.range;
    reflectances.minimum_included = configuration.instrument.source.ring || !root.sound("source");
    splitter.reflectance = section.number_in(splitter_reflectance, reflectances);
    splitter.transmittance = section.number(splitter_transmittance, 1 - splitter.reflectance);
    if (splitter.reflectance + splitter.transmittance > 1 + share_rounding) {
        section.fail(splitter_transmittance, fmt::format("at most 1 - reflectance = {:.6g}", 1 - splitter.reflectance),
                     "Choose a smaller one; what both leave of 1 is absorbed.");
    }
    if (splitter.kind != SplitterKind::ideal) {
        splitter.glass = read_glass(section, splitter_glass, configuration);
        splitter.size = section.number(splitter.kind == SplitterKind::plate ? thickness : edge);
        splitter.semi_diameter = section.number_if_given(splitter_semi_diameter);
    }
    splitter.distance = section.number_if_given(splitter_distance);
}

void read_fold_mirrors(const TomlTable& root, Configuration& configuration) {
    for (const auto& table : root.optional_tables("fold_mirror")) {
        const Section section(table, fold_mirror_keys(), configuration);
        optics::FoldMirror mirror;
        mirror.path = section.choice(path);
        if (mirror.path == MirrorPath::illumination && configuration.instrument.source.ring) {
            section.fail(path, "\"imaging\", as a ring light has no illumination path", "Remove the mirror.");
        }
        mirror.distance = section.number(mirror_distance);
        mirror.incidence = section.number(incidence) * radians_per_degree;
        mirror.azimuth = section.number(azimuth) * radians_per_degree;
        mirror.semi_diameter = section.number(mirror_semi_diameter);
        mirror.reflectance = section.number(mirror_reflectance);
        configuration.instrument.fold_mirrors.push_back(mirror);
    }
}

void read_interfaces(const TomlTable& root, Configuration& configuration) {
    auto& interfaces = configuration.instrument.interfaces;
    const Section section(root.table_or_empty("interfaces"), interfaces_keys(), configuration);
    interfaces.model = section.kind(model);
    if (interfaces.model == InterfaceModel::quarter_wave) {
        interfaces.layer = read_glass(section, layer, configuration);
        interfaces.design_wavelength_um = section.number(design_wavelength);
    }
}

} // namespace vkfv
