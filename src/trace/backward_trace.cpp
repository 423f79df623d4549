#include "trace/backward_trace.hpp"

#include "spirv/backward_bvh.h"
#include "spirv/backward_quadtree.h"
#include "spirv/backward_ray_query.h"
#include "spirv/backward_specialised_bvh.h"
#include "spirv/backward_specialised_quadtree.h"
#include "spirv/backward_specialised_ray_query.h"
#include "trace/device_exposures.hpp"
#include "trace/scene_waves.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>

namespace vkfv::trace {

namespace {

constexpr std::uint32_t most_points_per_chunk = 32;
constexpr std::uint32_t workgroup = 128;

std::uint32_t pixel_count(const DeviceScene& scene) {
    const auto side = static_cast<std::uint32_t>(scene.instrument.constants.detector_pixels);
    return side * side;
}

std::vector<vulkan::BindingDeclaration> declarations(const DeviceScene& scene) {
    auto all = scene.declarations({kernels::BINDING_PIXELS});
    all.push_back({kernels::BINDING_BACKWARD, vulkan::BindingKind::uniform_buffer});
    return all;
}

std::vector<vulkan::SpecializationConstant> constants(const DeviceScene& scene,
                                                      const physics::f64::BackwardOptics& optics) {
    // The way to the source is traced by a loop.
    const auto& trains = scene.instrument.constants;
    auto all = scene.is_specialised()
                   ? scene.specialised_constants(trains.illumination_first, trains.illumination_count)
                   : scene.kernel_constants();
    all.push_back({kernels::CONSTANT_CONE_CANDIDATES, optics.cone_candidates});
    all.push_back({kernels::CONSTANT_LOBE_CANDIDATES, optics.lobe_candidates});
    constexpr std::uint32_t queries_at_hand = 11;
    all.push_back({kernels::CONSTANT_QUERY_CAPACITY,
                   queries_at_hand + static_cast<std::uint32_t>(scene.constants.specimen.max_bounces)});
    return all;
}

std::span<const std::uint32_t> variant(const DeviceScene& scene) {
    return scene.is_specialised()
               ? scene.variant(backward_specialised_quadtree, backward_specialised_ray_query, backward_specialised_bvh)
               : scene.variant(backward_quadtree, backward_ray_query, backward_bvh);
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
    const std::uint64_t most = options.batch > 0  ? options.batch
                               : scene.software() ? std::uint64_t{1} << 19
                                                  : std::uint64_t{1} << 27;
    const std::uint64_t wanted = most / options.batch_divisor;
    const std::uint64_t most_chunks = std::uint64_t{vulkan::most_groups_in_a_row} * workgroup / pixels_;
    const std::uint64_t chunks =
        std::clamp<std::uint64_t>(wanted / pixels_ / points_per_chunk_, 1, std::max<std::uint64_t>(1, most_chunks));
    points_per_batch_ = static_cast<std::uint32_t>(std::min<std::uint64_t>(plan.points, chunks * points_per_chunk_));
}

void BackwardTrace::clear(vulkan::Commands& commands) const {
    commands.fill_zero(sums_);
    commands.barrier();
}

void BackwardTrace::record(vulkan::Commands& commands, std::uint32_t randomisation, std::uint32_t first,
                           std::uint32_t count) const {
    auto bindings = scene_.bindings({{kernels::BINDING_PIXELS, &sums_}, {kernels::BINDING_BACKWARD, &optics_}});
    const kernels::BackwardBatch batch{first / points_per_chunk_, count / points_per_chunk_, points_per_chunk_,
                                       randomisation};
    const auto groups = vulkan::groups_of(std::uint64_t{batch.chunks} * pixels_, workgroup);
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
          plan_(backward_plan(options.rays, instrument.constants.detector_pixels)),
          scene_(make_device_scene(turned_, specimen, options, &instrument_)),
          trace_(scene_, backward_optics(instrument_, scene_.host_record.material), plan_, options) {
        if (scene_.filter) {
            waves_.emplace(scene_);
        }
    }

    std::string description() const override {
        return fmt::format("{}; traversal {}; backward", scene_.device->choice(), scene_.traversal.reason);
    }

    TracerIdentity identity() const override { return scene_.identity(); }
    std::shared_ptr<const vulkan::Device> device() const override { return scene_.device; }
    const optics::PupilFilter* pupil_filter() const override { return scene_.filter ? &*scene_.filter : nullptr; }

  private:
    class Exposure;

    std::unique_ptr<DeviceExposure> start(double focal_height, std::uint32_t image, std::size_t slot) const override;
    std::size_t slots() const override { return waves_ ? waves_->exposures_at_a_time() : most_exposures; }

    std::size_t pixels() const { return pixel_count(scene_); }
    // Sums of randomisations that are kept for the host at a time.
    std::size_t randomisations_kept() const { return std::min<std::size_t>(plan_.randomisations, 4); }

    optics::Instrument instrument_;
    optics::Instrument turned_;
    BackwardPlan plan_;
    mutable DeviceScene scene_;
    BackwardTrace trace_;
    std::optional<SceneWaves> waves_;
    mutable std::array<std::optional<vulkan::Buffer>, most_exposures> for_host_; // sums, then the light of waves
};

class BackwardTracer::Exposure final : public DeviceExposure {
  public:
    Exposure(const BackwardTracer& tracer, const vulkan::Buffer& for_host)
        : DeviceExposure(*tracer.scene_.device), tracer_(tracer), for_host_(for_host),
          sums_(tracer.instrument_, tracer.plan_) {
        const BackwardPlan& plan = tracer.plan_;
        const std::uint32_t most = tracer.trace_.points_per_batch();
        for (std::uint32_t randomisation = 0; randomisation < plan.randomisations; ++randomisation) {
            if (randomisation >= tracer.randomisations_kept()) {
                take_sums();
            }
            for (std::uint32_t first = 0; first < plan.points; first += most) {
                vulkan::Commands& commands = work.open();
                if (first == 0) {
                    tracer.trace_.clear(commands);
                    if (randomisation == 0) {
                        tracer.scene_.clear_cell_light(commands);
                    }
                }
                tracer.trace_.record(commands, randomisation, first, std::min(most, plan.points - first));
                if (first + most >= plan.points) {
                    tracer.trace_.copy_sums(commands, for_host_, place_of(randomisation));
                }
                work.submit();
            }
            last_submissions_.push_back(work.submissions() - 1);
        }
        if (tracer.waves_) {
            tracer.waves_->hand_over(work, for_host_, place_of_light());
        }
    }

