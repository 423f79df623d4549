#include "app/commands.hpp"

#include "app/configuration_section.hpp"
#include "trace/device_tracer.hpp"
#include "trace/host_tracer.hpp"

#include <spdlog/spdlog.h>

#include <algorithm>
#include <cmath>

namespace vkfv::app {

namespace {

optics::Instrument assemble_at_its_place(const Configuration& configuration,
                                         const optics::InstrumentDescription& description) {
    optics::Instrument instrument;
    // The optics know keys, the configuration knows where they stand.
    at_its_place(configuration, {.file = configuration.file}, [&] { instrument = optics::assemble(description); });
    return instrument;
}

} // namespace

optics::Instrument assemble_instrument(const Configuration& configuration) {
    return assemble_at_its_place(configuration, configuration.instrument);
}

optics::Instrument assemble_instrument(const Configuration& configuration, const specimen::Specimen& specimen,
                                       std::span<const double> focal_heights) {
    auto description = configuration.instrument;
    const auto record = specimen::record(specimen, configuration.trace.max_bounces);
    description.greatest_defocus = 0;
    for (const double focal_height : focal_heights) {
        for (const double height : {record.top, record.bottom}) {
            description.greatest_defocus =
                std::max(description.greatest_defocus, std::abs(height - focal_height));
        }
    }
    if (description.ring) {
        description.ring->lit_radius = std::hypot(std::max(-record.x_min, record.x_max),
                                                  std::max(-record.y_min, record.y_max));
    }
    auto instrument = assemble_at_its_place(configuration, description);
    for (const auto& warning : instrument.warnings) {
        spdlog::warn(warning);
    }
    return instrument;
}

std::unique_ptr<trace::Tracer> make_tracer(const optics::Instrument& instrument,
                                           const specimen::Specimen& specimen,
                                           const trace::TraceOptions& options) {
    auto tracer = options.device == "host" ? trace::make_host_tracer(instrument, specimen, options)
                                           : trace::make_device_tracer(instrument, specimen, options);
    spdlog::info("{}", tracer->description());
    return tracer;
}

std::string identity_of_tracer(const trace::Tracer& tracer, const trace::TraceOptions& options) {
    return options.device == "host" ? "host" : tracer.description();
}

surface::HeightMap truth_on_pixels(const optics::Instrument& instrument, const Configuration& configuration,
                                   const specimen::Specimen& specimen) {
    const int pixels = configuration.instrument.detector_pixels;
    const double pitch = instrument.first_order.pixel_pitch;
    const double first = -0.5 * (pixels - 1) * pitch; // the axis meets the detector's centre
    return specimen::truth(specimen, pixels, pixels, first, first, pitch, pitch);
}

} // namespace vkfv::app
