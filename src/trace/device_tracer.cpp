#include "trace/device_tracer.hpp"

#include "core/error.hpp"
#include "trace/device_scene.hpp"

#include "spirv/forward_illumination_bvh.h"
#include "spirv/forward_illumination_quadtree.h"
#include "spirv/forward_illumination_ray_query.h"
#include "spirv/forward_imaging_bvh.h"
#include "spirv/forward_imaging_quadtree.h"
#include "spirv/forward_imaging_ray_query.h"
#include "spirv/nonsequential_bvh.h"
#include "spirv/nonsequential_ray_query.h"
#include "spirv/probe_nonsequential_bvh.h"
#include "spirv/probe_nonsequential_ray_query.h"
#include "spirv/probe_paths_bvh.h"
#include "spirv/probe_paths_quadtree.h"
#include "spirv/probe_paths_ray_query.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <chrono>
#include <mutex>

namespace vkfv::trace {

namespace {

constexpr std::uint32_t workgroup_size = 128; // of the forward kernels
constexpr std::uint32_t rays_per_invocation = 16;

struct Batch {
    std::uint32_t first_low;
    std::uint32_t first_high;
    std::uint32_t count;
};

Batch make_batch(std::uint64_t first, std::uint32_t count) {
    return {static_cast<std::uint32_t>(first), static_cast<std::uint32_t>(first >> 32), count};
}

// Push constants of the non-sequential kernels.
struct NonsequentialBatch {
    Batch paths;
    std::uint32_t elements_root;
    physics::f32::SourceFrame source_frame;
};
static_assert(sizeof(NonsequentialBatch) == 16 * 4);

// Record of the kernel probe_paths.
struct DevicePathEnd {
    std::uint32_t status;
    std::int32_t surface;
    float x;
    float y;
};
static_assert(sizeof(DevicePathEnd) == 16);

constexpr std::uint32_t paths_per_group = workgroup_size * rays_per_invocation;

// One way of tracing paths on a device, and what it counts.
class PathTrace {
  public:
    PathTrace(const DeviceScene& scene, std::uint32_t batch)
        : scene_(scene), batch_(batch), pixels_(scene.device, pixel_count() * sizeof(std::uint64_t)),
          fates_(scene.device, scene.accounts.slots() * sizeof(std::uint64_t)) {}
    virtual ~PathTrace() = default;

    std::size_t pixel_count() const {
        const auto side = static_cast<std::size_t>(scene_.instrument.constants.detector_pixels);
        return side * side;
    }

    void clear(vulkan::Commands& commands) const {
        commands.fill_zero(pixels_);
        commands.fill_zero(fates_);
        commands.barrier();
    }

    // Paths first ... first + count - 1, count at most the batch; timestamps around and between its stages if wanted.
    virtual void record(vulkan::Commands& commands, std::uint64_t first, std::uint32_t count,
                        bool timed = false) const = 0;

    std::vector<std::uint64_t> pixels() const { return pixels_.read_values<std::uint64_t>(pixel_count()); }
    std::vector<std::uint64_t> fates() const {
        return fates_.read_values<std::uint64_t>(scene_.accounts.slots());
    }
    std::uint32_t batch() const { return batch_; }

  protected:
    const DeviceScene& scene_;
    std::uint32_t batch_;
    vulkan::Buffer pixels_;
    vulkan::Buffer fates_;
};

// The two kernels of the forward trace and what lies between them.
class ForwardTrace final : public PathTrace {
  public:
    ForwardTrace(const DeviceScene& scene, std::uint32_t batch,
                 std::uint32_t stop_illumination = 0, std::uint32_t stop_imaging = 0)
        : PathTrace(scene, batch), survivors_(scene.device, std::size_t{batch} * sizeof(physics::f32::Survivor)),
          survivor_count_(scene.device, sizeof(std::uint32_t)),
          illumination_(scene.device, "forward_illumination",
                        scene.variant(forward_illumination_quadtree, forward_illumination_ray_query,
                                      forward_illumination_bvh),
                        scene.declarations({2, 4, 5}), sizeof(Batch),
                        scene.kernel_constants(stop_illumination)),
          imaging_(scene.device, "forward_imaging",
                   scene.variant(forward_imaging_quadtree, forward_imaging_ray_query, forward_imaging_bvh),
                   scene.declarations({2, 3, 4, 5}), 0, scene.kernel_constants(stop_imaging)) {}

    void record(vulkan::Commands& commands, std::uint64_t first, std::uint32_t count,
                bool timed = false) const override {
        commands.fill_zero(survivor_count_);
        commands.barrier();
        if (timed) {
            commands.timestamp();
        }
        commands.dispatch(illumination_, scene_.bindings({{2, &survivors_}, {4, &fates_}, {5, &survivor_count_}}),
                          make_batch(first, count), (count + paths_per_group - 1) / paths_per_group);
        commands.barrier();
        if (timed) {
            commands.timestamp();
        }
        // The number of survivors is known to the device alone: a fixed grid strides over them.
        const std::uint32_t groups = scene_.software() ? 64 : 4096;
        commands.dispatch(imaging_,
                          scene_.bindings({{2, &survivors_}, {3, &pixels_}, {4, &fates_}, {5, &survivor_count_}}),
                          std::span<const std::byte>{}, groups);
        commands.barrier();
        if (timed) {
            commands.timestamp();
        }
    }

