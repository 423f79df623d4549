#include "trace/backward_trace.hpp"

#include "spirv/backward_bvh.h"
#include "spirv/backward_quadtree.h"
#include "spirv/backward_ray_query.h"
#include "spirv/backward_specialised_bvh.h"
#include "spirv/backward_specialised_quadtree.h"
#include "spirv/backward_specialised_ray_query.h"
#include "trace/scene_waves.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <mutex>

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
                             const BackwardPlan& plan, std::uint64_t asked_batch)
    : scene_(scene), pixels_(pixel_count(scene)), points_per_chunk_(std::min(plan.points, most_points_per_chunk)),
      sums_(*scene.device, std::size_t{pixels_} * sizeof(std::uint64_t)),
      optics_(*scene.device, sizeof(kernels::BackwardBlock)),
      kernel_(*scene.device, "backward", variant(scene), declarations(scene), sizeof(kernels::BackwardBatch),
              constants(scene, optics)) {
    const kernels::BackwardBlock block{to_float(optics), to_float(plan.lattice())};
    optics_.write_values(std::span<const kernels::BackwardBlock>(&block, 1));
    const std::uint64_t wanted = asked_batch > 0    ? asked_batch
                                 : scene.software() ? std::uint64_t{1} << 19
                                                    : std::uint64_t{1} << 27;
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

std::vector<std::uint64_t> BackwardTrace::sums() const {
    return sums_.read_values<std::uint64_t>(pixels_);
}

namespace {

class BackwardTracer final : public Tracer {
  public:
    BackwardTracer(const optics::Instrument& instrument, const specimen::Specimen& specimen,
                   const TraceOptions& options)
        : instrument_(instrument), turned_(optics::turned_round(instrument)),
          plan_(backward_plan(options.rays, instrument.constants.detector_pixels)),
          scene_(make_device_scene(turned_, specimen, options, &instrument_)),
          trace_(scene_, backward_optics(instrument_, scene_.host_record.material), plan_, options.batch) {
        if (scene_.filter) {
            waves_.emplace(scene_);
        }
    }

    Image expose(double focal_height, std::uint32_t image) const override {
        const std::scoped_lock lock(mutex_);
        const auto start = std::chrono::steady_clock::now();
        scene_.set_exposure(focal_height, image);
        BackwardImage sums(instrument_, plan_);
        double device_seconds = 0;
        for (std::uint32_t randomisation = 0; randomisation < plan_.randomisations; ++randomisation) {
            for (std::uint32_t first = 0; first < plan_.points; first += trace_.points_per_batch()) {
                vulkan::Commands commands(*scene_.device, 2);
                commands.timestamp();
                if (first == 0) {
                    trace_.clear(commands);
                }
                if (first == 0 && randomisation == 0) {
                    scene_.clear_cell_light(commands);
                }
                trace_.record(commands, randomisation, first,
                              std::min(trace_.points_per_batch(), plan_.points - first));
                commands.timestamp();
                commands.submit_and_wait();
                device_seconds += commands.seconds()[1];
            }
            sums.add(trace_.sums());
        }
        Image result = sums.image();
        if (waves_) {
            const auto light = waves_->light();
            device_seconds += light.device_seconds;
            result = with_waves(std::move(result), light.pixels, sums.power_per_number(), *scene_.filter);
        }
        result.device_seconds = device_seconds;
        // Of the imaging train alone: who goes on to the source, no one counts.
        result.crossings = static_cast<double>(result.rays) * turned_.constants.illumination_count;
        result.seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
        return result;
    }

    std::string description() const override {
        return fmt::format("{}; traversal {}; backward", scene_.device->choice(), scene_.traversal.reason);
    }

    TracerIdentity identity() const override { return scene_.identity(); }
    const optics::PupilFilter* pupil_filter() const override { return scene_.filter ? &*scene_.filter : nullptr; }

  private:
    optics::Instrument instrument_;
    optics::Instrument turned_;
    BackwardPlan plan_;
    mutable std::mutex mutex_; // one exposure at a time: the buffers are shared
    mutable DeviceScene scene_;
    BackwardTrace trace_;
    std::optional<SceneWaves> waves_;
};

} // namespace

std::unique_ptr<Tracer> make_backward_tracer(const optics::Instrument& instrument, const specimen::Specimen& specimen,
                                             const TraceOptions& options) {
    return std::make_unique<BackwardTracer>(instrument, specimen, options);
}

} // namespace vkfv::trace
