#include "trace/backward_trace.hpp"

#include "spirv/backward_bvh.h"
#include "spirv/backward_quadtree.h"
#include "spirv/backward_ray_query.h"
#include "spirv/backward_software.h"
#include "spirv/backward_specialised_bvh.h"
#include "spirv/backward_specialised_quadtree.h"
#include "spirv/backward_specialised_ray_query.h"
#include "spirv/backward_specialised_software.h"
#include "trace/device_numbers.hpp"
#include "trace/wave_image.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <deque>
#include <optional>
#include <string>
#include <utility>

namespace vkfv::trace {

namespace {

constexpr std::uint32_t most_points_per_chunk = 32;
constexpr std::uint32_t workgroup = 128;
constexpr std::uint64_t most_paths = std::uint64_t{1} << 27; // a submission's; on slower devices its time decides

std::uint32_t pixel_count(const DeviceScene& scene) {
    return static_cast<std::uint32_t>(scene.instrument.detector_pixels().count());
}

std::vector<vulkan::BindingDeclaration> declarations(const DeviceScene& scene) {
    auto all = scene.declarations({kernels::BINDING_PIXELS});
    all.push_back({kernels::BINDING_BACKWARD, vulkan::BindingKind::uniform_buffer});
    return all;
}

// Mesa 22's software Vulkan (22.3.6 of Debian 12) crashes on kernels that look at the source's rim by itself. There all
// of the source is looked at as one: the same image in the mean, with somewhat more noise.
physics::f64::BackwardOptics on_device(const vulkan::Device& device, physics::f64::BackwardOptics optics) {
    if (vulkan::is_software(device.report()) && device.report().driver.find("Mesa 22.") != std::string::npos) {
        optics.rim_period = 0;
    }
    return optics;
}

std::vector<vulkan::SpecializationConstant> constants(const DeviceScene& scene,
                                                      const physics::f64::BackwardOptics& optics) {
    // The way to the source is traced by a loop.
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
    : scene_(scene), pixels_(pixel_count(scene)), points_per_chunk_(std::min(plan.points, most_points_per_chunk)),
      sums_(*scene.device, std::size_t{pixels_} * sizeof(std::uint64_t)),
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

void BackwardTrace::record(vulkan::Commands& commands, std::uint32_t randomisation, std::uint64_t first,
                           std::uint32_t count) const {
    auto bindings = scene_.bindings({{kernels::BINDING_PIXELS, &sums_}, {kernels::BINDING_BACKWARD, &optics_}});
    const kernels::BackwardBatch batch{static_cast<std::uint32_t>(first / pixels_),
                                       static_cast<std::uint32_t>(first % pixels_), count, points_per_chunk_,
                                       randomisation};
    const auto groups = vulkan::groups_of(count, workgroup);
    commands.dispatch(kernel_, bindings, batch, groups.x, groups.y);
    commands.barrier();
}

void BackwardTrace::copy_sums(vulkan::Commands& commands, const vulkan::Buffer& to, std::size_t to_byte) const {
    commands.copy(sums_, to, sums_.bytes(), 0, to_byte);
    commands.barrier();
}

namespace {

class BackwardTracer final : public DeviceExposures {
  public:
    BackwardTracer(const optics::Instrument& instrument, const specimen::Specimen& specimen,
                   const TraceOptions& options)
        : instrument_(instrument), turned_(optics::turned_round(instrument)),
          plan_(backward_plan(options.rays, instrument.detector_pixels())),
          scene_(make_device_scene(turned_, specimen, options, &instrument_)),
          trace_(scene_, on_device(*scene_.device, backward_optics(instrument_, scene_.host_record.material, plan_)),
                 plan_, options),
          light_(*scene_.device, scene_.light_buffers()),
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

    std::size_t pixels() const { return pixel_count(scene_); }
    // Sums of randomisations that are kept for the host at a time.
    std::size_t randomisations_kept() const { return std::min<std::size_t>(plan_.randomisations, 4); }

    optics::Instrument instrument_;
    optics::Instrument turned_;
    BackwardPlan plan_;
    mutable DeviceScene scene_;
    BackwardTrace trace_;
    DeviceNumbers light_; // that is sorted for waves
    mutable DispatchPace pace_;
    mutable std::array<std::optional<vulkan::Buffer>, most_exposures> for_host_; // sums, then the light of waves
};

// Its units are the chunks of one randomisation after the other.
class BackwardTracer::Exposure final : public SingleExposure {
  public:
    Exposure(const BackwardTracer& tracer, const vulkan::Buffer& for_host)
        : SingleExposure(*tracer.scene_.device, tracer.pace_), tracer_(tracer), for_host_(for_host),
          sums_(tracer.instrument_, tracer.plan_) {}

    void set_out(std::span<const std::uint64_t> numbers) override {
        if (!numbers.empty()) {
            sums_.set(numbers.first(sums_.number_count()));
            tracer_.light_.write(work, numbers.subspan(sums_.number_count()));
            clears_light_ = false;
        }
    }

    std::size_t number_count() const override { return sums_.number_count() + tracer_.light_.count(); }
    std::vector<std::uint64_t> numbers() override {
        if (on_device_) {
            take_from_device(work.open());
            work.submit();
        }
        take_all();
        auto numbers = sums_.numbers();
        const auto light = tracer_.light_.read(work);
        numbers.insert(numbers.end(), light.begin(), light.end());
        return numbers;
    }

    std::uint64_t submit(std::uint64_t first, std::uint64_t end) override {
        const BackwardTrace& trace = tracer_.trace_;
        const auto randomisation = static_cast<std::uint32_t>(first / trace.chunks());
        const std::uint64_t begin = randomisation * trace.chunks();
        const std::uint64_t most = std::max<std::uint64_t>(1, tracer_.pace_.paths() / trace.points_per_chunk());
        end = std::min({end, begin + trace.chunks(), first + most});
        tracer_.scene_.require_waves();
        vulkan::Commands& commands = work.open();
        if (std::exchange(clears_light_, false)) {
            tracer_.scene_.clear_sorted_light(commands);
        }
        if (!on_device_) {
            trace.clear(commands);
            on_device_ = randomisation;
        }
        trace.record(commands, randomisation, first - begin, static_cast<std::uint32_t>(end - first));
        if (end == begin + trace.chunks()) {
            take_from_device(commands);
        }
        work.submit((end - first) * trace.points_per_chunk());
        return end;
    }

    void hand_over() override {
        if (const auto& waves = tracer_.scene_.waves) {
            waves->hand_over(work, for_host_, place_of_light());
        }
    }

    Image finish() override {
        take_all();
        work.wait();
        Image image = sums_.image();
        if (const auto& waves = tracer_.scene_.waves) {
            image = with_waves(std::move(image), waves->light(for_host_, place_of_light()), sums_.power_per_number(),
                               waves->filter());
        }
        // Of the imaging train alone: who goes on to the source, no one counts.
        image.crossings = static_cast<double>(image.rays) * tracer_.turned_.constants.illumination_count;
        return image;
    }

  private:
    // Sums on their way to the host.
    struct Taken {
        std::uint32_t randomisation;
        std::size_t place; // of those that are kept
        std::size_t submission;
    };

    std::size_t byte_of(std::size_t place) const { return place * tracer_.pixels() * sizeof(std::uint64_t); }
    std::size_t place_of_light() const { return byte_of(tracer_.randomisations_kept()); }
    // What the device has of a randomisation, whole or not, with the submission that is open.
    void take_from_device(vulkan::Commands& commands) {
        if (taken_.size() == tracer_.randomisations_kept()) {
            take_first();
        }
        tracer_.trace_.copy_sums(commands, for_host_, byte_of(next_place_));
        taken_.push_back({*on_device_, next_place_, work.submissions() - 1});
        next_place_ = (next_place_ + 1) % tracer_.randomisations_kept();
        on_device_.reset();
    }
    void take_first() {
        const Taken first = taken_.front();
        taken_.pop_front();
        work.wait(first.submission);
        sums_.add(first.randomisation, for_host_.values<std::uint64_t>(tracer_.pixels(), byte_of(first.place)));
    }
    void take_all() {
        while (!taken_.empty()) {
            take_first();
        }
    }

    const BackwardTracer& tracer_;
    const vulkan::Buffer& for_host_;
    BackwardImage sums_;
    bool clears_light_ = true;
    std::optional<std::uint32_t> on_device_; // the randomisation whose sums it adds up
    std::deque<Taken> taken_;
    std::size_t next_place_ = 0;
};

std::unique_ptr<DeviceExposure> BackwardTracer::prepare(FocalPosition position, std::uint32_t image,
                                                        std::size_t slot) const {
    auto& for_host = for_host_.at(slot);
    if (!for_host) {
        const std::size_t numbers = randomisations_kept() * pixels();
        for_host.emplace(*scene_.device,
                         numbers * sizeof(std::uint64_t) + (scene_.waves ? scene_.waves->bytes_for_host() : 0),
                         vulkan::Buffer::Memory::host);
    }
    scene_.set_exposure(position, image, slot);
    return std::make_unique<Exposure>(*this, *for_host);
}

} // namespace

std::unique_ptr<DeviceExposures> make_backward_tracer(const optics::Instrument& instrument,
                                                      const specimen::Specimen& specimen, const TraceOptions& options) {
    return std::make_unique<BackwardTracer>(instrument, specimen, options);
}

} // namespace vkfv::trace
