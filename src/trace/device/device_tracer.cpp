#include "trace/device/device_tracer.hpp"

#include "trace/device/backward_trace.hpp"
#include "trace/device/device_estimate.hpp"
#include "trace/device/device_exposures.hpp"
#include "trace/device/device_mixture.hpp"
#include "trace/device/device_numbers.hpp"
#include "trace/device/forward_trace.hpp"
#include "trace/device/nonsequential_trace.hpp"
#include "trace/device/traced_exposure.hpp"
#include "trace/device/wave_memory.hpp"
#include "trace/interface/light_sources.hpp"
#include "trace/interface/traced_instrument.hpp"

#include "spirv/probe_nonsequential_bvh.h"
#include "spirv/probe_nonsequential_ray_query.h"
#include "spirv/probe_paths_bvh.h"
#include "spirv/probe_paths_quadtree.h"
#include "spirv/probe_paths_ray_query.h"

#include <fmt/format.h>

#include <algorithm>
#include <utility>

namespace vkfv::trace {

namespace {

// Most batches a submission: waiting for each costs a GPU 60 us, and a software device's dispatch is long enough.
constexpr std::uint32_t batches_per_submission_gpu = 8;

class DeviceTracer final : public DeviceExposures {
  public:
    DeviceTracer(const optics::Instrument& instrument, const specimen::Specimen& specimen, const TraceOptions& options)
        : instrument_(instrument), rays_(options.rays),
          scene_(make_device_scene(instrument_, specimen, options, &instrument_)),
          memories_(scene_.exposure_memories()), trace_(make_trace(scene_, options)),
          estimate_(*scene_.device, scene_.accounts.rule(rays_), instrument_.detector_pixels(),
                    {.pixels = trace_->pixels(),
                     .further = &trace_->fates(),
                     .waves = scene_.waves.get(),
                     .waves_scale = scene_.accounts.power_per_number(rays_)}),
          numbers_(*scene_.device, trace_->counted()),
          pace_(std::uint64_t{trace_->batch()} * (scene_.software() ? 1 : batches_per_submission_gpu)) {}

    std::string description() const override {
        return fmt::format("{}; traversal {}", scene_.device->choice(), scene_.traversal.reason);
    }

    TracerIdentity identity() const override { return scene_.identity(); }
    std::shared_ptr<const vulkan::Device> device() const override { return scene_.device; }
    std::vector<optics::PupilFilter> pupil_filters() const override { return filters_of(scene_.filter()); }
    std::uint64_t units() const override { return rays_; }
    std::unique_ptr<DeviceExposure> prepare(FocalPosition position, std::uint32_t image,
                                            std::size_t slot) const override;
    std::size_t slots() const override { return scene_.exposures_at_a_time(); }

  private:
    class Exposure;

    static std::unique_ptr<PathTrace> make_trace(const DeviceScene& scene, const TraceOptions& options) {
        const std::uint32_t batch = suitable_batch(scene, options);
        if (options.nonsequential) {
            return std::make_unique<NonsequentialTrace>(scene, batch);
        }
        return std::make_unique<ForwardTrace>(scene, batch);
    }

    optics::Instrument instrument_;
    std::uint64_t rays_;
    DeviceScene scene_;
    mutable std::vector<ExposureMemory> memories_; // prepare() writes its slot's memory, which its caller alone uses
    std::unique_ptr<PathTrace> trace_;
    DeviceEstimate estimate_;
    DeviceNumbers numbers_;
    mutable DispatchPace pace_;
};

class DeviceTracer::Exposure final : public TracedExposure {
  public:
    Exposure(const DeviceTracer& tracer, std::size_t slot)
        : TracedExposure({.scene = tracer.scene_,
                          .memory = tracer.memories_[slot],
                          .estimate = tracer.estimate_,
                          .numbers = tracer.numbers_,
                          .pace = tracer.pace_,
                          .slot = slot}),
          tracer_(tracer) {}

    std::uint64_t submit(std::uint64_t first, std::uint64_t end) override {
        const PathTrace& trace = *tracer_.trace_;
        vulkan::Commands& commands = open(trace);
        end = std::min(end, first + tracer_.pace_.paths());
        for (std::uint64_t path = first; path < end; path += trace.batch()) {
            trace.record(commands, of.memory, path,
                         static_cast<std::uint32_t>(std::min<std::uint64_t>(trace.batch(), end - path)));
        }
        close(end - first);
        return end;
    }

    Image finish() override {
        work.wait();
        return of.scene.accounts.image(of.estimate.estimated(of.slot).pixels, of.estimate.further(of.slot),
                                       tracer_.rays_);
    }

