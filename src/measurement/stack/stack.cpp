#include "measurement/stack/stack.hpp"

#include "core/files/file.hpp"
#include "core/messages/safe_text.hpp"
#include "core/messages/stages.hpp"
#include "measurement/scene/disk_space.hpp"
#include "measurement/scene/working_devices.hpp"
#include "measurement/stack/stack_parts.hpp"
#include "measurement/stack/stack_runs.hpp"
#include "scan/stack_identity.hpp"

#include <fmt/format.h>

#include <system_error>

namespace vkfv::measurement {

Configuration load_stack(const std::filesystem::path& file, const std::vector<TomlOverride>& overrides) {
    auto configuration = load_configuration(file, overrides, Needs::stack);
    const auto begun = configuration.output_directory / scan::configuration_name;
    std::error_code none;
    if (!configuration.estimator_is_chosen || !std::filesystem::exists(begun, none)) {
        return configuration;
    }
    const std::string identity = scan::identity_in(read_file(begun));
    const auto estimator = TomlTable::parse(identity, begun).table_or_empty("trace").optional_string("estimator");
    if (!estimator) { // the folder holds something else, as the store will tell
        return configuration;
    }
    auto of_folder = overrides;
    of_folder.push_back({"trace.estimator", toml_quoted(*estimator), begun.string()});
    return load_configuration(file, of_folder, Needs::stack);
}

StackResult measure_stack(const Configuration& configuration, Progress& progress) {
    return StackRuns().measure(configuration, progress);
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
                       shard.index + 1, shard.count, traced.traced, traced.kept, safe_line(folder.string()));
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
    return text + fmt::format("results in {}\n", safe_line(stack.folder.string()));
}

} // namespace vkfv::measurement