  private:
    vulkan::Buffer survivors_;
    vulkan::Buffer survivor_count_;
    vulkan::Kernel illumination_;
    vulkan::Kernel imaging_;
};

NonsequentialBatch make_nonsequential_batch(const DeviceScene& scene, std::uint64_t first, std::uint32_t count) {
    return {make_batch(first, count), scene.device_specimen.elements_root(), to_float(scene.room.source)};
}

class NonsequentialTrace final : public PathTrace {
  public:
    NonsequentialTrace(const DeviceScene& scene, std::uint32_t batch)
        : PathTrace(scene, batch),
          kernel_(scene.device, "nonsequential", scene.variant({}, nonsequential_ray_query, nonsequential_bvh),
                  scene.declarations({3, 4}), sizeof(NonsequentialBatch), scene.kernel_constants(0)) {}

    void record(vulkan::Commands& commands, std::uint64_t first, std::uint32_t count,
                bool timed = false) const override {
        if (timed) {
            commands.timestamp();
        }
        commands.dispatch(kernel_, scene_.bindings({{3, &pixels_}, {4, &fates_}}),
                          make_nonsequential_batch(scene_, first, count),
                          (count + paths_per_group - 1) / paths_per_group);
        commands.barrier();
        if (timed) {
            commands.timestamp();
        }
    }

  private:
    vulkan::Kernel kernel_;
};

// Software devices like dispatches of about 100 ms; a GPU wants enough rays to fill it. 24 bytes a ray are kept.
std::uint32_t suitable_batch(const DeviceScene& scene, std::uint64_t asked, std::uint64_t rays) {
    const std::uint64_t largest =
        std::min<std::uint64_t>(scene.device.report().max_storage_buffer_bytes / sizeof(physics::f32::Survivor),
                                // Vulkan promises 65535 workgroups a dispatch.
                                std::uint64_t{65535} * workgroup_size * rays_per_invocation);
    const std::uint64_t wanted = asked > 0 ? asked : scene.software() ? std::uint64_t{1} << 20 : std::uint64_t{1} << 25;
    return static_cast<std::uint32_t>(std::max<std::uint64_t>(1, std::min({wanted, largest, rays})));
}

// Batches a submission: waiting for each costs a GPU 60 us, and a software device's dispatch is long enough.
constexpr std::uint32_t batches_per_submission_gpu = 8;

class DeviceTracer final : public Tracer {
  public:
    DeviceTracer(const optics::Instrument& instrument, const specimen::Specimen& specimen, const TraceOptions& options)
        : instrument_(instrument), rays_(options.rays), scene_(instrument_, specimen, options),
          trace_(make_trace(scene_, options)) {}

    Image expose(double focal_height, std::uint32_t image) const override {
        const std::scoped_lock lock(mutex_);
        const auto start = std::chrono::steady_clock::now();
        scene_.set_exposure(focal_height, image);
        const std::uint64_t per_submission =
            std::uint64_t{trace_->batch()} * (scene_.software() ? 1 : batches_per_submission_gpu);
        for (std::uint64_t first = 0; first < rays_; first += per_submission) {
            vulkan::Commands commands(scene_.device);
            if (first == 0) {
                trace_->clear(commands);
            }
            const std::uint64_t end = std::min(rays_, first + per_submission);
            for (std::uint64_t path = first; path < end; path += trace_->batch()) {
                trace_->record(commands, path,
                                static_cast<std::uint32_t>(std::min<std::uint64_t>(trace_->batch(), end - path)));
            }
            commands.submit_and_wait();
        }
        Image result = scene_.accounts.image(trace_->pixels(), trace_->fates(), rays_);
        result.seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
        return result;
    }

    std::string description() const override {
        return fmt::format("{}; traversal {}", scene_.device.choice(), scene_.reason);
    }

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
};

double median(std::vector<double> values) {
    std::ranges::nth_element(values, values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2));
    return values[values.size() / 2];
}

} // namespace

std::unique_ptr<Tracer> make_device_tracer(const optics::Instrument& instrument, const specimen::Specimen& specimen,
                                           const TraceOptions& options) {
    return std::make_unique<DeviceTracer>(instrument, specimen, options);
}

std::vector<PathEnd> device_paths(const optics::Instrument& instrument, const specimen::Specimen& specimen,
                                  const TraceOptions& options, double focal_height, std::uint32_t image,
                                  std::uint64_t first, std::uint32_t count) {
    DeviceScene scene(instrument, specimen, options);
    scene.set_exposure(focal_height, image);
    const vulkan::Buffer ends(scene.device, count * sizeof(DevicePathEnd));
    const bool nonsequential = options.nonsequential;
    const vulkan::Kernel kernel(
        scene.device, "probe_paths",
        nonsequential ? scene.variant({}, probe_nonsequential_ray_query, probe_nonsequential_bvh)
                      : scene.variant(probe_paths_quadtree, probe_paths_ray_query, probe_paths_bvh),
        scene.declarations({6}), nonsequential ? sizeof(NonsequentialBatch) : sizeof(Batch),
        scene.kernel_constants(0));
    vulkan::Commands commands(scene.device);
    const std::uint32_t groups = (count + 63) / 64;
    if (nonsequential) {
        commands.dispatch(kernel, scene.bindings({{6, &ends}}), make_nonsequential_batch(scene, first, count), groups);
    } else {
        commands.dispatch(kernel, scene.bindings({{6, &ends}}), make_batch(first, count), groups);
    }
    commands.barrier();
    commands.submit_and_wait();
    std::vector<PathEnd> result;
    result.reserve(count);
    for (const DevicePathEnd& end : ends.read_values<DevicePathEnd>(count)) {
        result.push_back({end.status, end.surface, end.x, end.y});
    }
    return result;
}

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
