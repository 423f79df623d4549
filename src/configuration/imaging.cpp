// [objective], [cover_glass], [tube_lens] and [detector].
#include "configuration/optical_parts.hpp"
#include "configuration/ranges.hpp"
#include "configuration/tables.hpp"
#include "optics/prescriptions/ideal_lens.hpp"

namespace vkfv {

namespace {

enum class LensKind { prescription, ideal };

constexpr std::int64_t most_pixels = 16384;        // a side; the accumulator stays within 2 GiB
constexpr double default_tube_lens_distance = 100; // mm, in the infinity space

const ChoiceKey<LensKind> lens_kind("kind",
                                    {{LensKind::ideal, "ideal", "a lens without aberrations"},
                                     {LensKind::prescription, "prescription", "a lens by its surfaces"}},
                                    LensKind::prescription, "How the lens is described.");
const NumberKey focal_length = of_kinds(
    {"ideal"},
    for_example("20.0", NumberKey("focal_length_mm", NumberRange::positive(), needed, "Focal length in air.")));
const TextKey objective_prescription = of_kinds(
    {"prescription"}, for_example("\"10x_0.28\"", TextKey("prescription", Default::none(),
                                                          "Prescription from the specimen to the back: a name in "
                                                          "assets/objectives, or a path.")));
const NumberKey numerical_aperture =
    of_kinds({"ideal"}, for_example("0.3", NumberKey("numerical_aperture", NumberRange::positive(), needed,
                                                     "Of the cone from the specimen, below the index there.")));
const TextKey immersion("immersion", Default::in_words("the prescription's, else air"),
                        "Medium between specimen and objective.");
const NumberKey aperture_stop =
    of_kinds({"prescription"}, NumberKey("aperture_stop_radius_mm", NumberRange::positive(),
                                         Default::in_words("the prescription's"), "Radius of the aperture stop."));

const NumberKey cover_thickness =
    for_example("0.17", NumberKey("thickness_mm", NumberRange::positive(), needed, "Its thickness."));
const TextKey cover_glass("glass", Default::of(std::string("N-BK7")), "Its glass.");
const NumberKey cover_distance("distance_mm", NumberRange::positive(),
                               Default::in_words("close to the objective's front"),
                               "From the plane of focus to the glass's lower side.");

const TextKey tube_prescription = of_kinds(
    {"prescription"}, for_example("\"200mm\"", TextKey("prescription", Default::none(),
                                                       "Prescription from the objective to the detector: a name in "
                                                       "assets/tube_lenses, or a path.")));
const NumberKey tube_distance("distance_mm", NumberRange::at_least(0), default_tube_lens_distance,
                              "From the objective's back vertex to the tube lens's first.");

const NumberKey detector_size =
    for_example("1.28", NumberKey("size_mm", NumberRange::positive(), needed,
                                  "Width of the detector, in its own plane, where pixel_um is not given; its height "
                                  "follows, as pixels are square."));
const NumberKey pixel_pitch("pixel_um", NumberRange::positive(), Default::in_words("size_mm over its columns"),
                            "Side of a pixel, in the detector's plane, in place of size_mm.");
const NumberKey fill_factor("fill_factor", NumberRange::share(), 1.0,
                            "Share of a pixel's area that is sensitive: a square in its middle. A camera's quantum "
                            "efficiency by EMVA 1288 contains it.");
const IntegerPairKey detector_pixels =
    for_example("64", IntegerPairKey("pixels", 1, most_pixels, "Columns and rows; one number: both."));

} // namespace

const KeyTable& objective_keys() {
    static const KeyTable table{.path = "objective",
                                .presence = KeyTable::Presence::needed,
                                .meaning = "The objective.",
                                .subject = "an objective",
                                .kind = "kind",
                                .keys = with_placement({&lens_kind, &immersion, &objective_prescription, &aperture_stop,
                                                        &focal_length, &numerical_aperture})};
    return table;
}

const KeyTable& cover_glass_keys() {
    static const KeyTable table{.path = "cover_glass",
                                .presence = KeyTable::Presence::optional,
                                .meaning = "A plane plate over the specimen.",
                                .subject = "a cover glass",
                                .kind = "",
                                .keys = {&cover_thickness, &cover_glass, &cover_distance}};
    return table;
}

const KeyTable& tube_lens_keys() {
    static const KeyTable table{.path = "tube_lens",
                                .presence = KeyTable::Presence::needed,
                                .meaning = "The tube lens, behind the beam splitter.",
                                .subject = "a tube lens",
                                .kind = "kind",
                                .keys =
                                    with_placement({&lens_kind, &tube_prescription, &focal_length, &tube_distance})};
    return table;
}

const KeyTable& detector_keys() {
    static const KeyTable table{.path = "detector",
                                .presence = KeyTable::Presence::needed,
                                .meaning = "The camera's chip, in the plane where the specimen's best focus is imaged.",
                                .subject = "a detector",
                                .kind = "",
                                .keys = with_placement({&detector_size, &pixel_pitch, &detector_pixels, &fill_factor})};
    return table;
}

void read_objective(const TomlTable& root, Configuration& configuration) {
    auto& instrument = configuration.instrument;
    const Section section(root.table("objective"), objective_keys(), configuration);
    const LensKind kind = section.kind(lens_kind);
    if (section.has(immersion)) {
        instrument.immersion = read_glass(section, immersion, configuration);
    }
    if (kind == LensKind::ideal) {
        const double length = section.number(focal_length);
        instrument.objective = optics::ideal_objective(length, section.number(numerical_aperture));
    } else {
        instrument.objective = read_prescription(section, objective_prescription, configuration, "objectives");
        instrument.aperture_stop_radius = section.number_if_given(aperture_stop);
    }
    instrument.objective_placement = read_placement(section);
}

void read_tube_lens(const TomlTable& root, Configuration& configuration) {
    auto& instrument = configuration.instrument;
    const Section section(root.table("tube_lens"), tube_lens_keys(), configuration);
    instrument.tube_lens = section.kind(lens_kind) == LensKind::ideal
                               ? optics::ideal_lens(section.number(focal_length))
                               : read_prescription(section, tube_prescription, configuration, "tube_lenses");
    instrument.objective_to_tube_lens = section.number(tube_distance);
    instrument.tube_lens_placement = read_placement(section);
}

void read_cover_glass(const TomlTable& root, Configuration& configuration) {
    const auto table = root.optional_table("cover_glass");
    if (!table) {
        return;
    }
    const Section section(*table, cover_glass_keys(), configuration);
    optics::CoverGlass glass;
    glass.thickness = section.number(cover_thickness);
    glass.glass = read_glass(section, cover_glass, configuration);
    glass.distance = section.number_if_given(cover_distance);
    configuration.instrument.cover_glass = glass;
}

void read_detector(const TomlTable& root, Configuration& configuration) {
    auto& instrument = configuration.instrument;
    const Section section(root.table("detector"), detector_keys(), configuration);
    const auto pixels = section.integer_pair(detector_pixels);
    instrument.detector_pixels = {static_cast<int>(pixels[0]), static_cast<int>(pixels[1])};
    if (section.has(pixel_pitch) && section.has(detector_size)) {
        section.fail(pixel_pitch, "either size_mm or pixel_um", "Remove one of them.");
    }
    if (section.has(pixel_pitch)) {
        constexpr double harmless = 1; // where the value is none
        const double pitch = section.number_if_given(pixel_pitch).value_or(harmless);
        instrument.detector_width = pitch * mm_per_um * instrument.detector_pixels.columns;
    } else {
        instrument.detector_width = section.number(detector_size);
    }
    instrument.fill_factor = section.number(fill_factor);
    instrument.detector_placement = read_placement(section);
}

} // namespace vkfv
