#include "app/commands.hpp"
#include "core/messages/safe_text.hpp"
#include "measurement/image/ray_table.hpp"
#include "measurement/scene/assembly.hpp"

#include <fmt/format.h>

#include <cstdio>

namespace vkfv::app {

namespace {

constexpr const char* paraxial = "paraxial";
constexpr const char* best_focus = "best-focus";

struct TraceRaysOptions {
    std::filesystem::path rays;
    bool float_precision = false; // trace in float on the device
    bool apertures = true;        // apertures stop rays
    bool from_best_focus = false; // origin of the rays' z; otherwise the paraxial object plane
};

} // namespace

Command trace_rays_command() {
    const Option precision = {.name = "--precision",
                              .value = "NAME",
                              .description = "In double on the host, or in float on the device",
                              .target = Take<std::string>([](CommandOptions& options, const std::string& name) {
                                  options.of<TraceRaysOptions>().float_precision = name == "float";
                              }),
                              .fallback = "double",
                              .choices = {"double", "float"}};
    const Option apertures = {.name = "--apertures",
                              .value = "SWITCH",
                              .description = "Whether apertures stop rays",
                              .target = into(&TraceRaysOptions::apertures),
                              .fallback = "on",
                              .choices = {"on", "off"}};
    const Option origin = {.name = "--origin",
                           .value = "PLANE",
                           .description =
                               "Where z_mm of the rays is 0: the paraxial object plane, or best focus, where z "
                               "of a scan is 0; the last column of the output tells it",
                           .target = Take<std::string>([](CommandOptions& options, const std::string& name) {
                               options.of<TraceRaysOptions>().from_best_focus = name == best_focus;
                           }),
                           .fallback = paraxial,
                           .choices = {paraxial, best_focus}};
    return {.name = "trace-rays",
            .summary =
                "Trace given rays (x_mm,y_mm,z_mm,l,m,n) from the specimen to the detector; z_mm counts from the "
                "paraxial object plane (--origin); CSV on standard output",
            .operands = {{"C.toml", "Configuration", into(&CommandOptions::file)},
                         {"IN.csv", "A ray a line", into(&TraceRaysOptions::rays)}},
            .options = together({configuration_options(), {precision, apertures, origin}}),
            .run = run_trace_rays,
            .example = "vkfv trace-rays assets/stacks/demo.toml rays.csv"};
}

void run_trace_rays(const CommandOptions& options) {
    const auto own = options.of<TraceRaysOptions>();
    const auto configuration = load_configuration(options.file, options.overrides, Needs::instrument);
    auto rays = measurement::read_ray_table(own.rays);
    const auto instrument = measurement::assemble_instrument(configuration);
    for (trace::RayInput& ray : rays) {
        ray.z += own.from_best_focus ? instrument.first_order.best_focus_offset : 0;
    }
    const auto traced = own.float_precision
                            ? trace::trace_rays_on_device(instrument, rays, own.apertures, configuration.trace.device)
                            : trace::trace_rays_on_host(instrument, rays, own.apertures);
    print_text(measurement::ray_table_text(traced, own.from_best_focus ? best_focus : paraxial));
}

} // namespace vkfv::app
