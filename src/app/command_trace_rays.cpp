#include "app/commands.hpp"
#include "measurement/image/ray_table.hpp"
#include "measurement/scene/assembly.hpp"

#include <fmt/format.h>

#include <cstdio>

namespace vkfv::app {

namespace {

struct TraceRaysOptions {
    std::filesystem::path rays;
    bool float_precision = false; // on the device
    bool apertures = true;        // stop rays
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
    return {.name = "trace-rays",
            .summary = "Trace given rays (x_mm,y_mm,z_mm,l,m,n) from the specimen to the detector; CSV on standard "
                       "output",
            .operands = {{"C.toml", "Configuration", into(&CommandOptions::file)},
                         {"IN.csv", "A ray a line", into(&TraceRaysOptions::rays)}},
            .options = together({configuration_options(), {precision, apertures}}),
            .run = run_trace_rays,
            .example = "vkfv trace-rays assets/stacks/demo.toml rays.csv"};
}

void run_trace_rays(const CommandOptions& options) {
    const auto own = options.of<TraceRaysOptions>();
    const auto configuration = load_configuration(options.file, options.overrides, Needs::instrument);
    const auto rays = measurement::read_ray_table(own.rays);
    const auto instrument = measurement::assemble_instrument(configuration);
    const auto traced = own.float_precision
                            ? trace::trace_rays_on_device(instrument, rays, own.apertures, configuration.trace.device)
                            : trace::trace_rays_on_host(instrument, rays, own.apertures);
    fmt::print("{}", measurement::ray_table_text(traced));
}

} // namespace vkfv::app
