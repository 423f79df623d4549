#include "trace/device/backward_trace.hpp"

#include "spirv/backward_bvh.h"
#include "spirv/backward_quadtree.h"
#include "spirv/backward_ray_query.h"
#include "spirv/backward_software.h"
#include "spirv/backward_specialised_bvh.h"
#include "spirv/backward_specialised_quadtree.h"
#include "spirv/backward_specialised_ray_query.h"
#include "spirv/backward_specialised_software.h"
#include "trace/device/device_estimate.hpp"
#include "trace/device/device_numbers.hpp"
#include "trace/device/traced_exposure.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <string>
#include <utility>

namespace vkfv::trace {

namespace {

constexpr std::uint32_t most_points_per_chunk = 32;
constexpr std::uint32_t workgroup = 128;
constexpr std::uint64_t most_paths = std::uint64_t{1} << 27; // largest submission; on slower devices the pace limits it

std::uint32_t pixel_count(const DeviceScene& scene) {
    return static_cast<std::uint32_t>(scene.instrument.detector_pixels().count());
}

// The distance between the sums of two randomisations, aligned so that a kernel can be bound to one of them.
std::size_t stride_of(std::size_t pixels) {
    constexpr std::size_t aligned = vulkan::binding_alignment / sizeof(std::uint64_t);
    return (pixels + aligned - 1) / aligned * aligned;
}

std::vector<vulkan::BindingDeclaration> declarations(const DeviceScene& scene) {
    auto all = scene.declarations({kernels::BINDING_PIXELS});
    all.push_back({kernels::BINDING_BACKWARD, vulkan::BindingKind::uniform_buffer});
    return all;
}

// Mesa 22's software Vulkan (22.3.6 of Debian 12) crashes on kernels that sample the source's rim by itself. There the
// whole source is sampled as one: the same image on average, with somewhat more noise.
physics::f64::BackwardOptics on_device(const vulkan::Device& device, physics::f64::BackwardOptics optics) {
    if (vulkan::is_software(device.report()) && device.report().driver.find("Mesa 22.") != std::string::npos) {
        optics.rim_period = 0;
    }
    return optics;
}

std::vector<vulkan::SpecializationConstant> constants(const DeviceScene& scene,
                                                      const physics::f64::BackwardOptics& optics) {
    // The kernel traces the way to the source by a loop, so only the illumination's surfaces are constants.
    const auto& trains = scene.instrument.constants;
    auto all = scene.specialised ? scene.specialised_constants(trains.illumination_first, trains.illumination_count)
                                 : scene.kernel_constants();
    all.push_back({kernels::CONSTANT_CONE_CANDIDATES, optics.cone_candidates});
    all.push_back({kernels::CONSTANT_LOBE_CANDIDATES, optics.lobe_candidates});
    all.push_back({kernels::CONSTANT_SURE_CANDIDATES, optics.sure_candidates});
    all.push_back({kernels::CONSTANT_RIM_PERIOD, optics.rim_period});
    constexpr std::uint32_t queries_at_hand = 11;
    all.push_back({kernels::CONSTANT_QUERY_CAPACITY,
                   queries_at_hand + static_cast<std::uint32_t>(scene.constants.specimen.max_bounces)});
    return all;
}

std::span<const std::uint32_t> variant(const DeviceScene& scene) {
    return scene.variant(scene.specialised ? KernelVariants{.quadtree = backward_specialised_quadtree,
                                                            .software = backward_specialised_software,
                                                            .ray_query = backward_specialised_ray_query,
                                                            .bvh = backward_specialised_bvh}
                                           : KernelVariants{.quadtree = backward_quadtree,
                                                            .software = backward_software,
                                                            .ray_query = backward_ray_query,
                                                            .bvh = backward_bvh});
}

} // namespace

BackwardTrace::BackwardTrace(const DeviceScene& scene, const physics::f64::BackwardOptics& optics,
                             const BackwardPlan& plan, const TraceOptions& options)
    : scene_(scene), pixels_(pixel_count(scene)), stride_(stride_of(pixels_)),
      points_per_chunk_(std::min(plan.points, most_points_per_chunk)),
      sums_(*scene.device, plan.randomisations * stride_ * sizeof(std::uint64_t)),
      optics_(*scene.device, sizeof(kernels::BackwardBlock)),
      kernel_(*scene.device, "backward", variant(scene), declarations(scene), sizeof(kernels::BackwardBatch),
              constants(scene, optics)) {
    const kernels::BackwardBlock block{to_float(optics), to_float(plan.lattice())};
    optics_.write_values(std::span<const kernels::BackwardBlock>(&block, 1));
    chunks_ = std::uint64_t{plan.points / points_per_chunk_} * pixels_;
    const std::uint64_t most = (options.batch > 0 ? options.batch : most_paths) / options.batch_divisor;
    most_chunks_at_a_time_ =
        static_cast<std::uint32_t>(std::clamp<std::uint64_t>(most / points_per_chunk_, 1, chunks_));
}

void BackwardTrace::clear(vulkan::Commands& commands) const {
    commands.fill_zero(sums_);
    commands.barrier();
}

void BackwardTrace::record(vulkan::Commands& commands, const ExposureMemory& exposure, std::uint32_t randomisation,
                           std::uint64_t first, std::uint32_t count) const {
    auto bindings = scene_.bindings(exposure, {{.slot = kernels::BINDING_PIXELS,
                                                .resource = &sums_,
                                                .first_byte = randomisation * stride_ * sizeof(std::uint64_t),
                                                .bytes = pixels_ * sizeof(std::uint64_t)},
                                               {kernels::BINDING_BACKWARD, &optics_}});
    const kernels::BackwardBatch batch{static_cast<std::uint32_t>(first / pixels_),
                                       static_cast<std::uint32_t>(first % pixels_), count, points_per_chunk_,
                                       randomisation};
    const auto groups = vulkan::groups_of(count, workgroup);
    commands.dispatch(kernel_, bindings, batch, groups.x, groups.y);
    commands.barrier();
}

namespace {

class BackwardTracer final : public DeviceExposures {
  public:
    BackwardTracer(const optics::Instrument& instrument, const specimen::Specimen& specimen,
                   const TraceOptions& options)
        : instrument_(instrument), turned_(optics::turned_round(instrument)),
          plan_(backward_plan(options.rays, instrument.detector_pixels())),
          scene_(make_device_scene(turned_, specimen, options, &instrument_)), memories_(scene_.exposure_memories()),
          trace_(scene_, on_device(*scene_.device, backward_optics(instrument_, scene_.host_record.material, plan_)),
                 plan_, options),
          accounts_(instrument_, plan_), estimate_(*scene_.device, accounts_.rule(), instrument_.detector_pixels(),
                                                   {.pixels = trace_.sums(),
                                                    .stride = trace_.stride(),
                                                    .waves = scene_.waves.get(),
                                                    .waves_scale = accounts_.power_per_number(),
                                                    .asks_for_power = true}),
          numbers_(*scene_.device, counted()),
          pace_(std::uint64_t{trace_.most_chunks_at_a_time()} * trace_.points_per_chunk()) {}

