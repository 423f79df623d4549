#include "measurement/stack/stack_runs.hpp"

#include "core/messages/error.hpp"
#include "core/messages/stages.hpp"
#include "core/threads/parallel_list.hpp"
#include "core/toml/toml_tables.hpp"
#include "measurement/judgement/plan_warnings.hpp"
#include "measurement/scene/disk_space.hpp"
#include "measurement/scene/host_memory.hpp"
#include "vulkan/device.hpp"

#include <fmt/format.h>
#include <spdlog/spdlog.h>

#include <algorithm>
#include <cstdint>
#include <future>
#include <utility>

namespace vkfv::measurement {

namespace {

namespace fs = std::filesystem;

// Requests are not part of an identity, although they decide which device traces and how.
std::string requests_of(const Configuration& configuration) {
    return fmt::format("device = {}\ntraversal = {}\n", configuration.trace.device,
                       static_cast<int>(configuration.trace.traversal));
}

// Takes images that the store lacks from folders that hold them whole. Images that another device traced are left.
void take_images(scan::ImageStore& store, const std::vector<fs::path>& folders) {
    for (const fs::path& folder : folders) {
        for (int image = 0; image < static_cast<int>(store.description().positions.size()); ++image) {
            try {
                if (!store.stored(image)) {
                    (void)store.take(image, folder);
                }
            } catch (const InputError& error) {
                spdlog::debug("{}: {}", error.problem().where.file.string(), error.problem().found);
            }
        }
    }
}

// Another stack whose images are made of the light that is traced now.
struct Follower {
    StackScene scene;
    scan::ImageStore store;
    scan::ImageDeveloper develop;

    Follower(const StackScene& traced, const Configuration& configuration, const trace::TracerIdentity& tracer,
             const WorkingDevices& devices)
        : scene(configuration, traced.parts()), store(configuration.output_directory, scene.description(tracer)),
          develop(developer_of(scene, store, devices)) {
        require_space(store, 0);
    }

