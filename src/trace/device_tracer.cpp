#include "trace/device_tracer.hpp"

#include "core/error.hpp"
#include "specimen/description.hpp"
#include "trace/device_records.hpp"
#include "trace/device_specimen.hpp"
#include "trace/ledger.hpp"
#include "vulkan/kernel.hpp"

#include "spirv/forward_illumination_bvh.h"
#include "spirv/forward_illumination_quadtree.h"
#include "spirv/forward_illumination_ray_query.h"
#include "spirv/forward_imaging_bvh.h"
#include "spirv/forward_imaging_quadtree.h"
#include "spirv/forward_imaging_ray_query.h"
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

// Record of the kernel probe_paths.
struct DevicePathEnd {
    std::uint32_t status;
    std::int32_t surface;
    float x;
    float y;
};
static_assert(sizeof(DevicePathEnd) == 16);

// Device, buffers and bindings that every use of the trace on a device shares.
class DeviceScene {
  public:
    DeviceScene(const optics::Instrument& instrument, const specimen::Specimen& specimen, const TraceOptions& options)
        : instrument(instrument), device(vulkan::DeviceOptions{options.device}),
          traversal(choose_traversal(device.report(), specimen, options.traversal, reason)),
          device_specimen(device, specimen, traversal), host_record(specimen::record(specimen, options.max_bounces)),
          seed(options.seed), surfaces(device, physics::f32::SURFACE_CAPACITY * sizeof(physics::f32::Surface)),
          parameters(device, sizeof(Parameters), vulkan::Buffer::Memory::host),
          spectrum(device, physics::f32::SPECTRUM_CAPACITY * sizeof(physics::f32::SpectralBin)) {
        spectrum.write_values(std::span<const physics::f32::SpectralBin>(spectrum_block(instrument)));
        surfaces.write_values(std::span<const physics::f32::Surface>(surface_block(instrument)));
        constants.instrument = to_float(instrument.constants);
        constants.specimen = device_specimen.record(options.max_bounces);
        host_record.top = constants.specimen.top; // the plane that the kernels mean: rounded to float
    }

    void set_exposure(double focal_height, std::uint32_t image) {
        constants.exposure = to_float(make_exposure(instrument, host_record, focal_height, seed, image));
        parameters.write_values(std::span<const Parameters>(&constants, 1));
    }

    // The scene's bindings (0, 1, 8 to 14) and those given.
    std::vector<vulkan::Binding> bindings(std::initializer_list<vulkan::Binding> further) const {
        std::vector<vulkan::Binding> all = {{0, &surfaces}, {1, &parameters}, {14, &spectrum}};
        const auto of_specimen = device_specimen.bindings();
        all.insert(all.end(), of_specimen.begin(), of_specimen.end());
        all.insert(all.end(), further.begin(), further.end());
        return all;
    }
    std::vector<vulkan::BindingDeclaration> declarations(std::initializer_list<std::uint32_t> further) const {
        using enum vulkan::BindingKind;
        std::vector<vulkan::BindingDeclaration> all = {{0, uniform_buffer}, {1, uniform_buffer}, {14, uniform_buffer}};
        const auto of_specimen = device_specimen.declarations();
        all.insert(all.end(), of_specimen.begin(), of_specimen.end());
        for (const std::uint32_t slot : further) {
            all.push_back({slot, storage_buffer});
        }
        return all;
    }

    // Of the kernels: the specimen's, and the forward trace's ledger slots and early end.
    std::vector<vulkan::SpecializationConstant> kernel_constants(std::uint32_t stop_after) const {
        auto all = device_specimen.constants();
        all.push_back({1, static_cast<std::uint32_t>(ledger_slot_count(instrument))});
        all.push_back({2, stop_after});
        all.push_back({3, instrument.features});
        return all;
    }

    // The variant of a kernel for the traversal.
    std::span<const std::uint32_t> variant(std::span<const std::uint32_t> by_quadtree,
                                           std::span<const std::uint32_t> by_ray_query,
                                           std::span<const std::uint32_t> by_bvh) const {
        return traversal == Traversal::ray_query ? by_ray_query
               : traversal == Traversal::bvh     ? by_bvh
                                                 : by_quadtree;
    }
    bool software() const { return device.report().type == "CPU"; }

    const optics::Instrument& instrument;
    std::string reason; // of the traversal; before `traversal`, which sets it
    vulkan::Device device;
    Traversal traversal;
    DeviceSpecimen device_specimen;
    physics::f64::SpecimenRecord host_record;
    std::uint32_t seed;
    vulkan::Buffer surfaces;
    vulkan::Buffer parameters;
    vulkan::Buffer spectrum;
    Parameters constants{};
};

