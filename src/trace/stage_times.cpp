#include "trace/stage_times.hpp"

#include "trace/forward_trace.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>

namespace vkfv::trace {

namespace {

double median(std::vector<double> values) {
    std::ranges::nth_element(values, values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2));
    return values[values.size() / 2];
}

} // namespace

StageTimes time_stages(const optics::Instrument& instrument, const specimen::Specimen& specimen,
                       const TraceOptions& options, double focal_height, int runs) {
    DeviceScene scene(instrument, specimen, options);
    scene.set_exposure(focal_height, 0);
    const std::uint32_t batch = suitable_batch(scene, options.batch, options.rays);
    const ForwardTrace whole(scene, batch);
    const ForwardTrace to_specimen(scene, batch, 1);
    const ForwardTrace to_departure(scene, batch, 2);
    const ForwardTrace occlusion(scene, batch, 0, 2);
    const ForwardTrace uncounted(scene, batch, 0, 1);

    // Both halves of one form of the trace, s.
    const auto time = [&](const ForwardTrace& trace) {
        vulkan::Commands commands(scene.device, 3);
        trace.clear(commands);
        trace.record(commands, 0, batch, true);
        commands.submit_and_wait();
        const auto stamps = commands.seconds();
        return std::array<double, 2>{stamps[1] - stamps[0], stamps[2] - stamps[1]};
    };
    for (const ForwardTrace* trace : {&whole, &to_specimen, &to_departure, &occlusion, &uncounted}) {
        time(*trace); // warm-up: compilation and idle clocks
    }
    std::vector<double> total, illumination, departure, first, second, hidden, imaged;
    for (int run = 0; run < runs; ++run) {
        const auto all = time(whole);
        total.push_back(all[0] + all[1]);
        first.push_back(all[0]);
        second.push_back(all[1]);
        illumination.push_back(time(to_specimen)[0]);
        departure.push_back(time(to_departure)[0]);
        hidden.push_back(time(occlusion)[1]);
        imaged.push_back(time(uncounted)[1]);
    }
    StageTimes result;
    result.description = fmt::format("{}; traversal {}", scene.device.choice(), scene.reason);
    result.rays = batch;
    result.runs = runs;
    const double whole_seconds = median(total);
    result.seconds_per_ray = whole_seconds / batch;
    const auto [least, most] = std::ranges::minmax(total);
    result.spread = (most - least) / whole_seconds;
    result.lenses = (median(illumination) + std::max(0.0, median(imaged) - median(hidden))) / whole_seconds;
    result.specimen = (median(first) - median(illumination) + median(hidden)) / whole_seconds;
    result.detector = std::max(0.0, median(second) - median(imaged)) / whole_seconds;

    // Crossings from the fates of one run: a path that ended at a surface has crossed those before it.
    vulkan::Commands commands(scene.device);
    whole.clear(commands);
    whole.record(commands, 0, batch);
    commands.submit_and_wait();
    const auto fates = whole.fates();
    const auto& constants = instrument.constants;
    using namespace physics::f64;
    const int both = constants.illumination_count + constants.imaging_count;
    double crossings = 0;
    for (std::size_t slot = 0; slot < fates.size(); ++slot) {
        int crossed = constants.illumination_count;
        if (slot >= PATH_STATUS_COUNT) {
            const int surface = static_cast<int>(slot - PATH_STATUS_COUNT) / SURFACE_STATUS_COUNT;
            crossed = surface < constants.imaging_first
                          ? surface - constants.illumination_first + 1
                          : constants.illumination_count + surface - constants.imaging_first + 1;
        } else if (slot == PATH_DETECTED || slot == PATH_OFF_DETECTOR) {
            crossed = both;
        }
        crossings += static_cast<double>(fates[slot]) * crossed;
    }
    result.surfaces_per_ray = crossings / batch;
    result.surfaces_per_detected_ray = both;
    return result;
}

} // namespace vkfv::trace
