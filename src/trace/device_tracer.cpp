#include "trace/device_tracer.hpp"

#include "trace/backward_trace.hpp"
#include "trace/forward_trace.hpp"
#include "trace/nonsequential_trace.hpp"
#include "trace/scene_waves.hpp"
#include "trace/wave_memory.hpp"

#include "spirv/probe_nonsequential_bvh.h"
#include "spirv/probe_nonsequential_ray_query.h"
#include "spirv/probe_paths_bvh.h"
#include "spirv/probe_paths_quadtree.h"
#include "spirv/probe_paths_ray_query.h"

#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <mutex>

namespace vkfv::trace {

namespace {

// Batches a submission: waiting for each costs a GPU 60 us, and a software device's dispatch is long enough.
constexpr std::uint32_t batches_per_submission_gpu = 8;

class DeviceTracer final : public Tracer {
  public:
    DeviceTracer(const optics::Instrument& instrument, const specimen::Specimen& specimen, const TraceOptions& options)
        : instrument_(instrument), rays_(options.rays),
          scene_(make_device_scene(instrument_, specimen, options, &instrument_)), trace_(make_trace(scene_, options)) {
        if (scene_.filter) {
            waves_.emplace(scene_);
        }
    }

    Image expose(double focal_height, std::uint32_t image) const override {
        const std::scoped_lock lock(mutex_);
        const auto start = std::chrono::steady_clock::now();
        scene_.set_exposure(focal_height, image);
        const std::uint64_t per_submission =
            std::uint64_t{trace_->batch()} * (scene_.software() ? 1 : batches_per_submission_gpu);
        double device_seconds = 0;
        for (std::uint64_t first = 0; first < rays_; first += per_submission) {
            vulkan::Commands commands(*scene_.device, 2);
            commands.timestamp();
            if (first == 0) {
                trace_->clear(commands);
                scene_.clear_cell_light(commands);
            }
            const std::uint64_t end = std::min(rays_, first + per_submission);
            for (std::uint64_t path = first; path < end; path += trace_->batch()) {
                trace_->record(commands, path,
                               static_cast<std::uint32_t>(std::min<std::uint64_t>(trace_->batch(), end - path)));
            }
            commands.timestamp();
            commands.submit_and_wait();
            device_seconds += commands.seconds()[1];
        }
        Image result = scene_.accounts.image(trace_->pixels(), trace_->fates(), rays_);
        if (waves_) {
            const auto light = waves_->light();
            device_seconds += light.device_seconds;
            result =
                with_waves(std::move(result), light.pixels, scene_.accounts.power_per_number(rays_), *scene_.filter);
        }
        result.device_seconds = device_seconds;
        result.seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
        return result;
    }

    std::string description() const override {
        return fmt::format("{}; traversal {}", scene_.device->choice(), scene_.traversal.reason);
    }

    TracerIdentity identity() const override { return scene_.identity(); }
    const optics::PupilFilter* pupil_filter() const override { return scene_.filter ? &*scene_.filter : nullptr; }

  private:
    static std::unique_ptr<PathTrace> make_trace(const DeviceScene& scene, const TraceOptions& options) {
        const std::uint32_t batch = suitable_batch(scene, options.batch, options.rays);
        if (options.nonsequential) {
            return std::make_unique<NonsequentialTrace>(scene, batch);
        }
        return std::make_unique<ForwardTrace>(scene, batch);
    }

    optics::Instrument instrument_;
    std::uint64_t rays_;
    mutable std::mutex mutex_; // one exposure at a time: the buffers are shared
    mutable DeviceScene scene_;
    std::unique_ptr<PathTrace> trace_;
    std::optional<SceneWaves> waves_;
};

} // namespace

std::unique_ptr<Tracer> make_device_tracer(const optics::Instrument& instrument, const specimen::Specimen& specimen,
                                           const TraceOptions& options) {
    if (options.estimator == Estimator::backward) {
        return make_backward_tracer(instrument, specimen, options);
    }
    return std::make_unique<DeviceTracer>(instrument, specimen, options);
}

TracerIdentity expected_identity(const optics::Instrument& instrument, const specimen::Specimen& specimen,
                                 const TraceOptions& options) {
    const optics::Instrument traced =
        options.estimator == Estimator::backward ? optics::turned_round(instrument) : instrument;
    const auto& waves = options.nonsequential ? std::nullopt : options.waves;
    if (options.device == "host") {
        return host_identity(traced, waves ? optics::parts_of(*waves, instrument) : 0);
    }
    const auto reports = vulkan::list_devices();
    const auto& report = reports[vulkan::choose_device(reports, {options.device})];
    const auto traversal = choose_traversal(report, specimen, options.traversal, options.nonsequential).traversal;
    return device_identity(report, traversal_name(traversal), traced,
                           waves ? waves_on_device(*waves, instrument, report).parts : 0);
}

std::vector<PathEnd> device_paths(const optics::Instrument& instrument, const specimen::Specimen& specimen,
                                  const TraceOptions& options, double focal_height, std::uint32_t image,
                                  std::uint64_t first, std::uint32_t count) {
    DeviceScene scene = make_device_scene(instrument, specimen, options);
    scene.set_exposure(focal_height, image);
    const vulkan::Buffer ends(*scene.device, count * sizeof(kernels::PathEnd));
    const bool nonsequential = options.nonsequential;
    const vulkan::Kernel kernel(
        *scene.device, "probe_paths",
        nonsequential ? scene.variant({}, probe_nonsequential_ray_query, probe_nonsequential_bvh)
                      : scene.variant(probe_paths_quadtree, probe_paths_ray_query, probe_paths_bvh),
        scene.declarations({kernels::BINDING_FOUND}),
        nonsequential ? sizeof(kernels::NonsequentialBatch) : sizeof(kernels::Batch), scene.kernel_constants());
    vulkan::Commands commands(*scene.device);
    const std::uint32_t groups = (count + 63) / 64;
    const auto bindings = scene.bindings({{kernels::BINDING_FOUND, &ends}});
    if (nonsequential) {
        commands.dispatch(kernel, bindings, make_nonsequential_batch(scene, first, count), groups);
    } else {
        commands.dispatch(kernel, bindings, make_batch(first, count), groups);
    }
    commands.barrier();
    commands.submit_and_wait();
    std::vector<PathEnd> result;
    result.reserve(count);
    for (const kernels::PathEnd& end : ends.read_values<kernels::PathEnd>(count)) {
        result.push_back({end.status, end.surface, end.x, end.y, end.weight});
    }
    return result;
}

} // namespace vkfv::trace
