#include "app/commands.hpp"

#include "trace/stage_times.hpp"

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include <cstdio>

namespace vkfv::app {

void run_bench(const CommandOptions& options) {
    const auto configuration = load_configuration(options.file, options.overrides, Needs::exposure);
    if (configuration.trace.nonsequential) {
        throw InputError({.where = configuration.places.at("trace.mode"),
                          .key = "trace.mode",
                          .found = "\"nonsequential\"",
                          .expected = "the sequential trace, which has stages to be timed",
                          .remedy = "Use --set trace.mode=sequential, or time --image."});
    }
    const auto specimen = specimen::make(*configuration.specimen);
    const double in_focus = 0;
    const auto instrument = assemble_instrument(configuration, specimen, std::span(&in_focus, 1));
    const auto times = trace::time_stages(instrument, specimen, configuration.trace, in_focus, options.runs);
    const double rate = 1 / times.seconds_per_ray;
    if (options.json) {
        const nlohmann::ordered_json report = {
            {"device", times.description},
            {"rays_per_run", times.rays},
            {"runs", times.runs},
            {"rays_per_second", rate},
            {"spread", times.spread},
            {"seconds_per_1e9_rays", 1e9 * times.seconds_per_ray},
            {"share_source", times.source},
            {"share_illumination", times.illumination},
            {"share_specimen", times.specimen},
            {"share_imaging", times.imaging},
            {"share_detection", times.detection},
            {"surfaces_per_ray", times.surfaces_per_ray},
            {"surfaces_per_detected_ray", times.surfaces_per_detected_ray}};
        fmt::print("{}\n", report.dump(2));
        return;
    }
    fmt::print("{}\n"
               "  rays/s                 {:.4g}  (median of {} runs of {:.3g} rays, spread {:.1f} %)\n"
               "  seconds per 1e9 rays   {:.4g}\n"
               "  surfaces per ray       {:.2f} launched, {:.2f} detected\n"
               "  share of the time      source {:.1f} %, illumination {:.1f} %, specimen {:.1f} %, imaging {:.1f} %, "
               "detection {:.1f} %\n",
               times.description, rate, times.runs, static_cast<double>(times.rays), 100 * times.spread,
               1e9 * times.seconds_per_ray, times.surfaces_per_ray, times.surfaces_per_detected_ray,
               100 * times.source, 100 * times.illumination, 100 * times.specimen, 100 * times.imaging,
               100 * times.detection);
}

} // namespace vkfv::app
