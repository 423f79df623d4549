// The tables [objective], [cover_glass], [tube_lens] and [detector]: their keys and readers.
#include "camera/sensors.hpp"
#include "configuration/optical_parts.hpp"
#include "configuration/ranges.hpp"
#include "configuration/tables.hpp"
#include "optics/prescriptions/ideal_lens.hpp"

#include <fmt/format.h>

#include <string>
#include <vector>

namespace vkfv {

namespace {

enum class LensKind { prescription, ideal };
enum class ObjectiveKind { prescription, ideal, telecentric };

constexpr std::int64_t most_pixels = 16384;        // on a side, so that the accumulator stays within 2 GiB
constexpr double default_tube_lens_distance = 100; // mm, in the infinity space
constexpr double usual_tube_length = 200;          // mm
constexpr NumberRange magnification_range = {.minimum = 1e-3, .maximum = 1e4};

const ChoiceKey<LensKind> lens_kind("kind",
                                    {{LensKind::ideal, "ideal", "a lens without aberrations"},
                                     {LensKind::prescription, "prescription", "a lens by its surfaces"}},
                                    LensKind::prescription, "How the lens is described.");
const NumberKey focal_length = of_kinds(
    {"ideal"},
    for_example("20.0", NumberKey("focal_length_mm", NumberRange::positive(), needed, "Focal length in air.")));

const ChoiceKey<ObjectiveKind> objective_kind(
    "kind",
    {{ObjectiveKind::ideal, "ideal", "a lens without aberrations"},
     {ObjectiveKind::prescription, "prescription", "a lens by its surfaces"},
     {ObjectiveKind::telecentric, "telecentric",
      "a lens without aberrations that images by itself, telecentric on both sides: it has no [tube_lens] beside it"}},
    ObjectiveKind::prescription, "How the lens is described.");
const NumberKey objective_focal_length =
    of_kinds({"ideal"}, for_example("20.0", NumberKey("focal_length_mm", NumberRange::positive(),
                                                      Default::in_words("tube_length_mm over magnification"),
                                                      "Focal length in air; or give magnification.")));
const NumberKey magnification =
    of_kinds({"ideal"}, for_example("10.0", NumberKey("magnification", magnification_range,
                                                      Default::in_words("tube_length_mm over focal_length_mm"),
                                                      "Magnification by which the objective is named, with a tube lens "
                                                      "of tube_length_mm; or give focal_length_mm. With another tube "
                                                      "lens the image is larger or smaller.")));
const NumberKey tube_length =
    of_kinds({"ideal"}, NumberKey("tube_length_mm", NumberRange::positive(), usual_tube_length,
                                  "Focal length of the tube lens that the magnification is stated for: often 200 mm, "
                                  "of Olympus 180 mm, of Zeiss 164.5 mm."));
const NumberKey telecentric_magnification =
    of_kinds({"telecentric"}, for_example("2.0", NumberKey("magnification", magnification_range, needed,
                                                           "Size of the image over that of the object.")));
const NumberKey working_distance =
    of_kinds({"ideal"}, NumberKey("working_distance_mm", NumberRange::positive(), Default::in_words("the focal length"),
                                  "From the plane of focus to the objective's front. Light does not depend on it."));
const NumberKey telecentric_working_distance =
    of_kinds({"telecentric"}, for_example("65.0", NumberKey("working_distance_mm", NumberRange::positive(), needed,
                                                            "From the plane of focus to the lens's front.")));
const NumberKey parfocal_length =
    of_kinds({"ideal"}, NumberKey("parfocal_length_mm", NumberRange::positive(),
                                  Default::in_words("the back focal plane takes the shoulder's place"),
                                  "From the plane of focus to the objective's shoulder, from where then "
                                  "tube_lens.distance_mm counts: often 45, 60 or 95 mm."));
const TextKey objective_prescription = of_kinds(
    {"prescription"}, for_example("\"10x_0.28\"", TextKey("prescription", Default::none(),
                                                          "Prescription from the specimen to the back: a name in "
                                                          "assets/objectives, or a path.")));
const NumberKey numerical_aperture = of_kinds(
    {"ideal", "telecentric"}, for_example("0.3", NumberKey("numerical_aperture", NumberRange::positive(), needed,
                                                           "Of the cone from the specimen, below the index "
                                                           "there.")));
const NumberKey
    magnification_rate("magnification_per_um", NumberRange::within(-0.01, 0.01), Default::in_words("0"),
                       "Share by which the magnification grows when the focal plane rises by 1 um, on top of what the "
                       "lenses do; at z = 0 it is theirs.");
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
const NumberKey
    tube_distance("distance_mm", NumberRange::at_least(0), default_tube_lens_distance,
                  "From the objective's back vertex, or its shoulder where it has a parfocal length, to the tube "
                  "lens's first.");

const NumberKey detector_size =
    for_example("1.28", NumberKey("size_mm", NumberRange::positive(), needed,
                                  "Width of the detector, in its own plane, where neither pixel_um, camera nor format "
                                  "is given; its height follows, as pixels are square."));
const NumberKey pixel_pitch("pixel_um", NumberRange::positive(),
                            Default::in_words("the camera's, or size_mm over its columns"),
                            "Side of a pixel, in the detector's plane, in place of size_mm.");

const NumberKey assumed_pitch("assumed_pitch_um", NumberRange::positive(),
                              Default::in_words("the true one, by the lenses"),
                              "Side of a pixel on the specimen, as the instrument believes it to be: the pitch of the "
                              "heights, whose lateral amplification is its ratio to the true one.");

const NumberKey
    distortion("distortion", NumberRange::within(-10, 10), Default::in_words("that of the lenses alone"),
               "Radial distortion in percent at distortion_field_mm, on top of that of the lenses: positive "
               "moves the image outwards (pincushion), as the third power of the distance from the axis.");
const NumberKey distortion_field("distortion_field_mm", NumberRange::positive(),
                                 Default::in_words("needed with distortion"),
                                 "Distance from the axis, on the specimen, at which distortion is stated.");
const NumberKey shear("shear_deg", NumberRange::within(-10, 10), Default::in_words("0"),
                      "Degrees by which the angle from the detector's rows to its columns exceeds a right one.");

std::vector<ChoiceKey<const camera::Sensor*>::Option> camera_options() {
    std::vector<ChoiceKey<const camera::Sensor*>::Option> options;
    for (const auto& sensor : camera::sensors()) {
        options.push_back({&sensor, std::string(sensor.name),
                           fmt::format("{} x {} pixels of {} um", sensor.columns, sensor.rows, sensor.pixel_um)});
    }
    return options;
}
const ChoiceKey<const camera::Sensor*> detector_camera = with_default(
    Default::in_words("none: its pixels are given"),
    ChoiceKey<const camera::Sensor*>("camera", camera_options(), {},
                                     "The camera, by its sensor: pixel_um and pixels are its own where they are not "
                                     "given. [camera] tells its noise."));

std::vector<ChoiceKey<const camera::SensorFormat*>::Option> format_options() {
    std::vector<ChoiceKey<const camera::SensorFormat*>::Option> options;
    for (const auto& format : camera::sensor_formats()) {
        options.push_back(
            {&format, std::string(format.name), fmt::format("{} mm x {} mm", format.width, format.height)});
    }
    return options;
}
const ChoiceKey<const camera::SensorFormat*> detector_format =
    with_default(Default::in_words("none: its size is given"),
                 ChoiceKey<const camera::SensorFormat*>(
                     "format", format_options(), {},
                     "Optical format in inches, which stands for size_mm: the width of such a chip."));
const NumberKey fill_factor("fill_factor", NumberRange::share(), 1.0,
                            "Share of a pixel's area that is sensitive: a square in its middle. A camera's quantum "
                            "efficiency by EMVA 1288 contains it.");
const IntegerPairKey detector_pixels = for_example(
    "64", IntegerPairKey("pixels", 1, most_pixels,
                         "Columns and rows; one number: both. With camera they may be left out, and are all "
                         "that it has."));

} // namespace

const KeyTable& objective_keys() {
    static const KeyTable table{
        .path = "objective",
        .presence = KeyTable::Presence::needed,
        .meaning = "The objective.",
        .subject = "an objective",
        .kind = "kind",
        .keys = with_placement({&objective_kind, &immersion, &objective_prescription, &aperture_stop,
                                &objective_focal_length, &magnification, &telecentric_magnification, &tube_length,
                                &numerical_aperture, &working_distance, &telecentric_working_distance, &parfocal_length,
                                &magnification_rate})};
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
                                .presence = KeyTable::Presence::optional,
                                .meaning = "The tube lens, behind the beam splitter. Required, unless the objective is "
                                           "telecentric.",
                                .subject = "a tube lens",
                                .kind = "kind",
                                .keys = with_placement({&lens_kind, &tube_prescription, &focal_length, &tube_distance}),
                                .shown = true};
    return table;
}

