#include "measurement/image/exposure.hpp"

#include "core/files/digest.hpp"
#include "core/files/file.hpp"
#include "core/mathematics/units.hpp"
#include "core/messages/stages.hpp"
#include "images/image_file.hpp"
#include "measurement/image/camera_images.hpp"
#include "measurement/scene/assembly.hpp"
#include "measurement/scene/known_truth.hpp"
#include "measurement/scene/phase_limits.hpp"
#include "measurement/scene/wave_limits.hpp"
#include "scan/checkpoint_files.hpp"
#include "specimen/geometry_digest.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <memory>
#include <utility>

namespace vkfv::measurement {

namespace {

Grid<float> in_float(const Grid<double>& image) {
    Grid<float> result(image.columns, image.rows);
    std::copy(image.values.begin(), image.values.end(), result.values.begin());
    return result;
}

} // namespace

Exposure expose(const Configuration& configuration, WorkingDevices& devices, const optics::Instrument& instrument,
                const specimen::Specimen& specimen, double focal_height, const std::filesystem::path& checkpoint) {
    Exposure exposure;
    exposure.grid = grid_of_image(instrument, configuration, focal_height);
    exposure.type = configuration.pixel_type;
    work_with_devices(devices, [&](const WorkingDevices& working) {
        enter_stage("device, kernels");
        const auto tracer = make_tracer(working, configuration, instrument, specimen);
        enter_stage("image");
        exposure.tracer = tracer->identity();
        const auto image = image_index(configuration, focal_height);
        if (checkpoint.empty() || configuration.checkpoint_interval == 0) {
            exposure.image = tracer->expose(focal_height, image);
        } else {
            make_folder(checkpoint.parent_path());
            const auto identity = image_identity(configuration, specimen::geometry_digest(specimen), exposure.tracer);
            auto kept = std::make_shared<const scan::CheckpointFiles>(
                [checkpoint](std::uint32_t) { return checkpoint; },
                Digest().add(fmt::format("{}z = {}\n", identity, focal_height)).text(),
                configuration.checkpoint_interval);
            exposure.image = tracer->begin(focal_height, image, std::move(kept)).get();
        }
        if (configuration.camera) {
            const auto heights = configuration.scan ? configuration.scan->positions() : std::vector{focal_height};
            const double seconds = exposure_time(configuration, instrument, specimen, heights, working);
            exposure.taken =
                ImagingCamera(configuration, instrument, seconds).develop(static_cast<int>(image), exposure.image);
        }
        if (const auto filters = tracer->pupil_filters(); !filters.empty()) {
            append(exposure.warnings, warnings_of(worst_of(limits_of_lights(filters, instrument))));
            append(exposure.warnings, warnings_of(phase_limits(configuration.instrument, instrument, specimen)));
            log_warnings(exposure.warnings);
        }
    });
    if (const auto diffraction = diffraction_of_evaluation(configuration, instrument)) {
        exposure.diffracted = diffraction->apply(in_float(exposure.image.flux));
    }
    return exposure;
}

std::vector<std::pair<std::filesystem::path, std::string>> image_files(const std::filesystem::path& name,
                                                                       const Exposure& exposure, double focal_height) {
    if (exposure.taken) {
        return {{name, scan::frame_bytes(exposure.taken->values, exposure.type, exposure.grid.pitch_x,
                                         fmt::format("grey values in DN at z = {} um\ncamera={}",
                                                     focal_height * um_per_mm, exposure.taken->note))}};
    }
    const images::ImageTags tags{.pitch_x = exposure.grid.pitch_x,
                                 .pitch_y = exposure.grid.pitch_x,
                                 .description =
                                     fmt::format("radiant flux in W at z = {} um", focal_height * um_per_mm)};
    std::vector<std::pair<std::filesystem::path, std::string>> files;
    files.emplace_back(name, images::tiff_bytes(in_float(exposure.image.flux), tags));
    if (exposure.diffracted) {
        auto beside = name;
        beside.replace_filename(name.stem().string() + "_diffracted" + name.extension().string());
        files.emplace_back(beside, images::tiff_bytes(*exposure.diffracted, tags));
    }
    return files;
}

double signal_to_noise(const trace::Image& image) {
    double flux = 0, variance = 0;
    for (std::size_t k = 0; k < image.flux.values.size(); ++k) {
        flux += image.flux.values[k];
        variance += image.standard_error.values[k] * image.standard_error.values[k];
    }
    return flux / std::sqrt(variance * static_cast<double>(image.flux.values.size()));
}

namespace {

// The factor by which the number of rays must grow, since noise falls with the root of it.
double times_as_many_rays(double share, double wanted) {
    return std::ceil(share * share / (wanted * wanted));
}

} // namespace

std::string rays_for_noise(const Configuration& configuration, double share, double wanted) {
    return number_text(times_as_many_rays(share, wanted) * static_cast<double>(configuration.trace.rays), Rounding::up);
}

std::string remedy_of_noise(const Configuration& configuration, double share, double wanted) {
    const double times = times_as_many_rays(share, wanted);
    std::string text = fmt::format("Launch {:.3g} times as many rays (--rays {:.2g})", times,
                                   times * static_cast<double>(configuration.trace.rays));
    if (configuration.trace.estimator == trace::Estimator::forward) {
        text += ", or close the field stop to the field of view";
        if (!configuration.trace.nonsequential) {
            text += ", or take --estimator backward";
        }
    }
    return text;
}

} // namespace vkfv::measurement
