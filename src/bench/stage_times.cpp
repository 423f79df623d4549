#include "bench/stage_times.hpp"

#include "bench/bench_scene.hpp"
#include "trace/device/forward_trace.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <chrono>

namespace vkfv::bench {

namespace {

constexpr std::chrono::milliseconds warm_up{500}; // time in which the clocks of an idle GPU rise

} // namespace

StageTimes time_stages(const optics::Instrument& instrument, const specimen::Specimen& specimen,
                       const trace::TraceOptions& options, double focal_height, int runs) {
    trace::DeviceScene scene = trace::make_device_scene(instrument, specimen, options);
    const std::uint32_t batch = trace::suitable_batch(scene, options);
    scene.order_emission(batch); // the batch is then one image
    trace::ExposureMemory exposure = scene.exposure_memory();
    scene.write_exposure(exposure, focal_height, 0);
    const trace::ForwardTrace whole(scene, batch);
    const trace::ForwardTrace emission(scene, batch, kernels::STOP_AFTER_SOURCE);
    const trace::ForwardTrace to_specimen(scene, batch, kernels::STOP_AFTER_TRAIN);
    const trace::ForwardTrace occlusion(scene, batch, kernels::STOP_NOWHERE, kernels::STOP_AFTER_SPECIMEN);
    const trace::ForwardTrace uncounted(scene, batch, kernels::STOP_NOWHERE, kernels::STOP_AFTER_TRAIN);

    // Times of both halves of one form of the trace, s.
    const auto time = [&](const trace::ForwardTrace& trace) {
        vulkan::Commands commands(*scene.device, 3);
        scene.give_emission_order(commands, exposure);
        trace.clear(commands);
        trace.record(commands, exposure, 0, batch, true);
        commands.submit_and_wait();
        const auto stamps = commands.seconds();
        return std::array<double, 2>{stamps[1] - stamps[0], stamps[2] - stamps[1]};
    };
    for (const trace::ForwardTrace* trace : {&emission, &to_specimen, &occlusion, &uncounted, &whole}) {
        time(*trace); // some drivers compile at the first use
    }
    const auto start = std::chrono::steady_clock::now();
    while (std::chrono::steady_clock::now() - start < warm_up) {
        time(whole);
    }
    std::vector<double> total, first, second, emitted, illuminated, hidden, imaged;
    for (int run = 0; run < runs; ++run) {
        const auto all = time(whole);
        total.push_back(all[0] + all[1]);
        first.push_back(all[0]);
        second.push_back(all[1]);
        emitted.push_back(time(emission)[0]);
        illuminated.push_back(time(to_specimen)[0]);
        hidden.push_back(time(occlusion)[1]);
        imaged.push_back(time(uncounted)[1]);
    }
    StageTimes result;
    result.description = fmt::format("{}; traversal {}", scene.device->choice(), scene.traversal.reason);
    result.rays = batch;
    result.runs = runs;
    const double whole_seconds = median(total);
    result.seconds_per_ray = whole_seconds / batch;
    const auto [least, most] = std::ranges::minmax(total);
    result.spread = (most - least) / whole_seconds;
    const auto share = [&](double seconds) { return std::max(0.0, seconds) / whole_seconds; };
    result.source = share(median(emitted));
    result.illumination = share(median(illuminated) - median(emitted));
    result.specimen = share(median(first) - median(illuminated) + median(hidden));
    result.imaging = share(median(imaged) - median(hidden));
    result.detection = share(median(second) - median(imaged));

    vulkan::Commands commands(*scene.device);
    whole.clear(commands);
    whole.record(commands, exposure, 0, batch);
    commands.submit_and_wait();
    const auto fates = whole.fates().read_values<std::uint64_t>(scene.accounts.ledger_numbers());
    const trace::Image image = scene.accounts.image({}, fates, batch);
    result.surfaces_per_ray = image.crossings / batch;
    result.surfaces_per_detected_ray = instrument.constants.illumination_count + instrument.constants.imaging_count;
    return result;
}

} // namespace vkfv::bench
