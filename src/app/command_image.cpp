#include "app/commands.hpp"

#include "core/file.hpp"
#include "core/units.hpp"
#include "images/image_file.hpp"
#include "measurement/assembly.hpp"
#include "measurement/exposure.hpp"
#include "measurement/specimen_view.hpp"
#include "report/topography_picture.hpp"

#include <fmt/format.h>
#include <spdlog/spdlog.h>

#include <algorithm>
#include <cmath>
#include <cstdio>

namespace vkfv::app {

Command image_command() {
    const Option z = {
        .name = "--z",
        .value = "UM",
        .description = "Height of the focal plane over best focus, um",
        .target = Take<double>([](CommandOptions& options, double um) { options.focal_height = um / um_per_mm; }),
        .needed = "the height of the focal plane over best focus"};
    return {.name = "image",
            .summary = "Trace one exposure, at --z",
            .operands = {{"C.toml", "Configuration", &CommandOptions::file}},
            .options = together({configuration_options(), {out_option("Output folder, or a .tif file"), z}}),
            .run = run_image,
            .example = "vkfv image assets/stacks/demo.toml --z -3.2 --rays 1e8"};
}

namespace {

constexpr double least_signal_to_noise = 10; // of 100 detected rays a pixel

std::filesystem::path image_path(const CommandOptions& options, const Configuration& configuration) {
    if (options.out && (options.out->extension() == ".tif" || options.out->extension() == ".tiff")) {
        return *options.out;
    }
    return configuration.output_directory / fmt::format("image_{:+.3f}um.tif", options.focal_height * um_per_mm);
}

void print_ledger(const trace::Image& image) {
    fmt::print("{:<52} {:>14} {:>9}\n", "energy ledger", "W", "share");
    for (const auto& entry : image.ledger.entries) {
        if (entry.rays == 0 && entry.power == 0) {
            continue; // ledger.csv of a stack lists them all
        }
        fmt::print("{:<52} {:>14.6e} {:>8.4f} %\n", entry.name, entry.power, 100 * entry.power / image.ledger.emitted);
    }
    fmt::print("{:<52} {:>14.6e}\n", "emitted", image.ledger.emitted);
    fmt::print("{:<52} {:>14.6e}\n", "residual", image.ledger.residual());
    if (image.ledger.residual_error > 0) {
        fmt::print("{:<52} {:>14.6e}\n", "standard error of the residual", image.ledger.residual_error);
    }
}

} // namespace

void run_image(const CommandOptions& options) {
    const auto configuration = load_configuration(options.file, options.overrides, Needs::exposure);
    const auto specimen = measurement::make_specimen(configuration);
    const auto exposure =
        measurement::expose(configuration, measurement::instrument_for(configuration, specimen, options.focal_height),
                            specimen, options.focal_height);
    const auto& image = exposure.image;
    const auto path = image_path(options, configuration);
    auto picture = path;
    picture.replace_extension(".svg");
    auto files = measurement::image_files(path, exposure, options.focal_height);
    files.emplace_back(picture, report::image_picture(fmt::format("{}, z = {:g} um", options.file.stem().string(),
                                                                  options.focal_height * um_per_mm),
                                                      image.flux, exposure.first, exposure.first, exposure.pitch));
    make_folder(path.parent_path());
    for (const auto& [file, bytes] : files) {
        write_file(file, bytes);
    }
    for (const auto& warning : measurement::warning_of_lost_light(image)) {
        spdlog::warn(warning);
    }
    if (const double ratio = measurement::signal_to_noise(image); ratio < least_signal_to_noise) {
        spdlog::warn(
            "noise is {:.0f} % of a pixel's mean light. Launch more rays with --rays, close the field stop to the "
            "field of view, or take --estimator backward",
            100 / ratio);
    }
    print_ledger(image);
    fmt::print("{} rays, {} detected, {:.3g} rays/s, {:.3g} s\n{}\n{}\n", image.rays, image.detected,
               static_cast<double>(image.rays) / image.seconds, image.seconds, path.string(), picture.string());
}

} // namespace vkfv::app
