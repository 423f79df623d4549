#include "app/commands.hpp"
#include "measurement/assembly.hpp"
#include "measurement/ray_table.hpp"

#include <fmt/format.h>

#include <cstdio>

namespace vkfv::app {

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
