#include "app/commands.hpp"
#include "core/digest.hpp"
#include "measurement/assembly.hpp"
#include "measurement/evaluation.hpp"
#include "specimen/geometry_digest.hpp"

#include "core/progress.hpp"
#include "scan/stack.hpp"

#include <fmt/format.h>
#include <nlohmann/json.hpp>
#include <spdlog/spdlog.h>

#include <algorithm>
#include <cstdio>

namespace vkfv::app {

Command stack_command() {
    return {.name = "stack",
            .summary =
                "Trace a focus stack, reconstruct it and compare it with the truth; continues an interrupted one",
            .operands = {{"C.toml", "Configuration", &CommandOptions::file}},
            .options = together({configuration_options(), {out_option("Output folder")}}),
            .run = run_stack,
            .example = "vkfv stack assets/stacks/demo.toml --out demo"};
}

void run_stack(const CommandOptions& options) {
    const auto configuration = load_configuration(options.file, options.overrides, Needs::stack);
    const auto positions = configuration.scan->positions();
    const auto specimen = measurement::make_specimen(configuration);
    const auto instrument = measurement::assemble_instrument(configuration, specimen, positions);
    const int pixels = configuration.instrument.detector_pixels;
    const auto flat = measurement::read_flat(configuration, pixels, pixels, instrument.first_order.pixel_pitch);
    const auto tracer = measurement::make_tracer(instrument, specimen, configuration.trace);
    const std::string identity =
        measurement::image_identity(configuration, specimen::geometry_digest(specimen), tracer->identity());

    scan::ImageStore store(configuration.output_directory, {.configuration = configuration.canonical,
                                                            .identity = identity,
                                                            .digest = Digest().add(identity).text(),
                                                            .positions = positions,
                                                            .columns = pixels,
                                                            .rows = pixels,
                                                            .pitch = instrument.first_order.pixel_pitch});
    auto progress = Progress::on_standard_error(options.quiet);
    // Evaluated as they are traced: no second pass over the disk.
    measurement::StackEvaluation stack_evaluation(
        configuration.topography, measurement::focus_planes_for(configuration.evaluate_on, configuration.trace.device),
        measurement::make_diffraction(configuration, instrument));
    bool any_light = false;
    const auto traced = scan::run_stack(*tracer, store, progress, {}, [&](int image, Grid<float> flux) {
        any_light = any_light || std::ranges::any_of(flux.values, [](float value) { return value > 0; });
        stack_evaluation.add({std::move(flux)}, positions[static_cast<std::size_t>(image)]);
    });
    spdlog::info("{} images traced, {} kept from before", traced.traced, traced.kept);
    if (!any_light) {
        spdlog::warn("No light reaches the detector in any image. vkfv --image of one position tells where it goes");
    }

    const auto& folder = store.folder();
    const auto evaluation = stack_evaluation.finish(measurement::truth_on_pixels(instrument, configuration, specimen),
                                                    configuration.band, flat);
    const nlohmann::ordered_json run = {{"device", tracer->identity().text()},
                                        {"stack_digest", store.description().digest},
                                        {"seed", configuration.trace.seed},
                                        {"images", positions.size()},
                                        {"rays_per_image", trace::launched_rays(configuration.trace, pixels)}};
    measurement::write_evaluation(store.results(), evaluation, run,
                                  measurement::stack_source(configuration, instrument),
                                  measurement::topography_files(configuration));

    fmt::print("{}", measurement::summary(evaluation));
    if (traced.traced > 0) {
        fmt::print("traced {} images in {:.3g} s ({}), evaluated in {:.2g} s\n", traced.traced, traced.trace_seconds,
                   ray_rate_text(static_cast<double>(traced.rays) / traced.trace_seconds), evaluation.seconds);
    }
    fmt::print("results in {}\n", folder.string());
}

} // namespace vkfv::app
