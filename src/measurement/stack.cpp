#include "measurement/stack.hpp"

#include "core/digest.hpp"
#include "core/stages.hpp"
#include "measurement/assembly.hpp"
#include "measurement/evaluation_files.hpp"
#include "measurement/exposure.hpp"
#include "measurement/wave_limits.hpp"
#include "specimen/geometry_digest.hpp"

#include <fmt/format.h>
#include <spdlog/spdlog.h>

#include <algorithm>
#include <future>

namespace vkfv::measurement {

namespace {

constexpr double most_image_noise = 0.5, good_image_noise = 0.1;

} // namespace

StackResult measure_stack(const Configuration& configuration, Progress& progress) {
    const auto positions = configuration.scan->positions();
    enter_stage("specimen");
    const auto specimen = make_specimen(configuration);
    enter_stage("instrument");
    const auto instrument = assemble_instrument(configuration, specimen, positions);
    const int pixels = configuration.instrument.detector_pixels;
    const auto flat = read_flat(configuration, pixels, pixels, instrument.first_order.pixel_pitch);
    enter_stage("device, kernels");
    const auto tracer = make_tracer(instrument, specimen, configuration.trace);
    const std::string identity = image_identity(configuration, specimen::geometry_digest(specimen), tracer->identity());

    enter_stage("folder of the stack");
    scan::ImageStore store(configuration.output_directory, {.configuration = configuration.canonical,
                                                            .identity = identity,
                                                            .digest = Digest().add(identity).text(),
                                                            .positions = positions,
                                                            .columns = pixels,
                                                            .rows = pixels,
                                                            .pitch = instrument.first_order.pixel_pitch});
    // Evaluated as they are traced: no second pass over the disk.
    StackEvaluation stack_evaluation(evaluation_options(configuration, instrument),
                                     focus_planes_for(configuration.evaluate_on, tracer->device()),
                                     make_diffraction(configuration, instrument));
    enter_stage("images");
    // What no image is needed for is made beside them.
    auto truth = std::async(std::launch::async, [&] { return truth_on_pixels(instrument, configuration, specimen); });
    auto source = std::async(std::launch::async, [&] { return stack_source(configuration, instrument); });
    bool any_light = false;
    const auto traced = scan::run_stack(*tracer, store, progress, {}, [&](int image, Grid<float> flux) {
        any_light = any_light || std::ranges::any_of(flux.values, [](float value) { return value > 0; });
        stack_evaluation.add({std::move(flux)}, positions[static_cast<std::size_t>(image)]);
    });
    spdlog::info("{} images traced, {} kept from before", traced.traced, traced.kept);
    if (traced.device_span > 0) {
        scan::append_timing(store.folder(), "device at work", traced.device_seconds);
        scan::append_timing(store.folder(), "device from first to last image", traced.device_span);
    }
    if (!any_light) {
        spdlog::warn("No light reaches the detector in any image. vkfv --image of one position tells where it goes");
    }

    enter_stage("heights and truth");
    const std::uint64_t rays_per_image = trace::launched_rays(configuration.trace, pixels);
    EvaluatedStack stack{.evaluation = stack_evaluation.finish(truth.get(), configuration.band, flat),
                         .origin = {{"device", tracer->identity().text()},
                                    {"stack_digest", store.description().digest},
                                    {"seed", configuration.trace.seed},
                                    {"images", positions.size()},
                                    {"rays_per_image", rays_per_image}},
                         .source = source.get(),
                         .files = topography_files(configuration)};
    if (const auto* filter = tracer->pupil_filter()) {
        const WaveLimits limits = wave_limits(*filter, instrument);
        for (const auto& warning : warnings_of(limits)) {
            spdlog::warn(warning);
        }
        stack.origin["waves"] = json_of(limits);
        stack.origin["waves"]["warnings"] = warnings_of(limits);
    }
    if (const double noise = stack.evaluation.topography.stack.image_noise; noise > most_image_noise) {
        spdlog::warn("The images' noise is {:.0f} % of their brightness: what is measured is little or rough. {}",
                     100 * noise, remedy_of_noise(configuration, noise, good_image_noise));
    }
    enter_stage("results and report");
    write_results(store.results(), stack);
    enter_stage("end");
    return {.evaluation = std::move(stack.evaluation),
            .traced = traced,
            .rays_per_image = rays_per_image,
            .folder = store.folder()};
}

std::string summary(const StackResult& stack) {
    const auto& traced = stack.traced;
    std::string text = summary(stack.evaluation);
    if (traced.traced > 0) {
        text +=
            fmt::format("traced {} images in {:.3g} s ({}{}), evaluated in {:.2g} s\n", traced.traced,
                        traced.trace_seconds, ray_rate_text(static_cast<double>(traced.rays) / traced.trace_seconds),
                        traced.device_span > 0 ? fmt::format("; the device was at work for {:.0f} % of it",
                                                             100 * traced.device_seconds / traced.device_span)
                                               : "",
                        stack.evaluation.seconds);
    }
    return text + fmt::format("results in {}\n", stack.folder.string());
}

} // namespace vkfv::measurement
