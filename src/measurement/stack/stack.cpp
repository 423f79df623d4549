#include "measurement/stack/stack.hpp"

#include "core/messages/stages.hpp"
#include "measurement/image/camera_images.hpp"
#include "measurement/scene/disk_space.hpp"
#include "measurement/scene/working_devices.hpp"
#include "measurement/stack/stack_parts.hpp"

#include <fmt/format.h>
#include <spdlog/spdlog.h>

#include <future>
#include <memory>
#include <utility>

namespace vkfv::measurement {

namespace {

// What images are made of their light by: the camera, if there is one.
scan::ImageDeveloper developer_of(const StackScene& scene, const scan::ImageStore& store,
                                  const WorkingDevices& devices) {
    const Configuration& configuration = scene.configuration;
    if (!configuration.camera) {
        return scan::light_itself;
    }
    enter_stage("exposure time");
    const double seconds = exposure_time(store, configuration, scene.instrument, scene.specimen, devices);
    const auto camera = std::make_shared<const ImagingCamera>(configuration, scene.instrument, seconds);
    return [camera](int image, const trace::Image& exposure) { return camera->develop(image, exposure); };
}

StackResult trace_and_evaluate(const StackScene& scene, const WorkingDevices& devices, Progress& progress) {
    const Configuration& configuration = scene.configuration;
    enter_stage("device, kernels");
    auto tracer = make_tracer(devices, configuration, scene.instrument, scene.specimen);
    const trace::TracerIdentity identity = tracer->identity();
    enter_stage("folder of the stack");
    scan::ImageStore store(configuration.output_directory, scene.description(identity));
    require_space(store, results_bytes(configuration));
    const auto developer = developer_of(scene, store, devices);
    // Evaluated as they are traced: no second pass over the disk.
    GrowingEvaluation evaluation(scene, focus_planes_for(configuration.evaluate_on, tracer->device()),
                                 tracer->pupil_filters());
    enter_stage("images");
    const auto traced = scan::run_stack(
        *tracer, store, progress, [&](int image, Grid<float> values) { evaluation.add(image, std::move(values)); },
        configuration.checkpoint_interval, developer);
    spdlog::info("{} images traced, {} kept from before", traced.traced, traced.kept);
    if (traced.device_span > 0) {
        store.append_timing("device at work", traced.device_seconds);
        store.append_timing("device from first to last image", traced.device_span);
    }
    EvaluatedStack evaluated = evaluation.finish(store, identity);
    // The tracer gives its memory back beside the results: a driver takes a tenth of a second for gigabytes.
    const auto closed = std::async(std::launch::async, [tracer = std::move(tracer)]() mutable { tracer.reset(); });
    write_stack_results(store, configuration, evaluated);
    return {.evaluation = std::move(evaluated.evaluation),
            .traced = traced,
            .rays_per_image = trace::launched_rays(configuration.trace, configuration.instrument),
            .folder = store.folder(),
            .device = identity.text()};
}

} // namespace

StackResult measure_stack(const Configuration& configuration, Progress& progress) {
    WorkingDevices devices(configuration.trace.device);
    const StackScene scene(configuration);
    StackResult result;
    work_with_devices(devices,
                      [&](const WorkingDevices& working) { result = trace_and_evaluate(scene, working, progress); });
    return result;
}

ShardResult trace_shard(const Configuration& configuration, scan::Shard shard, Progress& progress) {
    WorkingDevices devices(configuration.trace.device);
    const StackScene scene(configuration);
    ShardResult result{.shard = shard, .traced = {}, .folder = configuration.output_directory};
    work_with_devices(devices, [&](const WorkingDevices& working) {
        enter_stage("device, kernels");
        const auto tracer = make_tracer(working, configuration, scene.instrument, scene.specimen);
        enter_stage("folder of the stack");
        scan::ImageStore store(configuration.output_directory, scene.description(tracer->identity()), shard);
        require_space(store, 0);
        enter_stage("images");
        result.traced = scan::run_stack(*tracer, store, progress, {}, configuration.checkpoint_interval,
                                        developer_of(scene, store, working));
    });
    enter_stage("end");
    return result;
}

std::string summary(const ShardResult& result) {
    const auto& [shard, traced, folder] = result;
    return fmt::format("shard {} of {}: {} images traced, {} kept from before, in {}\n"
                       "vkfv merge puts the shards together when all are there\n",
                       shard.index + 1, shard.count, traced.traced, traced.kept, folder.string());
}

nlohmann::ordered_json shard_json(const ShardResult& result) {
    return {{"shard", result.shard.index + 1},
            {"shards", result.shard.count},
            {"traced", result.traced.traced},
            {"kept", result.traced.kept},
            {"folder", result.folder.string()}};
}

std::string summary(const StackResult& stack) {
    const auto& traced = stack.traced;
    std::string text = summary(stack.evaluation);
    if (traced.traced > 0) {
        text +=
            fmt::format("traced {} images in {:.3g} s ({}{}), evaluated in {:.2g} s\n", traced.traced,
                        traced.trace_seconds, ray_rate_text(static_cast<double>(traced.rays) / traced.trace_seconds),
                        traced.device_span > 0 ? fmt::format("; the device was at work for {:.0f} % of it",
                                                             100 * traced.device_seconds / traced.device_span)
                                               : "",
                        stack.evaluation.seconds);
    }
    return text + fmt::format("results in {}\n", stack.folder.string());
}

} // namespace vkfv::measurement
