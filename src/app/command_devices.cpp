#include "app/commands.hpp"

#include "core/messages/json_text.hpp"
#include "core/messages/safe_text.hpp"
#include "vulkan/device.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>
#include <nlohmann/json.hpp>

#include <cstdio>

namespace vkfv::app {

Command devices_command() {
    return {.name = "devices",
            .summary = "List devices, what each lacks and which would be used",
            .options = {json_option()},
            .run = run_devices,
            .example = "vkfv devices"};
}

namespace {

constexpr double bytes_per_gib = 1024.0 * 1024.0 * 1024.0;

nlohmann::ordered_json json_of(const vulkan::DeviceReport& device) {
    return {{"index", device.index},
            {"name", device.name},
            {"driver", device.driver},
            {"type", device.type},
            {"api_version", device.api_version},
            {"ray_query", device.ray_query},
            {"subgroup_size", device.subgroup_size},
            {"memory_bytes", device.memory_bytes},
            {"max_storage_buffer_bytes", device.max_storage_buffer_bytes},
            {"lacking", device.lacking},
            {"usable", device.lacking.empty()},
            {"preferred", device.preferred}};
}

std::string text_of(const vulkan::DeviceReport& device) {
    std::string text = fmt::format("{} {}: {}\n", device.preferred ? "*" : " ", device.index, device.name);
    text += fmt::format("     {}, Vulkan {}, {}\n", device.type, device.api_version, device.driver);
    text += fmt::format("     {:.1f} GiB, buffers up to {:.1f} GiB, subgroups of {}\n",
                        static_cast<double>(device.memory_bytes) / bytes_per_gib,
                        static_cast<double>(device.max_storage_buffer_bytes) / bytes_per_gib, device.subgroup_size);
    text += device.lacking.empty()
                ? fmt::format("     usable; traversals: quadtree, bvh{}\n", device.ray_query ? ", ray-query" : "")
                : fmt::format("     not usable, lacks: {}\n", fmt::join(device.lacking, ", "));
    return text;
}

} // namespace

void run_devices(const CommandOptions& options) {
    const auto devices = vulkan::list_devices();
    if (options.json) {
        auto list = nlohmann::ordered_json::array();
        for (const auto& device : devices) {
            list.push_back(json_of(device));
        }
        print_text(json_text(list) + "\n");
        return;
    }
    for (const auto& device : devices) {
        print_text(text_of(device));
    }
    print_text("* would be used; --device takes an index or a part of a name, or \"host\" for the reference "
               "in double "
               "on the processor\n");
}

} // namespace vkfv::app