    Image finish() override {
        while (taken_ < last_submissions_.size()) {
            take_sums();
        }
        Image image = sums_.image();
        if (tracer_.waves_) {
            work.wait(work.submissions() - 1);
            image = with_waves(std::move(image), tracer_.waves_->light(for_host_, place_of_light()),
                               sums_.power_per_number(), *tracer_.scene_.filter);
        }
        // Of the imaging train alone: who goes on to the source, no one counts.
        image.crossings = static_cast<double>(image.rays) * tracer_.turned_.constants.illumination_count;
        return image;
    }

  private:
    std::size_t place_of(std::size_t randomisation) const {
        return randomisation % tracer_.randomisations_kept() * tracer_.pixels() * sizeof(std::uint64_t);
    }
    std::size_t place_of_light() const {
        return tracer_.randomisations_kept() * tracer_.pixels() * sizeof(std::uint64_t);
    }
    // Of the first randomisation that has not been taken.
    void take_sums() {
        work.wait(last_submissions_[taken_]);
        sums_.add(for_host_.values<std::uint64_t>(tracer_.pixels(), place_of(taken_)));
        ++taken_;
    }

    const BackwardTracer& tracer_;
    const vulkan::Buffer& for_host_;
    BackwardImage sums_;
    std::vector<std::size_t> last_submissions_; // of each randomisation
    std::size_t taken_ = 0;                     // randomisations
};

std::unique_ptr<DeviceExposure> BackwardTracer::start(double focal_height, std::uint32_t image,
                                                      std::size_t slot) const {
    auto& for_host = for_host_.at(slot);
    if (!for_host) {
        const std::size_t numbers = randomisations_kept() * pixels();
        for_host.emplace(*scene_.device, numbers * sizeof(std::uint64_t) + (waves_ ? waves_->bytes_for_host() : 0),
                         vulkan::Buffer::Memory::host);
    }
    scene_.set_exposure(focal_height, image, slot);
    return std::make_unique<Exposure>(*this, *for_host);
}

} // namespace

std::unique_ptr<Tracer> make_backward_tracer(const optics::Instrument& instrument, const specimen::Specimen& specimen,
                                             const TraceOptions& options) {
    return std::make_unique<BackwardTracer>(instrument, specimen, options);
}

} // namespace vkfv::trace
