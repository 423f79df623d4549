// The tables [topography] and [diffraction]: their keys and readers.
#include "configuration/ranges.hpp"
#include "configuration/tables.hpp"
#include "core/files/digest.hpp"
#include "core/files/file.hpp"
#include "specimen/kinds.hpp"
#include "topography/focus_measure.hpp"
#include "topography/peak_method.hpp"

#include <fmt/format.h>

namespace vkfv {

namespace {

constexpr std::int64_t most_peak_range_steps = 100;
constexpr std::int64_t most_pupil_cells = 32; // 512 images of light
constexpr std::int64_t most_tiles = 9;
constexpr std::int64_t most_parts = 16;

const topography::TopographyOptions defaults;

// A key whose choices are the evaluation's names for the values of an enumeration.
template <class Value>
ChoiceKey<Value> named(std::string name, const std::vector<std::string>& names, Value (*value_of)(std::string_view),
                       Value fallback, std::string meaning) {
    std::vector<typename ChoiceKey<Value>::Option> options;
    for (const auto& each : names) {
        options.push_back({value_of(each), each});
    }
    return without_influence(ChoiceKey<Value>(std::move(name), options, fallback, std::move(meaning)));
}

constexpr int chosen_measure = -1;
std::vector<ChoiceKey<int>::Option> measures() {
    std::vector<ChoiceKey<int>::Option> options = {
        {chosen_measure, "auto",
         "as suits the noise: \"gradient-and-curvature\" for a camera's, \"modified-laplacian\" for images of others "
         "with "
         "next to none; \"wavelet\" for own stacks without a camera and where nothing is averaged along z"}};
    for (const auto& name : topography::focus_measure_names()) {
        options.push_back({static_cast<int>(topography::focus_measure_from_name(name)), name});
    }
    return options;
}
const ChoiceKey<int> focus_measure =
    without_influence(ChoiceKey<int>("focus_measure", measures(), chosen_measure, "What focus is measured by."));
const IntegerKey window = without_influence(
    IntegerKey("window_px", 3, 255, defaults.window_px, "Side of the window around a pixel, an odd number."));
const auto window_shape = named("window_shape", topography::window_shape_names(), topography::window_shape_from_name,
                                defaults.window_shape, "Weights in the window.");
const NumberKey smoothing =
    without_influence(NumberKey("smoothing_steps", NumberRange::within(0, topography::most_smoothing_steps),
                                Default::in_words("as suits the width of the focus curves"),
                                "Standard deviation of the Gaussian average along z, in steps of the scan; 0: none."));
const NumberKey false_peak_rate =
    without_influence(NumberKey("false_peak_rate", NumberRange::share(), defaults.false_peak_rate,
                                "Share of the points that would be measured with the images in random order; 1: no "
                                "limit."));
const NumberKey most_rival = without_influence(NumberKey(
    "most_rival", NumberRange::share(), defaults.most_rival,
    "Prominence of the second maximum, in heights of the largest above the mean, that a measured point has at "
    "most; 1: no limit."));
const auto peak = named("peak", topography::peak_method_names(), topography::peak_method_from_name, defaults.peak,
                        "How the maximum of focus is found.");
const IntegerKey peak_range =
    without_influence(IntegerKey("peak_range_steps", 1, most_peak_range_steps, defaults.peak_range_steps,
                                 "Images on either side of the maximum that its fit takes."));
const NumberKey least_contrast = without_influence(
    NumberKey("least_contrast", NumberRange::at_least(0), defaults.least_contrast,
              "Contrast of the focus curve, in deviations of its noise, that a measured point has at least."));
const NumberKey most_fit_residual = without_influence(
    NumberKey("most_fit_residual", NumberRange::positive(), defaults.most_fit_residual,
              "Distance of the focus curve from a Gaussian, in units of its maximum, that a measured point has at "
              "most."));
const IntegerKey most_peaks = without_influence(IntegerKey(
    "most_peaks", 1, 4, defaults.most_peaks, "Maxima of the focus curve that a measured point has at most; 4: any."));
const ChoiceKey<topography::Registration> registration = without_influence(ChoiceKey<topography::Registration>(
    "registration",
    {{topography::Registration::none, "none", "they are taken as they are"},
     {topography::Registration::shift, "shift", "of a stage that drifts"},
     {topography::Registration::shift_and_scale, "shift-and-scale", "of a lens that breathes, too"}},
    topography::Registration::none, "How images of another instrument are laid over each other first."));
const BooleanKey place_by_texture = without_influence(
    BooleanKey("place_by_texture", defaults.place_by_texture,
               "Whether a height, which is that of the texture in the window, is carried from there to the window's "
               "middle along the surface's slope."));
const BooleanKey repair_outliers = without_influence(
    BooleanKey("repair_outliers", defaults.repair_outliers, "Whether outliers become the median of their neighbours."));
const ChoiceKey<EvaluateOn> evaluate_on = without_influence(
    ChoiceKey<EvaluateOn>("evaluate_on",
                          {{EvaluateOn::automatic, "auto",
                            "on a device that has cores of its own, stacks of files if they have 3e7 pixels or more"},
                           {EvaluateOn::host, "host", "on the processor"},
                           {EvaluateOn::device, "device", "on the device that traces"}},
                          EvaluateOn::automatic, "Where the stack is evaluated, to the same bits."));
const FileKey flatness_file = without_influence(
    FileKey("flatness_file", Default::in_words("\"none\""),
            "Heights of a flat measured by the same instrument, whose field curvature is taken off."));
const ChoiceKey<int> filter = without_influence(
    ChoiceKey<int>("filter",
                   {{0, surface::filter_names[0], "ISO 16610-61"},
                    {1, surface::filter_names[1], "ISO 16610-62, with the natural ends of ISO 16610-22"},
                    {2, surface::filter_names[2], "the same, mirrored at the edges"},
                    {3, surface::filter_names[3], "ISO 16610-71, of degree 0: spikes and holes take no part"}},
                   0, "Which S-filter and L-filter."));
const NumberKey s_filter =
    without_influence(NumberKey("s_filter_um", NumberRange::at_least(0), 0.0,
                                "Nesting index of the S-filter of a second comparison with the truth; 0: none."));
const NumberKey l_filter =
    without_influence(NumberKey("l_filter_um", NumberRange::at_least(0), 0.0,
                                "Nesting index of the L-filter of a second comparison with the truth; 0: none."));

const TextKey form = without_influence(
    TextKey("form",
            Default::in_words(
                "\"truth\" for kinds of specimens with steps, waves, a prism or a sphere; \"plane\" for all others"),
            "Removed before heights and truth are compared and their parameters found: \"none\", \"plane\", "
            "\"polynomial-1\" to "
            "\"polynomial-20\", \"sphere\", or \"truth\": nothing off the truth, and off the measured heights the "
            "plane of their "
            "deviation."));

// Reads the form. If none is given, the specimen's kind chooses it.
surface::Form read_form(const Section& section, const Configuration& configuration) {
    const auto& specimen = configuration.specimen;
    const auto name = section.text_if_given(form);
    if (!name) {
        return specimen ? specimen::usual_form(specimen->shape) : surface::Form();
    }
    const auto parsed = surface::parse_form(*name);
    if (!parsed) {
        section.note(form, "\"none\", \"plane\", \"polynomial-1\" to \"polynomial-20\", \"sphere\" or \"truth\"",
                     "Name one of these, or leave it out.");
        return {};
    }
    if (parsed->kind == surface::Form::Kind::truth && !specimen) {
        section.note(form, "a form of the measured heights alone: without [specimen] there is no truth",
                     "Choose \"plane\", or leave it out.");
    }
    return *parsed;
}

enum class DiffractionModel { none, airy, file, waves };

// The identity needs no model, since only waves have the key `cells`, which the identity has.
const ChoiceKey<DiffractionModel> model = without_influence(ChoiceKey<DiffractionModel>(
    "model",
    {{DiffractionModel::none, "none", "images as rays make them"},
     {DiffractionModel::airy, "airy", "these blurred by the Airy pattern, at every height alike"},
     {DiffractionModel::file, "file", "these blurred by a measured point spread function, at every height alike"},
     {DiffractionModel::waves, "waves", "images as waves make them at each height, by the light of the pupil's cells"}},
    DiffractionModel::waves,
    "What diffraction makes of the images; with trace.mode = \"nonsequential\" the default is \"none\"."));
const ChoiceKey<DiffractionModel> point_spread = without_influence(ChoiceKey<DiffractionModel>(
    "point_spread",
    {{DiffractionModel::none, "none", ""}, {DiffractionModel::airy, "airy", ""}, {DiffractionModel::file, "file", ""}},
    DiffractionModel::none, "The older name of `model`, without waves."));
const FileKey point_spread_file = of_kinds(
    {"file"}, without_influence(FileKey("file", Default::none(), "Image of a measured point spread function.")));
const NumberKey point_spread_pitch =
    of_kinds({"file"}, without_influence(NumberKey("pitch_um", NumberRange::positive(), needed,
                                                   "Distance of that image's pixels in the object.")));
const IntegerKey pupil_cells =
    of_kinds({"waves"}, IntegerKey("cells", 0, most_pupil_cells, 0,
                                   "Cells across the pupil that light is sorted by, an even number; 0: as many as the "
                                   "aberrations on the axis ask for, 8 to 16."));
const IntegerKey parts = of_kinds(
    {"waves"}, IntegerKey("parts_per_pixel", 0, most_parts, 0,
                          "Parts of a pixel's side in which light is sorted; 0: as many as waves of the instrument's "
                          "numerical aperture ask for, or as the device's memory allows."));
const IntegerKey tiles =
    of_kinds({"waves"}, IntegerKey("tiles", 0, most_tiles, 0,
                                   "Filters across the field, an odd number, each of its own point and blended in "
                                   "between; 0: one where the axis' filter is good enough everywhere, else 3 to 9."));
// The memory is not part of an image's identity. Images depend only on the number of parts that it allows, which the
// identity has (trace/interface/tracer_identity.hpp).
const NumberKey most_memory = of_kinds(
    {"waves"}, without_influence(NumberKey("most_memory_gib", NumberRange::at_least(0), 0.0,
                                           "Most device memory for light of waves; 0: four fifths of what there is.")));

} // namespace

const KeyTable& topography_keys() {
    static const KeyTable table{
        .path = "topography",
        .presence = KeyTable::Presence::optional,
        .meaning = "How heights are found in the images.",
        .subject = "a topography",
        .kind = "",
        .keys = {&focus_measure, &window,       &window_shape,     &smoothing,       &false_peak_rate,
                 &most_rival,    &peak,         &peak_range,       &least_contrast,  &most_fit_residual,
                 &most_peaks,    &registration, &place_by_texture, &repair_outliers, &evaluate_on,
                 &flatness_file, &form,         &filter,           &s_filter,        &l_filter}};
    return table;
}

const KeyTable& diffraction_keys() {
    static const KeyTable table{.path = "diffraction",
                                .presence = KeyTable::Presence::optional,
                                .meaning = "Diffraction.",
                                .subject = "",
                                .kind = "model",
                                .keys = {&model, &point_spread, &point_spread_file, &point_spread_pitch, &pupil_cells,
                                         &parts, &tiles, &most_memory}};
    return table;
}

void read_topography(const TomlTable& root, Configuration& configuration, Needs needs) {
    const TomlTable table = root.table_or_empty("topography");
    const Section section(table, topography_keys(), configuration);
    auto& options = configuration.topography;
    const int measure = section.choice(focus_measure);
    options.focus_measure =
        measure == chosen_measure ? std::nullopt : std::optional(static_cast<topography::FocusMeasure>(measure));
    options.window_px = static_cast<int>(section.integer(window));
    if (options.window_px % 2 == 0) {
        section.fail(window, "an odd integer, so that the window has a central pixel",
                     fmt::format("Choose {} or {}.", options.window_px - 1, options.window_px + 1));
    }
    const ImageSize& pixels = configuration.instrument.detector_pixels;
    if (needs == Needs::stack && table.sound("detector") && options.window_px > std::min(pixels.columns, pixels.rows)) {
        section.fail(
            window,
            fmt::format("an integer <= {}, the least of detector.pixels", std::min(pixels.columns, pixels.rows)),
            "Choose a smaller window or more pixels.");
    }
    options.window_shape = section.choice(window_shape);
    options.smoothing_steps = section.number_if_given(smoothing);
    options.false_peak_rate = section.number(false_peak_rate);
    options.most_rival = section.number(most_rival);
    options.peak = section.choice(peak);
    options.peak_range_steps = static_cast<int>(section.integer(peak_range));
    options.least_contrast = section.number(least_contrast);
    options.most_fit_residual = section.number(most_fit_residual);
    options.most_peaks = static_cast<int>(section.integer(most_peaks));
    options.place_by_texture = section.boolean(place_by_texture);
    options.repair_outliers = section.boolean(repair_outliers);
    configuration.registration = section.choice(registration);
    configuration.evaluate_on = section.choice(evaluate_on);
    // The word "none" lets --set remove a flat.
    if (const auto name = table.optional_string(flatness_file.name); name && *name != "none") {
        configuration.flatness_file = section.file(flatness_file);
    }
    configuration.band.form = read_form(section, configuration);
    surface::take_filter(configuration.band, surface::filter_names[static_cast<std::size_t>(section.choice(filter))]);
    configuration.band.s_filter = from_um(section.number(s_filter));
    configuration.band.l_filter = from_um(section.number(l_filter));
}

void read_diffraction(const TomlTable& root, Configuration& configuration) {
    const Section section(root.table_or_empty("diffraction"), diffraction_keys(), configuration);
    if (section.has(model) && section.has(point_spread)) {
        section.fail(point_spread, "no such key beside model, which says the same", "Remove it.");
    }
    if (configuration.trace.nonsequential && !section.has(model) && !section.has(point_spread)) {
        section.record(model, "\"none\"");
        return;
    }
    const DiffractionModel what = section.has(point_spread) ? section.kind(point_spread) : section.kind(model);
    configuration.diffraction.airy = what == DiffractionModel::airy;
    if (what == DiffractionModel::file) {
        configuration.diffraction.file = section.file(point_spread_file);
        configuration.diffraction.pitch = from_um(section.number(point_spread_pitch));
    }
    if (configuration.camera && configuration.diffraction.any()) { // the camera's images contain the blur
        configuration.identity += fmt::format("{} = {}\n", model.name, toml_quoted(model.name_of(what)));
        if (what == DiffractionModel::file) {
            configuration.identity += fmt::format(
                "{} = {}\n{}_digest = \"{}\"\n", point_spread_pitch.name,
                shortest_toml(section.number(point_spread_pitch)), point_spread_file.name,
                Digest().add(read_file(configuration.diffraction.file, {.key = "diffraction.file"})).text());
        }
    }
    if (what == DiffractionModel::waves) {
        optics::WaveOptions& waves = configuration.trace.waves.emplace();
        waves.cells = static_cast<int>(section.integer(pupil_cells));
        waves.parts = static_cast<int>(section.integer(parts));
        waves.tiles = static_cast<int>(section.integer(tiles));
        constexpr double bytes_per_gib = 1 << 30;
        waves.most_memory = static_cast<std::uint64_t>(section.number(most_memory) * bytes_per_gib);
        if (waves.cells % 2 != 0) {
            section.fail(pupil_cells, "an even number, so that every cell has its mirror images",
                         fmt::format("Choose {} or {}.", waves.cells - 1, waves.cells + 1));
        }
        if (waves.tiles != 0 && waves.tiles % 2 == 0) {
            section.fail(tiles, "an odd number, so that one filter is that of the axis, or 0",
                         fmt::format("Choose {} or {}.", waves.tiles - 1, waves.tiles + 1));
        }
        if (configuration.trace.nonsequential) {
            section.fail(
                model, "\"none\", \"airy\" or \"file\" with trace.mode = \"nonsequential\"",
                "Light that finds its own way has no pupil that waves could be sorted by: choose one of these, "
                "or mode = \"sequential\".");
        }
    }
}

} // namespace vkfv