const KeyTable& detector_keys() {
    static const KeyTable table{
        .path = "detector",
        .presence = KeyTable::Presence::needed,
        .meaning = "The camera's chip, in the plane where the specimen's best focus is imaged.",
        .subject = "a detector",
        .kind = "",
        .keys = with_placement({&detector_camera, &detector_format, &detector_size, &pixel_pitch, &detector_pixels,
                                &fill_factor, &assumed_pitch, &distortion, &distortion_field, &shear})};
    return table;
}

namespace {

// The focal length (mm), as given or as tube length over magnification.
double read_objective_focal_length(const Section& section) {
    if (!section.has(magnification)) {
        if (section.has(tube_length)) {
            section.note(tube_length, "a magnification beside it, which it is the tube length of",
                         "Give magnification in place of focal_length_mm, or remove it.");
        }
        return section.number(objective_focal_length);
    }
    if (section.has(objective_focal_length)) {
        section.note(magnification, "either focal_length_mm or magnification", "Remove one of them.");
    }
    const double named = section.number(magnification);
    return section.number(tube_length) / named;
}

optics::Prescription read_ideal_objective(const Section& section, Configuration& configuration) {
    const double length = read_objective_focal_length(section);
    auto objective = optics::ideal_objective(length, section.number(numerical_aperture));
    const auto& medium = configuration.instrument.immersion.value_or(optics::Medium::air());
    const double index = medium.index(configuration.instrument.spectrum.reference_um);
    if (const auto distance = section.number_if_given(working_distance)) {
        objective = optics::with_front(std::move(objective), *distance, medium, index);
    }
    if (const auto distance = section.number_if_given(parfocal_length)) {
        configuration.shoulder = *distance - (index * length + length); // from the back focal plane
    }
    return objective;
}

// A telecentric lens: an ideal lens, a stop in its back focal plane, and a second lens as far behind the stop as its
// focal length.
void read_telecentric_lens(const Section& section, optics::InstrumentDescription& instrument) {
    const double times = section.number(telecentric_magnification);
    const double aperture = section.number(numerical_aperture);
    const double front = section.number(telecentric_working_distance);
    instrument.objective = optics::ideal_objective(front, aperture);
    instrument.tube_lens = optics::ideal_lens(times * front);
    instrument.objective_to_tube_lens = times * front;
}

} // namespace

