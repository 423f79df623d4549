#include "app/commands.hpp"
#include "measurement/assembly.hpp"
#include "measurement/ray_table.hpp"

#include <fmt/format.h>

#include <cstdio>

namespace vkfv::app {

Command trace_rays_command() {
    const Option precision = {.name = "--precision",
                              .value = "NAME",
                              .description = "In double on the host, or in float on the device",
                              .target = Take<std::string>([](CommandOptions& options, const std::string& name) {
                                  options.float_precision = name == "float";
                              }),
                              .fallback = "double",
                              .choices = {"double", "float"}};
    const Option apertures = {.name = "--apertures",
                              .value = "SWITCH",
                              .description = "Whether apertures stop rays",
                              .target = Take<bool>([](CommandOptions& options, bool on) { options.apertures = on; }),
                              .fallback = "on",
                              .choices = {"on", "off"}};
    return {.name = "trace-rays",
            .summary = "Trace given rays (x_mm,y_mm,z_mm,l,m,n) from the specimen to the detector; CSV on standard "
                       "output",
            .operands = {{"C.toml", "Configuration", &CommandOptions::file},
                         {"IN.csv", "A ray a line", &CommandOptions::rays_file}},
            .options = together({configuration_options(), {precision, apertures}}),
            .run = run_trace_rays,
            .example = "vkfv trace-rays assets/stacks/demo.toml rays.csv"};
}

void run_trace_rays(const CommandOptions& options) {
    const auto configuration = load_configuration(options.file, options.overrides, Needs::instrument);
    const auto rays = measurement::read_ray_table(options.rays_file);
    const auto instrument = measurement::assemble_instrument(configuration);
    const auto traced = options.float_precision ? trace::trace_rays_on_device(instrument, rays, options.apertures,
                                                                              configuration.trace.device)
                                                : trace::trace_rays_on_host(instrument, rays, options.apertures);
    fmt::print("{}", measurement::ray_table_text(traced));
}

} // namespace vkfv::app
