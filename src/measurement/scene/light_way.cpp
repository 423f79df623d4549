#include "measurement/scene/light_way.hpp"

#include "trace/host/host_tracer.hpp"

#include <algorithm>
#include <cstdint>

namespace vkfv::measurement {

scan::MeanLedger light_way(const Configuration& configuration, const optics::Instrument& instrument,
                           const specimen::Specimen& specimen, const std::vector<double>& heights) {
    constexpr double share = 0.01, fewest = 1000, most = 20'000;
    trace::TraceOptions options = configuration.trace;
    const double of_stack = static_cast<double>(trace::launched_rays(options, configuration.instrument)) *
                            static_cast<double>(heights.size());
    options.rays = static_cast<std::uint64_t>(std::clamp(share * of_stack, fewest, most));
    options.estimator = trace::Estimator::forward;
    options.waves.reset();
    const auto tracer = trace::make_host_tracer(instrument, specimen, options);
    const trace::Image image = tracer->expose(heights[heights.size() / 2], 0);
    scan::MeanLedger ledger{.emitted = image.ledger.emitted, .shares = {}, .rays = image.rays};
    for (const auto& entry : image.ledger.entries) {
        ledger.shares.push_back({entry.name, entry.power});
    }
    return ledger;
}

} // namespace vkfv::measurement
