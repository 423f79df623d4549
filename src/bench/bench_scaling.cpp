#include "bench/bench_parts.hpp"
#include "measurement/scene/assembly.hpp"
#include "specimen/kinds.hpp"
#include "trace/device/device_tracer.hpp"

#include <fmt/format.h>
#include <spdlog/spdlog.h>

#include <algorithm>
#include <cmath>

namespace vkfv::bench {

namespace {

// Number of runs of a point of a curve, whose sizes matter more than medians.
int few_runs(const BenchScene& scene) {
    return std::min(scene.options().runs, 3);
}

} // namespace

Json over_rays(const BenchScene& scene) {
    Json result = Json::array();
    for (const std::uint64_t part : {1000, 100, 10, 1}) {
        const std::uint64_t rays = std::max<std::uint64_t>(1, scene.rays() / part);
        spdlog::info("{} rays", rays);
        result.push_back(scene.timing(*scene.tracer_of(scene.configuration().trace, rays)));
    }
    return result;
}

Json over_triangles(const BenchScene& scene) {
    Json result = Json::array();
    if (!std::holds_alternative<specimen::HeightField>(scene.specimen().geometry) ||
        specimen::size_of(scene.configuration().specimen->shape) == 0) {
        return result;
    }
    std::vector<double> numbers = {1e3, 1e4, 1e5, 1e6};
    if (!scene.options().quick) {
        numbers.insert(numbers.end(), {4e6, 1.6e7});
    }
    for (const double number : numbers) {
        auto description = *scene.configuration().specimen;
        const double cells = std::round(std::sqrt(number / 2));
        description.shape = specimen::with_pitch(description.shape, specimen::size_of(description.shape) / cells);
        const auto specimen = specimen::make(description);
        for (const auto& way : scene.traversals()) {
            if (way.name == "bvh" && scene.software() && number > 1e6) {
                continue; // on two cores its build takes longer than everything else together
            }
            spdlog::info("{:.0f} triangles by {}", 2 * cells * cells, way.name);
            auto options = way.options;
            options.rays = scene.rays();
            Json entry = {{"triangles", 2 * cells * cells}, {"traversal", way.name}};
            entry.update(
                scene.timing(*trace::make_device_tracer(scene.instrument(), specimen, options), few_runs(scene)));
            result.push_back(entry);
        }
    }
    return result;
}

Json over_surfaces(const BenchScene& scene) {
    Json result = Json::array();
    const double magnification = std::abs(scene.instrument().first_order.magnification);
    for (const char* objective : {"5x_0.15", "10x_0.28", "20x_0.41", "50x_0.66", "100x_0.83"}) {
        auto overrides = scene.options().overrides;
        overrides.push_back({"objective.prescription", fmt::format("\"{}\"", objective), "--bench"});
        auto configuration = load_configuration(scene.options().file, overrides, Needs::exposure);
        auto& description = configuration.instrument;
        for (const bool glass : {true, false}) {
            if (!glass) {
                if (description.splitter.kind == optics::BeamSplitter::Kind::ideal) {
                    continue;
                }
                description.splitter.kind = optics::BeamSplitter::Kind::ideal;
            }
            const auto first_order = measurement::assemble_instrument(configuration).first_order;
            auto fitted = configuration;
            fitted.instrument.source.radius = first_order.pupil_radius_in_source;
            // A field of view wider than the configuration's would be lit beyond its specimen.
            if (fitted.instrument.field_stop_radius) {
                *fitted.instrument.field_stop_radius *=
                    std::min(1.0, std::abs(first_order.magnification) / magnification);
            }
            spdlog::info("objective {} with {}", objective, glass ? "the splitter's glass" : "an ideal splitter");
            const auto instrument = instrument_of(fitted, scene.specimen());
            auto options = scene.configuration().trace;
            options.rays = scene.rays();
            Json entry = {{"objective", objective},
                          {"splitter", glass ? "glass" : "ideal"},
                          {"surfaces", instrument.constants.illumination_count + instrument.constants.imaging_count},
                          {"numerical_aperture", instrument.first_order.numerical_aperture}};
            entry.update(
                scene.timing(*trace::make_device_tracer(instrument, scene.specimen(), options), few_runs(scene)));
            result.push_back(entry);
        }
    }
    return result;
}

Json over_pixels(const BenchScene& scene) {
    Json result = Json::array();
    for (const int pixels : {64, 256, 1024, 4096}) {
        spdlog::info("{} x {} pixels", pixels, pixels);
        auto configuration = scene.configuration();
        configuration.instrument.detector_pixels = ImageSize::square(pixels);
        const auto instrument = instrument_of(configuration, scene.specimen());
        auto options = scene.configuration().trace;
        options.rays = scene.rays();
        Json entry = {{"pixels_along_a_side", pixels}};
        entry.update(scene.timing(*trace::make_device_tracer(instrument, scene.specimen(), options), few_runs(scene)));
        result.push_back(entry);
    }
    return result;
}

} // namespace vkfv::bench
