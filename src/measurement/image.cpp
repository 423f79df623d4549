#include "measurement/image.hpp"

#include "core/file.hpp"
#include "core/stages.hpp"
#include "core/units.hpp"
#include "measurement/assembly.hpp"
#include "measurement/camera_images.hpp"
#include "measurement/specimen_view.hpp"
#include "report/topography_picture.hpp"

#include <fmt/format.h>
#include <spdlog/spdlog.h>

#include <algorithm>
#include <array>

namespace vkfv::measurement {

namespace {

constexpr double least_signal_to_noise = 10; // of 100 detected rays a pixel

std::string text_of(const trace::Ledger& ledger) {
    std::string text = fmt::format("{:<52} {:>14} {:>9}\n", "energy ledger", "W", "share");
    for (const auto& entry : ledger.entries) {
        if (entry.rays == 0 && entry.power == 0) {
            continue; // ledger.csv of a stack lists them all
        }
        text +=
            fmt::format("{:<52} {:>14.6e} {:>8.4f} %\n", entry.name, entry.power, 100 * entry.power / ledger.emitted);
    }
    text += fmt::format("{:<52} {:>14.6e}\n", "emitted", ledger.emitted);
    text += fmt::format("{:<52} {:>14.6e}\n", "residual", ledger.residual());
    if (ledger.residual_error > 0) {
        text += fmt::format("{:<52} {:>14.6e}\n", "standard error of the residual", ledger.residual_error);
    }
    return text;
}

std::string picture_of(const Exposure& exposure, const std::string& title) {
    if (!exposure.taken) {
        return report::image_picture(title, exposure.image.flux, exposure.grid.x0, exposure.grid.y0,
                                     exposure.grid.pitch_x, report::light_of_pixels);
    }
    Grid<double> values(exposure.taken->values.columns, exposure.taken->values.rows);
    std::ranges::copy(exposure.taken->values.values, values.values.begin());
    return report::image_picture(title, values, exposure.grid.x0, exposure.grid.y0, exposure.grid.pitch_x,
                                 report::grey_values_of_pixels);
}

std::string text_of(const CameraNote& note) {
    const auto& light = note.light;
    return fmt::format(
        "exposed for {:.4g} ms: {:.4g} e- a pixel in the mean; noise of the camera {:.4g} e-, of the rays "
        "{:.4g} e-; {:.2g} % saturated\n",
        1e3 * note.exposure_time, light.mean, light.camera_noise, light.ray_noise, 100 * light.saturated_share);
}

} // namespace

ImageResult measure_image(const Configuration& configuration, double focal_height, const std::filesystem::path& file) {
    enter_stage("specimen");
    const auto specimen = make_specimen(configuration);
    enter_stage("instrument");
    const auto instrument = instrument_for(configuration, specimen, focal_height);
    auto checkpoint = file;
    checkpoint += ".partial";
    ImageResult result{.exposure = expose(configuration, instrument, specimen, focal_height, checkpoint),
                       .file = file,
                       .picture = file};
    enter_stage("files");
    result.picture.replace_extension(".svg");
    const auto& exposure = result.exposure;
    auto files = image_files(file, exposure, focal_height);
    const auto title = fmt::format("{}, z = {:g} um", configuration.file.stem().string(), focal_height * um_per_mm);
    files.emplace_back(result.picture, picture_of(exposure, title));
    make_folder(file.parent_path());
    for (const auto& [name, bytes] : files) {
        write_file(name, bytes);
    }
    std::error_code none;
    std::filesystem::remove(checkpoint, none);
    enter_stage("end");
    for (const auto& warning : warning_of_lost_light(exposure.image)) {
        spdlog::warn(warning);
    }
    if (exposure.taken) {
        const auto figures = camera_figures(std::array{CameraNote::parse(exposure.taken->note).value()});
        for (const auto& warning : camera_warnings(configuration, figures)) {
            spdlog::warn(warning);
        }
    } else if (const double ratio = signal_to_noise(exposure.image); ratio < least_signal_to_noise) {
        spdlog::warn("noise is {:.0f} % of a pixel's mean light. {}", 100 / ratio,
                     remedy_of_noise(configuration, 1 / ratio, 1 / least_signal_to_noise));
    }
    return result;
}

std::string summary(const ImageResult& result) {
    const auto& image = result.exposure.image;
    const auto note = result.exposure.taken ? CameraNote::parse(result.exposure.taken->note) : std::nullopt;
    return text_of(image.ledger) + (note ? text_of(*note) : std::string()) +
           fmt::format("{} rays, {} detected, {:.3g} rays/s, {:.3g} s\n{}\n{}\n", image.rays, image.detected,
                       static_cast<double>(image.rays) / image.seconds, image.seconds, result.file.string(),
                       result.picture.string());
}

} // namespace vkfv::measurement