void read_objective(const TomlTable& root, Configuration& configuration) {
    auto& instrument = configuration.instrument;
    const Section section(root.table("objective"), objective_keys(), configuration);
    const ObjectiveKind kind = section.kind(objective_kind);
    if (section.has(immersion)) {
        instrument.immersion = read_glass(section, immersion, configuration);
    }
    switch (kind) {
    case ObjectiveKind::ideal:
        instrument.objective = read_ideal_objective(section, configuration);
        break;
    case ObjectiveKind::telecentric:
        read_telecentric_lens(section, instrument);
        break;
    case ObjectiveKind::prescription:
        instrument.objective = read_prescription(section, objective_prescription, configuration, "objectives");
        instrument.aperture_stop_radius = section.number_if_given(aperture_stop);
        break;
    }
    instrument.image.magnification_rate = section.number_if_given(magnification_rate).value_or(0) / mm_per_um;
    instrument.objective_placement = read_placement(section);
}

void read_tube_lens(const TomlTable& root, Configuration& configuration) {
    auto& instrument = configuration.instrument;
    if (!instrument.tube_lens.surfaces.empty()) { // a telecentric objective has set its second lens
        if (root.has("tube_lens")) {
            root.fail("tube_lens", "no [tube_lens] with objective.kind = \"telecentric\", which images by itself",
                      "Remove it, or make the objective an ideal one.");
        }
        return;
    }
    const Section section(root.table("tube_lens"), tube_lens_keys(), configuration);
    instrument.tube_lens = section.kind(lens_kind) == LensKind::ideal
                               ? optics::ideal_lens(section.number(focal_length))
                               : read_prescription(section, tube_prescription, configuration, "tube_lenses");
    const double distance = section.number(tube_distance);
    if (distance + configuration.shoulder < 0) {
        section.fail(tube_distance,
                     fmt::format("at least {:.6g}, as the objective's back focal plane lies so far behind its shoulder",
                                 -configuration.shoulder),
                     "Move the tube lens farther from the shoulder, or correct objective.parfocal_length_mm.");
    }
    instrument.objective_to_tube_lens = distance + configuration.shoulder;
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

namespace {

// The number of a camera's pixels may be given too, as for binning, but the size of its detector follows from the
// camera.
void refuse_two_sizes(const Section& section) {
    if (section.has(pixel_pitch) && section.has(detector_size)) {
        section.fail(pixel_pitch, "either size_mm or pixel_um", "Remove one of them.");
    }
    for (const Key* other : {static_cast<const Key*>(&detector_size), static_cast<const Key*>(&detector_format)}) {
        if (section.has(detector_camera) && section.has(*other)) {
            section.fail(detector_camera, fmt::format("either {} or camera", other->name), "Remove one of them.");
        }
    }
    for (const Key* other : {&detector_size, &pixel_pitch}) {
        if (section.has(detector_format) && section.has(*other)) {
            section.fail(detector_format, fmt::format("either {} or format", other->name), "Remove one of them.");
        }
    }
}

} // namespace

void read_detector(const TomlTable& root, Configuration& configuration) {
    auto& instrument = configuration.instrument;
    const Section section(root.table("detector"), detector_keys(), configuration);
    const camera::Sensor* const sensor =
        section.has(detector_camera) ? section.choice(detector_camera) : static_cast<const camera::Sensor*>(nullptr);
    if (sensor != nullptr && !section.has(detector_pixels)) {
        section.record(detector_pixels, fmt::format("[{}, {}]", sensor->columns, sensor->rows));
        instrument.detector_pixels = {sensor->columns, sensor->rows};
    } else {
        const auto pixels = section.integer_pair(detector_pixels);
        instrument.detector_pixels = {static_cast<int>(pixels[0]), static_cast<int>(pixels[1])};
    }
    refuse_two_sizes(section);
    if (section.has(pixel_pitch) || sensor != nullptr) {
        constexpr double harmless = 1; // keeps the reader going where no value could be read
        const double pitch = sensor != nullptr ? section.number(pixel_pitch, sensor->pixel_um)
                                               : section.number_if_given(pixel_pitch).value_or(harmless);
        instrument.detector_width = pitch * mm_per_um * instrument.detector_pixels.columns;
    } else if (section.has(detector_format)) {
        instrument.detector_width = section.choice(detector_format)->width;
    } else {
        instrument.detector_width = section.number(detector_size);
    }
    instrument.fill_factor = section.number(fill_factor);
    if (const auto pitch = section.number_if_given(assumed_pitch)) {
        configuration.assumed_pitch = *pitch * mm_per_um;
    }
    const bool distorts = section.has(distortion);
    if (distorts != section.has(distortion_field)) {
        section.fail(distorts ? distortion : distortion_field, "both distortion and distortion_field_mm, or neither",
                     fmt::format("Add {} to [detector].", distorts ? distortion_field.name : distortion.name));
    } else {
        instrument.image.distortion = 0.01 * section.number_if_given(distortion).value_or(0);
        instrument.image.field_height = section.number_if_given(distortion_field).value_or(1);
    }
    instrument.image.shear = section.number_if_given(shear).value_or(0) * radians_per_degree;
    instrument.detector_placement = read_placement(section);
}

} // namespace vkfv
