#include "app/commands.hpp"
#include "measurement/evaluation/existing_stack.hpp"

#include <fmt/format.h>

#include <cmath>
#include <cstdio>

namespace vkfv::app {

namespace {

// Of a stack that vkfv did not make; lengths in mm.
struct TopographyOptions {
    std::optional<double> z_step;         // negative: the images descend
    std::optional<double> z_start;        // of the first image; none: 0
    std::optional<std::uint64_t> shuffle; // seed of the order in which images are taken
};

} // namespace

Command topography_command() {
    const std::vector<Option> of_images = {
        {.name = "--z_step_um,--z-step-um",
         .value = "UM",
         .description = "Step from image to image of a stack without stack.toml; negative: they descend",
         .target = in_mm(&TopographyOptions::z_step)},
        {.name = "--z_start_um,--z-start-um",
         .value = "UM",
         .description = "Height of the first image of a stack without stack.toml",
         .target = in_mm(&TopographyOptions::z_start),
         .fallback = "0"},
        pitch_option(),
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
    if (own.z_step || pitch || own.z_start) {
        refuse_argument("--z_step_um, --pitch_um or --z_start_um with a stack that has a stack.toml", "neither of them",
                        "Leave them out: they stand in stack.toml.");
    }
    return measurement::evaluate_own_stack({.folder = options.file,
                                            .overrides = options.overrides,
                                            .destination = options.out.value_or(options.file),
                                            .shuffle = own.shuffle});
}

// What an instrument's file says of its images, the command line must say.
measurement::EvaluatedStack evaluate_foreign(const CommandOptions& options) {
    const auto own = options.of<TopographyOptions>();
    const auto pitch = options.of<PixelPitch>().value;
    const scan::ImageSeries series(options.file);
    const bool step_good = own.z_step && std::isfinite(*own.z_step) && *own.z_step != 0;
    if (!step_good || !pitch || !std::isfinite(*pitch) || *pitch <= 0) {
        refuse_argument(
            !step_good ? "no --z_step_um, or none that steps" : "no --pitch_um, or none above 0",
            fmt::format("both, for the {} images in {}, which has no stack.toml", series.size(), options.file.string()),
            "Give --z_step_um UM, the step from image to image (negative if they descend), and --pitch_um UM > 0, "
            "the distance of the pixels on the specimen.");
    }
    const double start = own.z_start.value_or(0);
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
    // The keys of [topography] alone; --out is no key of it.
    auto overrides = options.overrides;
    std::erase_if(overrides, [](const TomlOverride& given) { return given.origin == "--out"; });
    return measurement::evaluate_images(series, {.images = options.file,
                                                 .overrides = std::move(overrides),
                                                 .z_step = *own.z_step,
                                                 .z_start = start,
                                                 .pitch = *pitch,
                                                 .shuffle = own.shuffle});
}

} // namespace

void run_topography(const CommandOptions& options) {
    const auto shuffle = options.of<TopographyOptions>().shuffle;
    const bool made_here = std::filesystem::exists(options.file / "stack.toml");
    auto stack = made_here ? evaluate_own(options) : evaluate_foreign(options);
    if (shuffle && !options.out) {
        // A control is no result of the stack.
        fmt::print("{}images shuffled, nothing written\n", measurement::summary(stack.evaluation));
        return;
    }
    const auto destination = options.out.value_or(options.file);
    if (shuffle) {
        stack.origin["shuffle_seed"] = *shuffle;
    }
    ResultFolder results(destination);
    measurement::write_results(results, stack);
    fmt::print("{}results in {}\n", measurement::summary(stack.evaluation), destination.string());
}

} // namespace vkfv::app
