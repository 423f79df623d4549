#include "app/commands.hpp"
#include "measurement/assembly.hpp"
#include "measurement/evaluation.hpp"
#include "scan/image_series.hpp"

#include "core/units.hpp"
#include "scan/store.hpp"

#include <fmt/format.h>
#include <nlohmann/json.hpp>
#include <spdlog/spdlog.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <numeric>
#include <random>
#include <sstream>

namespace vkfv::app {

Command topography_command() {
    const std::vector<Option> of_images = {
        {.name = "--z_step_um,--z-step-um",
         .value = "UM",
         .description = "Step from image to image of a stack without stack.toml; negative: they descend",
         .target = in_mm(&CommandOptions::z_step)},
        {.name = "--z_start_um,--z-start-um",
         .value = "UM",
         .description = "Height of the first image of a stack without stack.toml",
         .target = in_mm(&CommandOptions::z_start),
         .fallback = "0"},
        pitch_option(),
        {.name = "--shuffle",
         .value = "SEED",
         .description = "Take the images in a random order: a control, which must find nothing",
         .target = &CommandOptions::shuffle}};
    return {.name = "topography",
            .summary = "Evaluate an existing stack: of vkfv, or images in a folder or a TIFF file",
            .operands = {{"STACK", "Folder of a stack or of images, or a TIFF file of several", &CommandOptions::file}},
            .options = together({configuration_options(), {out_option("Output folder")}, of_images}),
            .run = run_topography,
            .example = "vkfv topography images.tif --z_step_um 0.5 --pitch_um 0.9 --out measured"};
}

namespace {

// The images' numbers, in their order or in a random one: Fisher and Yates's shuffle, by the bits of the
// generator alone, so that a seed means the same order everywhere.
std::vector<int> order_of_images(std::size_t count, const std::optional<std::uint64_t>& shuffle) {
    std::vector<int> order(count);
    std::iota(order.begin(), order.end(), 0);
    if (shuffle) {
        std::mt19937_64 random(*shuffle);
        for (std::size_t last = count; last > 1; --last) {
            std::swap(order[last - 1], order[random() % last]);
        }
    }
    return order;
}

[[noreturn]] void refuse(std::string found, std::string expected, std::string remedy) {
    throw InputError({.where = {.file = "command line", .line = 0, .column = 0, .byte_offset = {}},
                      .key = "",
                      .found = std::move(found),
                      .expected = std::move(expected),
                      .remedy = std::move(remedy)});
}

// Images from a disk come slower than the host evaluates them: a device only when asked for.
topography::FocusPlanesMaker planes_for(const Configuration& configuration) {
    return measurement::focus_planes_for(configuration.evaluate_on == "device" ? "device" : "host",
                                         configuration.trace.device);
}

// An evaluation and what its files say beside it.
struct Evaluated {
    measurement::Evaluation evaluation;
    nlohmann::ordered_json more = nlohmann::ordered_json::object();
    measurement::StackSource source;
    measurement::TopographyFiles files;
};

// The first line of what the images depend on that overrides change: "key = value", as it is then.
std::optional<std::string> changed_line(const Configuration& configuration, const Configuration& overridden) {
    if (configuration.identity == overridden.identity) {
        return std::nullopt;
    }
    std::istringstream before(configuration.identity), after(overridden.identity);
    std::string line, other;
    while (std::getline(after, other) && std::getline(before, line) && line == other) {
    }
    return other;
}

// A stack with its stack.toml; --set topography.window_px=9 and its like evaluate otherwise.
Evaluated evaluate_own(const CommandOptions& options) {
    if (options.z_step || options.pitch || options.z_start) {
        refuse("--z_step_um, --pitch_um or --z_start_um with a stack that has a stack.toml", "neither of them",
               "Leave them out: they stand in stack.toml.");
    }
    const auto& folder = options.file;
    const auto configuration = load_configuration(folder / "stack.toml", options.overrides, Needs::stack);
    if (const auto line = changed_line(load_configuration(folder / "stack.toml", {}, Needs::stack), configuration)) {
        refuse(*line, "the value that the images were traced with, in " + (folder / "stack.toml").string(),
               "Set keys of [topography], [diffraction] and [output] alone; --stack traces other images.");
    }
    const auto positions = configuration.scan->positions();
    const auto specimen = measurement::make_specimen(configuration);
    const auto instrument = measurement::assemble_instrument(configuration, specimen, positions);
    const int pixels = configuration.instrument.detector_pixels;
    const auto flat = measurement::read_flat(configuration, pixels, pixels, instrument.first_order.pixel_pitch);
    const auto order = order_of_images(positions.size(), options.shuffle);
    measurement::StackEvaluation evaluation(configuration.topography, planes_for(configuration),
                                            measurement::make_diffraction(configuration, instrument));
    for (std::size_t place = 0; place < positions.size(); ++place) {
        const int image = order[place];
        evaluation.add({scan::read_frame(folder, image, positions[static_cast<std::size_t>(image)])}, positions[place]);
    }
    auto more = measurement::run_of(folder);
    std::error_code none; // a folder to be made is another
    if (options.out && !std::filesystem::equivalent(*options.out, folder, none)) {
        more = {{"stack", folder.string()},
                {"images", positions.size()},
                {"rays_per_image", trace::launched_rays(configuration.trace, pixels)},
                {"seed", configuration.trace.seed}};
    }
    return {.evaluation = evaluation.finish(measurement::truth_on_pixels(instrument, configuration, specimen),
                                            configuration.band, flat),
            .more = std::move(more),
            .source = measurement::stack_source(configuration, instrument),
            .files = measurement::topography_files(configuration)};
}

// Images alone: what an instrument's file says of them, the command line must say.
Evaluated evaluate_foreign(const CommandOptions& options) {
    const scan::ImageSeries series(options.file);
    const bool step_good = options.z_step && std::isfinite(*options.z_step) && *options.z_step != 0;
    if (!step_good || !options.pitch || !std::isfinite(*options.pitch) || *options.pitch <= 0) {
        refuse(
            !step_good ? "no --z_step_um, or none that steps" : "no --pitch_um, or none above 0",
            fmt::format("both, for the {} images in {}, which has no stack.toml", series.size(), options.file.string()),
            "Give --z_step_um UM, the step from image to image (negative if they descend), and --pitch_um UM > 0, "
            "the distance of the pixels on the specimen.");
    }
    const double start = options.z_start.value_or(0);
    if (!std::isfinite(start)) {
        refuse("--z_start_um " + fmt::format("{}", start), "a height",
               "Give that of the first image, or leave it out.");
    }
    std::error_code none;
    if (options.out && (std::filesystem::equivalent(*options.out, options.file, none) ||
                        std::filesystem::exists(*options.out / "stack.toml"))) {
        refuse("--out " + options.out->string(), "a folder other than that of any images",
               "Name another: results would be mixed with the stack that is there.");
    }
    if (!options.out && !options.shuffle) {
        refuse("no --out", "a folder for the results of a stack that vkfv did not make", "Give --out FOLDER.");
    }
    // The keys of [topography] alone; --out is no key of it.
    auto overrides = options.overrides;
    std::erase_if(overrides, [](const TomlOverride& given) { return given.origin == "--out"; });
    const auto configuration = topography_configuration(overrides);
    measurement::StackEvaluation evaluation(configuration.topography, planes_for(configuration));
    const auto order = order_of_images(static_cast<std::size_t>(series.size()), options.shuffle);
    spdlog::info("{} images, {} to {}", series.size(), series.name(0), series.name(series.size() - 1));
    std::optional<measurement::Flat> flat;
    bool negative = false;
    for (int place = 0; place < series.size(); ++place) {
        // Heights ascend, whichever way the instrument went.
        const int image = *options.z_step > 0 ? place : series.size() - 1 - place;
        auto channels = series.read(order[static_cast<std::size_t>(image)]);
        if (place == 0) {
            flat =
                measurement::read_flat(configuration, channels.front().columns, channels.front().rows, *options.pitch);
        }
        negative = negative || std::ranges::any_of(channels, [](const Grid<float>& channel) {
                       return std::ranges::any_of(channel.values, [](float value) { return value < 0; });
                   });
        evaluation.add(std::move(channels), start + image * *options.z_step);
    }
    if (negative) {
        spdlog::warn(
            "{}: there are pixels below zero. Focus is contrast relative to brightness: give the images without "
            "any background subtracted.",
            options.file.string());
    }
    return {.evaluation = evaluation.finish(*options.pitch, flat),
            .more = {{"stack", options.file.string()},
                     {"images", series.size()},
                     {"first_image", series.name(0)},
                     {"last_image", series.name(series.size() - 1)},
                     {"z_start_um", start * um_per_mm},
                     {"z_step_um", *options.z_step * um_per_mm},
                     {"pitch_um", *options.pitch * um_per_mm}},
            .source = {},
            .files = {}};
}

} // namespace

void run_topography(const CommandOptions& options) {
    const bool own = std::filesystem::exists(options.file / "stack.toml");
    auto [evaluation, more, source, files] = own ? evaluate_own(options) : evaluate_foreign(options);
    if (options.shuffle && !options.out) {
        // A control is no result of the stack.
        fmt::print("{}images shuffled, nothing written\n", measurement::summary(evaluation));
        return;
    }
    const auto destination = options.out.value_or(options.file);
    if (options.shuffle) {
        more["shuffle_seed"] = *options.shuffle;
    }
    ResultFolder results(destination);
    measurement::write_evaluation(results, evaluation, more, source, files);
    fmt::print("{}results in {}\n", measurement::summary(evaluation), destination.string());
}

} // namespace vkfv::app
