#include "app/commands.hpp"

#include "app/specimen_view.hpp"
#include "core/file.hpp"
#include "core/units.hpp"
#include "report/topography_picture.hpp"
#include "surface/image_file.hpp"

#include <fmt/format.h>
#include <spdlog/spdlog.h>

#include <algorithm>
#include <cmath>
#include <cstdio>

namespace vkfv::app {

namespace {

constexpr double least_signal_to_noise = 10; // of 100 detected rays a pixel

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
    return configuration.output_directory / fmt::format("image_{:+.3f}um.tif", options.focal_height * um_per_mm);
}

Grid<float> in_float(const Grid<double>& image) {
    Grid<float> result(image.columns, image.rows);
    std::copy(image.values.begin(), image.values.end(), result.values.begin());
    return result;
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

optics::Instrument instrument_for(const Configuration& configuration, const specimen::Specimen& specimen,
                                  double focal_height) {
    auto heights = configuration.scan ? configuration.scan->positions() : std::vector<double>();
    heights.push_back(focal_height);
    return assemble_instrument(configuration, specimen, heights);
}

Exposure expose(const Configuration& configuration, const optics::Instrument& instrument,
                const specimen::Specimen& specimen, double focal_height) {
    const auto tracer = make_tracer(instrument, specimen, configuration.trace);
    const double pitch = instrument.first_order.pixel_pitch;
    Exposure exposure{tracer->expose(focal_height, image_index(configuration, focal_height)),
                      -0.5 * (configuration.instrument.detector_pixels - 1) * pitch,
                      pitch,
                      tracer->identity(),
                      {}};
    if (const auto diffraction = make_diffraction(configuration, instrument)) {
        exposure.diffracted = diffraction->apply(in_float(exposure.image.flux));
    }
    return exposure;
}

std::vector<std::pair<std::filesystem::path, std::string>> image_files(const std::filesystem::path& name,
                                                                       const Exposure& exposure, double focal_height) {
    const surface::ImageTags tags{.pitch_x = exposure.pitch,
                                  .pitch_y = exposure.pitch,
                                  .description =
                                      fmt::format("radiant flux in W at z = {} um", focal_height * um_per_mm)};
    std::vector<std::pair<std::filesystem::path, std::string>> files;
    files.emplace_back(name, surface::tiff_bytes(in_float(exposure.image.flux), tags));
    if (exposure.diffracted) {
        auto beside = name;
        beside.replace_filename(name.stem().string() + "_diffracted" + name.extension().string());
        files.emplace_back(beside, surface::tiff_bytes(*exposure.diffracted, tags));
    }
    return files;
}

void run_image(const CommandOptions& options) {
    const auto configuration = load_configuration(options.file, options.overrides, Needs::exposure);
    const auto specimen = make_specimen(configuration);
    const auto exposure = expose(configuration, instrument_for(configuration, specimen, options.focal_height), specimen,
                                 options.focal_height);
    const auto& image = exposure.image;
    const auto path = image_path(options, configuration);
    auto picture = path;
    picture.replace_extension(".svg");
    auto files = image_files(path, exposure, options.focal_height);
    files.emplace_back(picture, report::image_picture(fmt::format("{}, z = {:g} um", options.file.stem().string(),
                                                                  options.focal_height * um_per_mm),
                                                      image.flux, exposure.first, exposure.first, exposure.pitch));
    make_folder(path.parent_path());
    for (const auto& [file, bytes] : files) {
        write_file(file, bytes);
    }
    for (const auto& warning : warning_of_lost_light(image)) {
        spdlog::warn(warning);
    }
    if (const double ratio = signal_to_noise(image); ratio < least_signal_to_noise) {
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