    std::string description() const override {
        return fmt::format("{}; traversal {}; backward", scene_.device->choice(), scene_.traversal.reason);
    }

    TracerIdentity identity() const override { return scene_.identity(); }
    std::shared_ptr<const vulkan::Device> device() const override { return scene_.device; }
    std::vector<optics::PupilFilter> pupil_filters() const override { return filters_of(scene_.filter()); }
    std::uint64_t units() const override { return plan_.randomisations * trace_.chunks(); }
    std::uint64_t rays_per_unit() const override { return trace_.points_per_chunk(); }
    std::unique_ptr<DeviceExposure> prepare(FocalPosition position, std::uint32_t image,
                                            std::size_t slot) const override;
    std::size_t slots() const override { return scene_.exposures_at_a_time(); }

  private:
    class Exposure;

    // All buffers of counts of an exposure, including the light that is sorted for waves.
    std::vector<const vulkan::Buffer*> counted() const {
        std::vector<const vulkan::Buffer*> buffers = scene_.light_buffers();
        buffers.push_back(&trace_.sums());
        return buffers;
    }

    optics::Instrument instrument_;
    optics::Instrument turned_;
    BackwardPlan plan_;
    DeviceScene scene_;
    mutable std::vector<ExposureMemory> memories_; // prepare() writes its slot's memory, which its caller alone uses
    BackwardTrace trace_;
    BackwardAccounts accounts_;
    DeviceEstimate estimate_;
    DeviceNumbers numbers_;
    mutable DispatchPace pace_;
};

// The units of work are the chunks of one randomisation after the other.
class BackwardTracer::Exposure final : public TracedExposure {
  public:
    Exposure(const BackwardTracer& tracer, std::size_t slot)
        : TracedExposure({.scene = tracer.scene_,
                          .memory = tracer.memories_[slot],
                          .estimate = tracer.estimate_,
                          .numbers = tracer.numbers_,
                          .pace = tracer.pace_,
                          .slot = slot}),
          tracer_(tracer) {}

    std::uint64_t submit(std::uint64_t first, std::uint64_t end) override {
        const BackwardTrace& trace = tracer_.trace_;
        const auto randomisation = static_cast<std::uint32_t>(first / trace.chunks());
        const std::uint64_t begin = randomisation * trace.chunks();
        const std::uint64_t most = std::max<std::uint64_t>(1, tracer_.pace_.paths() / trace.points_per_chunk());
        end = std::min({end, begin + trace.chunks(), first + most});
        trace.record(open(trace), of.memory, randomisation, first - begin, static_cast<std::uint32_t>(end - first));
        close((end - first) * trace.points_per_chunk());
        return end;
    }

    Image finish() override {
        work.wait();
        auto estimated = of.estimate.estimated(of.slot);
        Image image = tracer_.accounts_.image(std::move(estimated.pixels), estimated.power.value());
        // Only crossings of the imaging train are counted; continuations to the source are not.
        image.crossings = static_cast<double>(image.rays) * tracer_.turned_.constants.illumination_count;
        return image;
    }

  private:
    const BackwardTracer& tracer_;
};

std::unique_ptr<DeviceExposure> BackwardTracer::prepare(FocalPosition position, std::uint32_t image,
                                                        std::size_t slot) const {
    scene_.write_exposure(memories_.at(slot), position, image);
    return std::make_unique<Exposure>(*this, slot);
}

} // namespace

std::unique_ptr<DeviceExposures> make_backward_tracer(const optics::Instrument& instrument,
                                                      const specimen::Specimen& specimen, const TraceOptions& options) {
    return std::make_unique<BackwardTracer>(instrument, specimen, options);
}

} // namespace vkfv::trace
