#include "app/commands.hpp"

#include "core/units.hpp"
#include "surface/image_file.hpp"

#include <fmt/format.h>
#include <spdlog/spdlog.h>

#include <algorithm>
#include <cmath>
#include <cstdio>

namespace vkfv::app {

namespace {

constexpr std::uint64_t fewest_detected_per_pixel = 100; // 10 % of noise

// The random numbers of an exposure are keyed by its index: at a position of the scan, that image of the
// stack is what comes out, bit by bit; anywhere else the index counts on after the scan's.
std::uint32_t image_index(const Configuration& configuration, double focal_height) {
    if (!configuration.scan) {
        return 0;
    }
    const auto positions = configuration.scan->positions();
    for (std::size_t i = 0; i < positions.size(); ++i) {
        if (std::abs(positions[i] - focal_height) < 1e-6 * configuration.scan->z_step) {
            return static_cast<std::uint32_t>(i);
        }
    }
    return static_cast<std::uint32_t>(positions.size());
}

std::filesystem::path image_path(const CommandOptions& options, const Configuration& configuration) {
    if (options.out && (options.out->extension() == ".tif" || options.out->extension() == ".tiff")) {
        return *options.out;
    }
    return configuration.output_directory /
           fmt::format("image_{:+.3f}um.tif", options.focal_height * um_per_mm);
}

void print_ledger(const trace::Image& image) {
    fmt::print("{:<52} {:>14} {:>9}\n", "energy ledger", "W", "share");
    for (const auto& entry : image.ledger.entries) {
        if (entry.rays == 0 && entry.power == 0) {
            continue; // ledger.csv of a stack lists them all
        }
        fmt::print("{:<52} {:>14.6e} {:>8.4f} %\n", entry.name, entry.power,
                   100 * entry.power / image.ledger.emitted);
    }
    fmt::print("{:<52} {:>14.6e}\n", "emitted", image.ledger.emitted);
    fmt::print("{:<52} {:>14.6e}\n", "residual", image.ledger.residual());
    if (image.ledger.residual_error > 0) {
        fmt::print("{:<52} {:>14.6e}\n", "standard error of the residual", image.ledger.residual_error);
    }
}

} // namespace

Exposure expose(const Configuration& configuration, double focal_height) {
    const auto specimen = specimen::make(*configuration.specimen);
    // The scan's positions too, so that the instrument is the stack's.
    auto heights = configuration.scan ? configuration.scan->positions() : std::vector<double>();
    heights.push_back(focal_height);
    const auto instrument = assemble_instrument(configuration, specimen, heights);
    const auto tracer = make_tracer(instrument, specimen, configuration.trace);
    const double pitch = instrument.first_order.pixel_pitch;
    return {tracer->expose(focal_height, image_index(configuration, focal_height)),
            -0.5 * (configuration.instrument.detector_pixels - 1) * pitch, pitch, tracer->description()};
}

void write_image(const std::filesystem::path& path, const Exposure& exposure, double focal_height) {
    const auto& image = exposure.image.flux;
    Grid<float> flux(image.columns, image.rows);
    std::copy(image.values.begin(), image.values.end(), flux.values.begin());
    if (path.has_parent_path()) {
        std::filesystem::create_directories(path.parent_path());
    }
    surface::write_tiff(path, flux,
                        {.pitch_x = exposure.pitch,
                         .pitch_y = exposure.pitch,
                         .description = fmt::format("radiant flux in W at z = {} um", focal_height * um_per_mm)});
}

void run_image(const CommandOptions& options) {
    const auto configuration = load_configuration(options.file, options.overrides, Needs::exposure);
    const auto exposure = expose(configuration, options.focal_height);
    const auto& image = exposure.image;
    const auto path = image_path(options, configuration);
    write_image(path, exposure, options.focal_height);
    const auto pixels = image.flux.values.size();
    if (image.detected < fewest_detected_per_pixel * pixels) {
        spdlog::warn("{} rays detected on {} pixels: below {} a pixel an image is mostly noise. Launch more "
                     "with --rays, "
                     "or close the field stop to the field of view",
                     image.detected, pixels, fewest_detected_per_pixel);
    }
    print_ledger(image);
    fmt::print("{} rays, {} detected, {:.3g} rays/s, {:.3g} s\n{}\n", image.rays, image.detected,
               static_cast<double>(image.rays) / image.seconds, image.seconds, path.string());
}

} // namespace vkfv::app