// The two kernels of the forward trace and what lies between them.
class ForwardTrace {
  public:
    ForwardTrace(const DeviceScene& scene, std::uint32_t batch,
                 std::uint32_t stop_illumination = 0, std::uint32_t stop_imaging = 0)
        : scene_(scene), batch_(batch),
          survivors_(scene.device, std::size_t{batch} * sizeof(physics::f32::Survivor)),
          survivor_count_(scene.device, sizeof(std::uint32_t)),
          pixels_(scene.device, pixel_count() * sizeof(std::uint64_t)),
          fates_(scene.device, ledger_slot_count(scene.instrument) * sizeof(std::uint64_t)),
          illumination_(scene.device, "forward_illumination",
                        scene.variant(forward_illumination_quadtree, forward_illumination_ray_query,
                                      forward_illumination_bvh),
                        scene.declarations({2, 4, 5}), sizeof(Batch),
                        scene.kernel_constants(stop_illumination)),
          imaging_(scene.device, "forward_imaging",
                   scene.variant(forward_imaging_quadtree, forward_imaging_ray_query, forward_imaging_bvh),
                   scene.declarations({2, 3, 4, 5}), 0, scene.kernel_constants(stop_imaging)) {}

    std::size_t pixel_count() const {
        const auto side = static_cast<std::size_t>(scene_.instrument.constants.detector_pixels);
        return side * side;
    }

    void clear(vulkan::Commands& commands) const {
        commands.fill_zero(pixels_);
        commands.fill_zero(fates_);
        commands.barrier();
    }

    // Paths first ... first + count - 1, count at most the batch; timestamps around and between the halves if wanted.
    void record(vulkan::Commands& commands, std::uint64_t first, std::uint32_t count, bool timed = false) const {
        commands.fill_zero(survivor_count_);
        commands.barrier();
        const Batch batch{static_cast<std::uint32_t>(first), static_cast<std::uint32_t>(first >> 32), count};
        const std::uint32_t per_group = workgroup_size * rays_per_invocation;
        if (timed) {
            commands.timestamp();
        }
        commands.dispatch(illumination_, scene_.bindings({{2, &survivors_}, {4, &fates_}, {5, &survivor_count_}}),
                          batch, (count + per_group - 1) / per_group);
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

    std::vector<std::uint64_t> pixels() const { return pixels_.read_values<std::uint64_t>(pixel_count()); }
    std::vector<std::uint64_t> fates() const {
        return fates_.read_values<std::uint64_t>(ledger_slot_count(scene_.instrument));
    }
    std::uint32_t batch() const { return batch_; }

  private:
    const DeviceScene& scene_;
    std::uint32_t batch_;
    vulkan::Buffer survivors_;
    vulkan::Buffer survivor_count_;
    vulkan::Buffer pixels_;
    vulkan::Buffer fates_;
    vulkan::Kernel illumination_;
    vulkan::Kernel imaging_;
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
          forward_(scene_, suitable_batch(scene_, options.batch, options.rays)) {}

    Image expose(double focal_height, std::uint32_t image) const override {
        const std::scoped_lock lock(mutex_);
        const auto start = std::chrono::steady_clock::now();
        scene_.set_exposure(focal_height, image);
        const std::uint64_t per_submission =
            std::uint64_t{forward_.batch()} * (scene_.software() ? 1 : batches_per_submission_gpu);
        for (std::uint64_t first = 0; first < rays_; first += per_submission) {
            vulkan::Commands commands(scene_.device);
            if (first == 0) {
                forward_.clear(commands);
            }
            const std::uint64_t end = std::min(rays_, first + per_submission);
            for (std::uint64_t path = first; path < end; path += forward_.batch()) {
                forward_.record(commands, path,
                                static_cast<std::uint32_t>(std::min<std::uint64_t>(forward_.batch(), end - path)));
            }
            commands.submit_and_wait();
        }
        Image result = make_image(instrument_, forward_.pixels(), forward_.fates(), rays_);
        result.seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
        return result;
    }

    std::string description() const override {
        return fmt::format("{}; traversal {}", scene_.device.choice(), scene_.reason);
    }

  private:
    optics::Instrument instrument_;
    std::uint64_t rays_;
    mutable std::mutex mutex_; // one exposure at a time: the buffers are shared
    mutable DeviceScene scene_;
    ForwardTrace forward_;
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
    const vulkan::Kernel kernel(scene.device, "probe_paths",
                                scene.variant(probe_paths_quadtree, probe_paths_ray_query, probe_paths_bvh),
                                scene.declarations({6}), sizeof(Batch), scene.kernel_constants(0));
    vulkan::Commands commands(scene.device);
    commands.dispatch(kernel, scene.bindings({{6, &ends}}), 
                      Batch{static_cast<std::uint32_t>(first), static_cast<std::uint32_t>(first >> 32), count}, (count + 63) / 64);
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
