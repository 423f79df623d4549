#include "measurement/image/image.hpp"

#include "core/files/file.hpp"
#include "core/mathematics/units.hpp"
#include "core/messages/heartbeat.hpp"
#include "core/messages/safe_text.hpp"
#include "core/messages/stages.hpp"
#include "measurement/image/camera_images.hpp"
#include "measurement/scene/assembly.hpp"
#include "measurement/scene/specimen_view.hpp"
#include "measurement/scene/warning_json.hpp"
#include "report/declared_figures.hpp"
#include "report/topography_picture.hpp"

#include <fmt/format.h>
#include <spdlog/spdlog.h>

#include <algorithm>
#include <array>
#include <future>
#include <iterator>
#include <utility>

namespace vkfv::measurement {

namespace {

using Json = nlohmann::ordered_json;

constexpr double least_signal_to_noise = 10; // by 100 detected rays a pixel

std::string text_of(const trace::Ledger& ledger) {
    std::string text = fmt::format("{:<52} {:>14} {:>9}\n", "energy ledger", "W", "share");
    for (const auto& entry : ledger.entries) {
        if (entry.rays == 0 && entry.power == 0) {
            continue; // left out here; ledger.csv of a stack lists all entries
        }
        text +=
            fmt::format("{:<52} {:>14.6e} {:>8.4g} %\n", entry.name, entry.power, 100 * entry.power / ledger.emitted);
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
        "{:.4g} e-; {:.3g} % saturated\n",
        1e3 * note.exposure_time, light.mean, light.camera_noise, light.ray_noise, 100 * light.saturated_share);
}

std::optional<CameraNote> note_of(const Exposure& exposure) {
    return exposure.taken ? CameraNote::parse(exposure.taken->note) : std::nullopt;
}

Json json_of(const trace::Ledger& ledger) {
    Json entries = Json::array();
    for (const auto& entry : ledger.entries) {
        entries.push_back({{"name", entry.name}, {"power_W", entry.power}, {"rays", entry.rays}});
    }
    return {{"emitted_W", ledger.emitted},
            {"residual_W", ledger.residual()},
            {"residual_standard_error_W", ledger.residual_error},
            {"entries", std::move(entries)}};
}

} // namespace

ImageResult measure_image(const Configuration& configuration, double focal_height, const std::filesystem::path& file) {
    WorkingDevices devices(configuration.trace.device);
    enter_stage("specimen");
    const auto specimen = make_specimen(configuration);
    enter_stage("instrument");
    const auto instrument = instrument_for(configuration, specimen, focal_height);
    auto checkpoint = file;
    checkpoint += ".partial";
    const CountedWork work(1);
    ImageResult result{.exposure = expose(configuration, devices, instrument, specimen, focal_height, checkpoint),
                       .focal_height = focal_height,
                       .file = file,
                       .picture = file,
                       .warnings = {}};
    enter_stage("files");
    result.picture.replace_extension(".svg");
    const auto& exposure = result.exposure;
    const auto title = fmt::format("{}, z = {:g} um", configuration.file.stem().string(), focal_height * um_per_mm);
    auto picture = std::async(std::launch::async, [&] { return picture_of(exposure, title); });
    make_folder(file.parent_path());
    for (const auto& [name, bytes] : image_files(file, exposure, focal_height)) {
        write_file(name, bytes);
    }
    write_file(result.picture, picture.get());
    std::error_code none;
    std::filesystem::remove(checkpoint, none);
    enter_stage("end");
    result.warnings = warning_of_lost_light(configuration, instrument, exposure.image);
    if (exposure.taken) {
        const auto figures = camera_figures(std::array{note_of(exposure).value()});
        append(result.warnings, warnings_of_images(configuration, figures));
    } else if (const double ratio = signal_to_noise(exposure.image); ratio < least_signal_to_noise) {
        result.warnings.push_back(
            {.code = "few-rays",
             .key = "trace.rays",
             .value = std::to_string(configuration.trace.rays),
             .works = rays_for_noise(configuration, 1 / ratio, 1 / least_signal_to_noise),
             .sentence = fmt::format("noise is {:.0f} % of a pixel's mean light. {}", 100 / ratio,
                                     remedy_of_noise(configuration, 1 / ratio, 1 / least_signal_to_noise))});
    }
    log_warnings(result.warnings);
    append(result.warnings, exposure.warnings); // in the log already
    append(result.warnings, instrument.warnings);
    return result;
}

std::string summary(const ImageResult& result) {
    const auto& image = result.exposure.image;
    const auto note = note_of(result.exposure);
    return text_of(image.ledger) + (note ? text_of(*note) : std::string()) +
           fmt::format("{} rays, {} detected, {:.3g} rays/s, {:.3g} s\n{}\n{}\n", image.rays, image.detected,
                       static_cast<double>(image.rays) / image.seconds, image.seconds, safe_line(result.file.string()),
                       safe_line(result.picture.string()));
}

Json image_json(const ImageResult& result) {
    const auto& [image, grid, tracer, diffracted, taken, type, of_waves] = result.exposure;
    double power = 0;
    for (const double flux : image.flux.values) {
        power += flux;
    }
    Json json = {{"file", result.file.string()},
                 {"picture", result.picture.string()},
                 {"z", result.focal_height},
                 {"columns", grid.columns},
                 {"rows", grid.rows},
                 {"pitch", grid.pitch_x},
                 {"device", tracer.text()},
                 {"rays_launched", image.rays},
                 {"rays_detected", image.detected},
                 {"seconds", image.seconds},
                 {"mean_pixel_W", power / static_cast<double>(image.flux.values.size())},
                 {"signal_to_noise", signal_to_noise(image)},
                 {"ledger", json_of(image.ledger)},
                 {"warnings", json_of(result.warnings)}};
    if (const auto note = note_of(result.exposure)) {
        json["camera"] = note->json();
    }
    return report::as_declared("image", json);
}

} // namespace vkfv::measurement
