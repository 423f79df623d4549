#include "app/commands.hpp"
#include "core/messages/safe_text.hpp"
#include "measurement/evaluation/existing_stack.hpp"

#include "core/mathematics/units.hpp"

#include <fmt/format.h>
#include <spdlog/spdlog.h>

#include <cmath>
#include <cstdio>

namespace vkfv::app {

namespace {

// Options for a stack that vkfv did not make; lengths in mm.
struct TopographyOptions {
    std::optional<double> z_step;      // negative: the images descend
    std::optional<double> z_start;     // height of the first image; none: 0
    std::optional<int> channel, frame; // from 1, in files of several
    std::optional<std::filesystem::path> dark, flat_field;
    std::optional<std::uint64_t> shuffle; // seed of the order in which images are taken
};

} // namespace

Command topography_command() {
    const std::vector<Option> of_images = {
        {.name = "--z_step_um,--z-step-um",
         .value = "UM",
         .description = "Step from image to image of a stack without stack.toml; negative: they descend. None: as the "
                        "file states",
         .target = in_mm(&TopographyOptions::z_step)},
        {.name = "--z_start_um,--z-start-um",
         .value = "UM",
         .description = "Height of the first image of a stack without stack.toml",
         .target = in_mm(&TopographyOptions::z_start),
         .fallback = "as the file states, or 0"},
        pitch_option(),
        {.name = "--channel",
         .value = "N",
         .description = "Which of several channels of a file is evaluated, from 1",
         .target = into(&TopographyOptions::channel)},
        {.name = "--frame",
         .value = "N",
         .description = "Which of several times of a file is evaluated, from 1",
         .target = into(&TopographyOptions::frame)},
        {.name = "--dark",
         .value = "FILE",
         .description =
             "Image without light, by the stack's camera, exposure time and gain: taken off each image. Several "
             "pages or a folder: their mean",
         .target = into(&TopographyOptions::dark)},
        {.name = "--flat-field,--flat_field",
         .value = "FILE",
         .description = "Image of an even surface out of focus, likewise: each image is divided by it",
         .target = into(&TopographyOptions::flat_field)},
        {.name = "--shuffle",
         .value = "SEED",
         .description = "Take the images in a random order: a control, which must find nothing",
         .target = into(&TopographyOptions::shuffle)}};
    return {.name = "topography",
            .summary = "Evaluate an existing stack: of vkfv, or images in a folder or a TIFF file",
            .operands = {{"STACK", "Folder of a stack or of images, or a TIFF file of several",
                          into(&CommandOptions::file)}},
            .options = together({configuration_options(), {out_option("Output folder")}, of_images}),
            .run = run_topography,
            .example = "vkfv topography images.tif --z_step_um 0.5 --pitch_um 0.9 --out measured"};
}

namespace {

measurement::EvaluatedStack evaluate_own(const CommandOptions& options) {
    const auto own = options.of<TopographyOptions>();
    const auto pitch = options.of<PixelPitch>().value;
    if (own.z_step || pitch || own.z_start || own.channel || own.frame || own.dark || own.flat_field) {
        refuse_argument(
            "--z_step_um, --pitch_um, --z_start_um, --channel, --frame, --dark or --flat-field with a stack that has a "
            "stack.toml",
            "none of them", "Leave them out: they stand in stack.toml.");
    }
    return measurement::evaluate_own_stack({.folder = options.file,
                                            .overrides = options.overrides,
                                            .destination = options.out.value_or(options.file),
                                            .shuffle = own.shuffle});
}

constexpr double tolerance = 0.01; // largest relative difference of option and file without a warning

// The value of the option, or without one the value that the file states. Where the two differ by more than
// `tolerated`, the option counts and the log warns. Lengths are in mm.
std::optional<double> given_or_stated(const std::string& name, const std::optional<double>& given,
                                      const std::optional<double>& stated, const std::string& by, double tolerated) {
    if (given && stated && std::abs(*given - *stated) > tolerated) {
        spdlog::warn("{} {:g}, but the file states {:g} ({}). The option is used: leave it out to use the file's.",
                     name, *given * um_per_mm, *stated * um_per_mm, by);
    }
    if (!given && stated) {
        spdlog::info("{} {:g} is taken from the file ({})", name, *stated * um_per_mm, by);
    }
    return given ? given : stated;
}

// The pitch (mm) that the file states. The evaluation takes one pitch for both axes, so the pitch of pixels that are
// not square is not used.
std::optional<double> stated_pitch(const scan::StatedSeries& stated) {
    if (!stated.pitch_x || !stated.pitch_y) {
        return std::nullopt;
    }
    if (std::abs(*stated.pitch_x - *stated.pitch_y) > tolerance * *stated.pitch_x) {
        spdlog::warn("The file states pixels of {:g} x {:g} um ({}), which are not square: not used.",
                     *stated.pitch_x * um_per_mm, *stated.pitch_y * um_per_mm, stated.by);
        return std::nullopt;
    }
    return stated.pitch_x;
}

measurement::EvaluatedStack evaluate_foreign(const CommandOptions& options) {
    const auto own = options.of<TopographyOptions>();
    const scan::ImageSeries series(options.file, {.channel = own.channel, .frame = own.frame});
    const auto& stated = series.stated();
    for (const std::string& doubt : stated.doubts) {
        spdlog::warn("{} {}.", options.file.string(), doubt);
    }
    const std::string& z_by = stated.z_by.empty() ? stated.by : stated.z_by;
    const auto step_or_pitch = [](const std::string& name, const std::optional<double>& given,
                                  const std::optional<double>& stated, const std::string& by) {
        return given_or_stated(name, given, stated, by, tolerance * std::abs(stated.value_or(0)));
    };
    const auto z_step = step_or_pitch("--z_step_um", own.z_step, stated.z_step, z_by);
    const auto pitch = step_or_pitch("--pitch_um", options.of<PixelPitch>().value, stated_pitch(stated), stated.by);
    const bool step_good = z_step && std::isfinite(*z_step) && *z_step != 0;
    if (!step_good || !pitch || !std::isfinite(*pitch) || *pitch <= 0) {
        refuse_argument(
            !step_good ? "no --z_step_um, or none that steps" : "no --pitch_um, or none above 0",
            fmt::format("both, for the {} images in {}, which has no stack.toml and does not state them", series.size(),
                        options.file.string()),
            "Give --z_step_um UM, the step from image to image (negative if they descend), and --pitch_um UM > 0, "
            "the distance of the pixels on the specimen.");
    }
    // The tolerance for the start is a share of the step, since a start of 0 has no relative difference.
    const double start =
        given_or_stated("--z_start_um", own.z_start, stated.z_start, z_by, tolerance * std::abs(*z_step)).value_or(0);
    if (!std::isfinite(start)) {
        refuse_argument("--z_start_um " + fmt::format("{}", start), "a height",
                        "Give that of the first image, or leave it out.");
    }
    std::error_code none;
    if (options.out && (std::filesystem::equivalent(*options.out, options.file, none) ||
                        std::filesystem::exists(*options.out / "stack.toml"))) {
        refuse_argument("--out " + options.out->string(), "a folder other than that of any images",
                        "Name another: results would be mixed with the stack that is there.");
    }
    if (!options.out && !own.shuffle) {
        refuse_argument("no --out", "a folder for the results of a stack that vkfv did not make", "Give --out FOLDER.");
    }
    // The overrides are of keys of [topography], which --out is not.
    auto overrides = options.overrides;
    std::erase_if(overrides, [](const TomlOverride& given) { return given.origin == "--out"; });
    return measurement::evaluate_images(series, {.images = options.file,
                                                 .overrides = std::move(overrides),
                                                 .z_step = *z_step,
                                                 .z_start = start,
                                                 .pitch = *pitch,
                                                 .shuffle = own.shuffle,
                                                 .corrections = {.dark = own.dark, .flat_field = own.flat_field}});
}

} // namespace

void run_topography(const CommandOptions& options) {
    const auto shuffle = options.of<TopographyOptions>().shuffle;
    const bool made_here = std::filesystem::exists(options.file / "stack.toml");
    auto stack = made_here ? evaluate_own(options) : evaluate_foreign(options);
    if (shuffle && !options.out) {
        // A shuffled stack is a control, so its heights are not written beside the stack.
        print_text(fmt::format("{}images shuffled, nothing written\n", measurement::summary(stack.evaluation)));
        return;
    }
    const auto destination = options.out.value_or(options.file);
    if (shuffle) {
        stack.origin["shuffle_seed"] = *shuffle;
    }
    ResultFolder results(destination);
    measurement::write_results(results, stack);
    print_text(
        fmt::format("{}results in {}\n", measurement::summary(stack.evaluation), safe_line(destination.string())));
}

} // namespace vkfv::app