  private:
    const DeviceTracer& tracer_;
};

std::unique_ptr<DeviceExposure> DeviceTracer::prepare(FocalPosition position, std::uint32_t image,
                                                      std::size_t slot) const {
    scene_.write_exposure(memories_.at(slot), position, image);
    return std::make_unique<Exposure>(*this, slot);
}

} // namespace

std::unique_ptr<Tracer> make_device_tracer(const optics::Instrument& described, const specimen::Specimen& specimen,
                                           const TraceOptions& options) {
    std::vector<std::unique_ptr<DeviceExposures>> tracers;
    const auto opened = opened_by(options);
    for (auto& light : one_by_one(as_traced(described, options), options)) {
        light.options.opened = opened;
        if (options.estimator == Estimator::backward) {
            tracers.push_back(make_backward_tracer(light.instrument, specimen, light.options));
        } else {
            tracers.push_back(std::make_unique<DeviceTracer>(light.instrument, specimen, light.options));
        }
    }
    return tracers.size() == 1 ? std::move(tracers.front()) : mix_on_device(std::move(tracers));
}

namespace {

TracerIdentity expected_identity_of(const optics::Instrument& instrument, const specimen::Specimen& specimen,
                                    const TraceOptions& options) {
    const optics::Instrument traced =
        options.estimator == Estimator::backward ? optics::turned_round(instrument) : instrument;

    const auto& waves = options.nonsequential ? std::nullopt : options.waves;
    if (options.device == "host") {
        return host_identity(traced, waves ? LightSorting::of(optics::resolved(*waves, instrument)) : LightSorting());
    }
    const auto reports = vulkan::list_devices();
    const auto& report = reports[vulkan::choose_device(reports, {options.device})];
    const auto traversal = choose_traversal(report, specimen, options.traversal, options.nonsequential).traversal;
    LightSorting sorting;
    if (waves) {
        sorting = LightSorting::of(waves_on_device(*waves, instrument, report));
    }
    return device_identity(report, traversal_name(traversal), traced, sorting);
}

} // namespace

TracerIdentity expected_identity(const optics::Instrument& described, const specimen::Specimen& specimen,
                                 const TraceOptions& options) {
    std::vector<TracerIdentity> identities;
    for (const auto& light : one_by_one(as_traced(described, options), options)) {
        identities.push_back(expected_identity_of(light.instrument, specimen, light.options));
    }
    return mixed_identity(identities);
}

std::vector<PathEnd> device_paths(const optics::Instrument& instrument, const specimen::Specimen& specimen,
                                  const TraceOptions& options, FocalPosition position, std::uint32_t image,
                                  std::uint64_t first, std::uint32_t count) {
    const DeviceScene scene = make_device_scene(instrument, specimen, options);
    ExposureMemory exposure = scene.exposure_memory();
    scene.write_exposure(exposure, position, image);
    const vulkan::Buffer ends(*scene.device, count * sizeof(kernels::PathEnd));
    const bool nonsequential = options.nonsequential;
    const vulkan::Kernel kernel(
        *scene.device, "probe_paths",
        scene.variant(nonsequential ? KernelVariants{.quadtree = {},
                                                     .software = {},
                                                     .ray_query = probe_nonsequential_ray_query,
                                                     .bvh = probe_nonsequential_bvh}
                                    : KernelVariants{.quadtree = probe_paths_quadtree,
                                                     .software = probe_paths_quadtree,
                                                     .ray_query = probe_paths_ray_query,
                                                     .bvh = probe_paths_bvh}),
        nonsequential ? scene.declarations({kernels::BINDING_FOUND})
                      : scene.declarations(
                            {kernels::BINDING_FOUND, kernels::BINDING_EMISSION_CELLS, kernels::BINDING_EMISSION_FIRST}),
        nonsequential ? sizeof(kernels::NonsequentialBatch) : sizeof(kernels::Batch), scene.kernel_constants());
    vulkan::Commands commands(*scene.device);
    const std::uint32_t groups = (count + 63) / 64;
    if (nonsequential) {
        commands.dispatch(kernel, scene.bindings(exposure, {{kernels::BINDING_FOUND, &ends}}),
                          make_nonsequential_batch(scene, first, count), groups);
    } else {
        scene.give_emission_order(commands, exposure);
        commands.dispatch(kernel,
                          scene.bindings(exposure, {{kernels::BINDING_FOUND, &ends},
                                                    {kernels::BINDING_EMISSION_CELLS, &scene.emission->given},
                                                    {kernels::BINDING_EMISSION_FIRST, &scene.emission->first_paths}}),
                          make_batch(first, count), groups);
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