    void take(int image, const trace::Image& exposure) {
        if (!store.stored(image)) {
            store.store(image, exposure, develop(image, exposure));
        }
    }
};

// Refuses a stack whose evaluation exceeds the memory that holds it, before its images are traced. device: the
// tracer's; null for the host.
void require_memory(const StackScene& scene, const vulkan::Device* device) {
    const Configuration& configuration = scene.configuration;
    const bool on_device =
        device != nullptr &&
        (configuration.evaluate_on == EvaluateOn::device ||
         (configuration.evaluate_on == EvaluateOn::automatic && !vulkan::is_software(device->report())));
    const double takes = evaluation_bytes(configuration, scene.instrument);
    const std::uint64_t there = on_device ? device->report().memory_bytes : memory_of_host();
    if (takes > static_cast<double>(there)) {
        constexpr double most = 9e18; // bytes, the largest number that the text can hold
        throw InputError({.where = {},
                          .key = "detector.pixels",
                          .found = fmt::format("an evaluation that takes {} of memory",
                                               bytes_text(static_cast<std::uint64_t>(std::min(takes, most)))),
                          .expected = fmt::format("at most {}, the memory of {}", bytes_text(there),
                                                  on_device ? device->report().name : "this machine"),
                          .remedy = "Take fewer pixels, or a smaller topography.smoothing_steps."});
    }
}

} // namespace

std::string image_key(const Configuration& configuration) {
    return configuration.identity + requests_of(configuration);
}

std::string light_key(const Configuration& configuration) {
    return without_entries(configuration.identity, {"camera", "output", "detector.assumed_pitch_um"}) +
           requests_of(configuration);
}

WorkingDevices& StackRuns::devices_of(const Configuration& configuration) {
    if (!devices_ || selector_ != configuration.trace.device) {
        light_.reset(); // its tracer holds a device
        devices_.emplace(configuration.trace.device);
        selector_ = configuration.trace.device;
    }
    return *devices_;
}

StackResult StackRuns::trace_and_evaluate(const StackScene& scene, const WorkingDevices& devices,
                                          const StackAmongOthers& others, Progress& progress) {
    const Configuration& configuration = scene.configuration;
    enter_stage("device, kernels");
    // A failure must leave no tracer behind, since its device may be lost.
    auto tracer = std::move(light_->tracer);
    if (!tracer) {
        tracer = make_tracer(devices, configuration, scene.instrument, scene.specimen);
    }
    const trace::TracerIdentity identity = tracer->identity();
    require_memory(scene, tracer->device().get());
    enter_stage("folder of the stack");
    scan::ImageStore store(configuration.output_directory, scene.description(identity));
    require_space(store, results_bytes(configuration));
    take_images(store, others.same_images);
    const auto own = developer_of(scene, store, devices);
    std::vector<std::unique_ptr<Follower>> followers;
    if (!store.complete()) {
        for (const Configuration* other : others.same_light) {
            followers.push_back(std::make_unique<Follower>(scene, *other, identity, devices));
        }
    }
    const auto develop = [&](int image, const trace::Image& exposure) {
        parallel_items(static_cast<int>(followers.size()),
                       [&](int k) { followers[static_cast<std::size_t>(k)]->take(image, exposure); });
        return own(image, exposure);
    };
    // Images are evaluated as they are traced, which saves a second pass over the disk.
    GrowingEvaluation evaluation(scene, focus_planes_for(configuration.evaluate_on, tracer->device()),
                                 tracer->pupil_filters());
    enter_stage("images");
    const auto traced = scan::run_stack(
        *tracer, store, progress, [&](int image, Grid<float> values) { evaluation.add(image, std::move(values)); },
        configuration.checkpoint_interval, develop);
    followers.clear();
    spdlog::info("{} images traced, {} kept from before", traced.traced, traced.kept);
    if (traced.device_span > 0) {
        store.append_timing("device at work", traced.device_seconds);
        store.append_timing("device from first to last image", traced.device_span);
    }
    EvaluatedStack evaluated = evaluation.finish(store, identity);
    std::future<void> closed;
    if (others.light_again) {
        light_->tracer = std::move(tracer);
    } else {
        // The tracer frees its memory while results are written, since a driver takes a tenth of a second for
        // gigabytes.
        closed = std::async(std::launch::async, [tracer = std::move(tracer)]() mutable { tracer.reset(); });
    }
    write_stack_results(store, configuration, evaluated);
    return {.evaluation = std::move(evaluated.evaluation),
            .traced = traced,
            .rays_per_image = trace::launched_rays(configuration.trace, configuration.instrument),
            .folder = store.folder(),
            .device = identity.text()};
}

void StackRuns::take_light(const Configuration& configuration, bool keep_surface) {
    const std::string key = light_key(configuration);
    if (!light_ || light_->key != key) {
        light_.reset(); // frees its memory before the next light takes its own
        // The next stack, of another material or instrument, may have the same surface.
        light_ = Light{.key = key,
                       .parts = StackScene::make_parts(configuration, keep_surface ? &surfaces_ : nullptr),
                       .tracer = nullptr};
    }
}

StackResult StackRuns::measure(const Configuration& configuration, Progress& progress, const StackAmongOthers& others) {
    WorkingDevices& devices = devices_of(configuration);
    take_light(configuration, others.more);
    const StackScene scene(configuration, light_->parts);
    log_warnings(scene.planned);
    StackResult result;
    work_with_devices(
        devices, [&](const WorkingDevices& working) { result = trace_and_evaluate(scene, working, others, progress); });
    return result;
}

StackRuns::Traced StackRuns::trace(const Configuration& configuration, Progress& progress,
                                   const scan::ImageVisitor& visit) {
    WorkingDevices& devices = devices_of(configuration);
    take_light(configuration, true);
    const StackScene scene(configuration, light_->parts);
    log_warnings(scene.planned);
    Traced result;
    work_with_devices(devices, [&](const WorkingDevices& working) {
        enter_stage("device, kernels");
        const auto tracer = make_tracer(working, configuration, scene.instrument, scene.specimen);
        const trace::TracerIdentity identity = tracer->identity();
        scan::ImageStore store(configuration.output_directory, scene.description(identity));
        require_space(store, 0);
        const auto develop = developer_of(scene, store, working);
        enter_stage("images");
        result = {.traced =
                      scan::run_stack(*tracer, store, progress, visit, configuration.checkpoint_interval, develop),
                  .device = identity.text()};
    });
    return result;
}

} // namespace vkfv::measurement
