#include "vulkan/device.hpp"

#include "core/files/user_cache.hpp"
#include "core/messages/error.hpp"
#include "vulkan/compiled_kernels.hpp"
#include "vulkan/failure.hpp"
#include "vulkan/loader.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <array>
#include <atomic>
#include <cctype>
#include <charconv>
#include <cstring>
#include <deque>
#include <map>
#include <mutex>
#include <sstream>
#include <string_view>
#include <utility>

namespace vkfv::vulkan {

namespace {

constexpr std::array structure_extensions = {VK_KHR_DEFERRED_HOST_OPERATIONS_EXTENSION_NAME,
                                             VK_KHR_ACCELERATION_STRUCTURE_EXTENSION_NAME};

// Names of the device types in the order of preference.
constexpr std::array<std::string_view, 5> type_names = {"discrete GPU", "integrated GPU", "virtual GPU", "CPU",
                                                        "other"};

std::string_view name_of(vk::PhysicalDeviceType type) {
    switch (type) {
    case vk::PhysicalDeviceType::eDiscreteGpu:
        return type_names[0];
    case vk::PhysicalDeviceType::eIntegratedGpu:
        return type_names[1];
    case vk::PhysicalDeviceType::eVirtualGpu:
        return type_names[2];
    case vk::PhysicalDeviceType::eCpu:
        return type_names[3];
    default:
        return type_names[4];
    }
}

std::size_t rank_of(const DeviceReport& report) {
    return static_cast<std::size_t>(std::ranges::find(type_names, report.type) - type_names.begin());
}

// The first queue family that supports compute and timestamps.
std::optional<std::uint32_t> compute_family(const vk::raii::PhysicalDevice& device) {
    const auto families = device.getQueueFamilyProperties();
    for (std::uint32_t family = 0; family < families.size(); ++family) {
        if ((families[family].queueFlags & vk::QueueFlagBits::eCompute) && families[family].timestampValidBits > 0) {
            return family;
        }
    }
    return std::nullopt;
}

DeviceReport examine(const vk::raii::PhysicalDevice& device, int index) {
    const vk::PhysicalDeviceProperties basic = device.getProperties();
    DeviceReport report;
    report.index = index;
    report.name = basic.deviceName.data();
    report.vendor_id = basic.vendorID;
    report.device_id = basic.deviceID;
    report.type = name_of(basic.deviceType);
    report.api_version = fmt::format("{}.{}.{}", VK_API_VERSION_MAJOR(basic.apiVersion),
                                     VK_API_VERSION_MINOR(basic.apiVersion), VK_API_VERSION_PATCH(basic.apiVersion));
    report.max_storage_buffer_bytes = basic.limits.maxStorageBufferRange;
    for (const vk::MemoryHeap& heap : device.getMemoryProperties().memoryHeaps) {
        if (heap.flags & vk::MemoryHeapFlagBits::eDeviceLocal) {
            report.memory_bytes = std::max(report.memory_bytes, static_cast<std::uint64_t>(heap.size));
        }
    }
    const auto require = [&](bool present, std::string_view what) {
        if (!present) {
            report.lacking.emplace_back(what);
        }
    };
    require(compute_family(device).has_value(), "a compute queue with timestamps");
    if (basic.apiVersion < api_version) {
        report.lacking.push_back(fmt::format("Vulkan 1.2 (it offers {})", report.api_version));
        return report; // the further properties need Vulkan 1.2
    }

    const auto properties = device.getProperties2<vk::PhysicalDeviceProperties2, vk::PhysicalDeviceVulkan11Properties,
                                                  vk::PhysicalDeviceVulkan12Properties>();
    const auto& properties_11 = properties.get<vk::PhysicalDeviceVulkan11Properties>();
    const auto& properties_12 = properties.get<vk::PhysicalDeviceVulkan12Properties>();
    report.driver = fmt::format("{} {}", properties_12.driverName.data(), properties_12.driverInfo.data());
    report.max_allocation_bytes = properties_11.maxMemoryAllocationSize;
    report.subgroup_size = properties_11.subgroupSize;
    const auto has_subgroup = [&](vk::SubgroupFeatureFlagBits operation) {
        return (properties_11.subgroupSupportedStages & vk::ShaderStageFlagBits::eCompute) &&
               (properties_11.subgroupSupportedOperations & operation);
    };
    const auto extensions = device.enumerateDeviceExtensionProperties();
    const auto has_extension = [&](const char* name) {
        return std::ranges::any_of(extensions, [&](const vk::ExtensionProperties& extension) {
            return std::strcmp(extension.extensionName, name) == 0;
        });
    };
    const auto features = device.getFeatures2<vk::PhysicalDeviceFeatures2, vk::PhysicalDeviceVulkan12Features>();
    const auto& features_10 = features.get<vk::PhysicalDeviceFeatures2>().features;
    const auto& features_12 = features.get<vk::PhysicalDeviceVulkan12Features>();
    require(has_extension(VK_KHR_PUSH_DESCRIPTOR_EXTENSION_NAME), "push descriptors (VK_KHR_push_descriptor)");
    require(features_12.bufferDeviceAddress, "buffer device addresses (bufferDeviceAddress)");
    require(features_12.scalarBlockLayout, "scalar block layout (scalarBlockLayout)");
    require(features_10.shaderInt64, "64-bit integers in shaders (shaderInt64)");
    require(features_12.shaderBufferInt64Atomics, "64-bit atomic operations on buffers (shaderBufferInt64Atomics)");
    require(has_subgroup(vk::SubgroupFeatureFlagBits::eBallot), "subgroup ballot in compute shaders");
    require(has_subgroup(vk::SubgroupFeatureFlagBits::eArithmetic), "subgroup arithmetic in compute shaders");

    report.doubles = features_10.shaderFloat64 == VK_TRUE;
    if (std::ranges::all_of(structure_extensions, has_extension)) {
        const auto ray =
            device
                .getFeatures2<vk::PhysicalDeviceFeatures2, vk::PhysicalDeviceAccelerationStructureFeaturesKHR,
                              vk::PhysicalDeviceRayQueryFeaturesKHR, vk::PhysicalDeviceRayTracingPipelineFeaturesKHR>();
        const bool builds =
            ray.get<vk::PhysicalDeviceAccelerationStructureFeaturesKHR>().accelerationStructure == VK_TRUE;
        report.ray_query = builds && has_extension(VK_KHR_RAY_QUERY_EXTENSION_NAME) &&
                           ray.get<vk::PhysicalDeviceRayQueryFeaturesKHR>().rayQuery;
        report.ray_pipeline = builds && has_extension(VK_KHR_RAY_TRACING_PIPELINE_EXTENSION_NAME) &&
                              ray.get<vk::PhysicalDeviceRayTracingPipelineFeaturesKHR>().rayTracingPipeline;
    }
    return report;
}

std::vector<DeviceReport> examine(std::span<const vk::raii::PhysicalDevice> devices) {
    std::vector<DeviceReport> reports;
    for (const vk::raii::PhysicalDevice& device : devices) {
        reports.push_back(examine(device, static_cast<int>(reports.size())));
    }
    return reports;
}

std::string describe(std::span<const DeviceReport> reports) {
    std::string text;
    for (const DeviceReport& report : reports) {
        text +=
            fmt::format("\n  [{}] {} ({}, Vulkan {}): {}", report.index, report.name, report.type, report.api_version,
                        report.lacking.empty() ? "usable" : fmt::format("lacks {}", fmt::join(report.lacking, ", ")));
    }
    return text;
}

std::string lower(std::string text) {
    std::ranges::transform(text, text.begin(), [](unsigned char c) { return std::tolower(c); });
    return text;
}

// True if the selector names the device: an index that a device has, or else a part of the name ("4090").
bool matches(const DeviceReport& report, std::string_view selector, std::size_t device_count) {
    std::size_t index = 0;
    const auto [end, error] = std::from_chars(selector.data(), selector.data() + selector.size(), index);
    if (error == std::errc() && end == selector.data() + selector.size() && index < device_count) {
        return static_cast<std::size_t>(report.index) == index;
    }
    return lower(report.name).find(lower(std::string(selector))) != std::string::npos;
}

// Name of the cached pipelines: by device, driver and the driver's build.
std::string pipelines_name(const vk::raii::PhysicalDevice& device) {
    const auto chain = device.getProperties2<vk::PhysicalDeviceProperties2, vk::PhysicalDeviceIDProperties>();
    const auto& properties = chain.get<vk::PhysicalDeviceProperties2>().properties;
    const auto& ids = chain.get<vk::PhysicalDeviceIDProperties>();
    return fmt::format("pipelines-{:02x}-{:02x}-{:02x}-{:08x}", fmt::join(ids.deviceUUID, ""),
                       fmt::join(ids.driverUUID, ""), fmt::join(properties.pipelineCacheUUID, ""),
                       properties.driverVersion);
}

std::string explain(std::span<const DeviceReport> reports, std::size_t chosen, const DeviceOptions& options) {
    const DeviceReport& report = reports[chosen];
    const auto usable = std::ranges::count_if(reports, [](const DeviceReport& r) { return r.lacking.empty(); });
    constexpr double bytes_per_gib = 1024.0 * 1024.0 * 1024.0;
    const std::string reason =
        !options.selector.empty() ? fmt::format("selected by \"{}\"", options.selector)
        : usable == 1             ? "the only usable device"
                                  : fmt::format("{} with {:.1f} GiB, the first of {} usable devices in the order "
                                                            "discrete, integrated, virtual, CPU, then memory",
                                                report.type, static_cast<double>(report.memory_bytes) / bytes_per_gib, usable);
    return fmt::format("{} ({}): {}", report.name, report.driver, reason);
}

bool is_same_model(const DeviceReport& one, const DeviceReport& other) {
    return one.name == other.name && one.driver == other.driver && one.vendor_id == other.vendor_id &&
           one.device_id == other.device_id;
}

std::size_t one_device(std::span<const DeviceReport> reports, const std::string& selector) {
    std::optional<std::size_t> best;
    bool any_match = false;
    for (std::size_t i = 0; i < reports.size(); ++i) {
        if (!selector.empty() && !matches(reports[i], selector, reports.size())) {
            continue;
        }
        any_match = true;
        if (!reports[i].lacking.empty()) {
            continue;
        }
        const auto key = [&](std::size_t k) {
            return std::pair(type_names.size() - rank_of(reports[k]), reports[k].memory_bytes);
        };
        if (!best || key(i) > key(*best)) {
            best = i;
        }
    }
    if (best) {
        return *best;
    }
    if (!any_match) {
        throw DeviceError(
            fmt::format("No Vulkan device matches \"{}\"; there are:{}\nName a device by its index or by a "
                        "part of its name",
                        selector, describe(reports)));
    }
    const std::string subject = selector.empty() ? "No Vulkan device is usable"
                                                 : fmt::format("The Vulkan device \"{}\" is not usable", selector);
    throw DeviceError(fmt::format("{}; there are:{}\nUpdate the driver of the graphics card, or install the package "
                                  "mesa-vulkan-drivers, whose lavapipe (Mesa 25 or newer) runs on the CPU.{}",
                                  subject, describe(reports), driver_selection()));
}

} // namespace

struct Device::State {
    State() = default;
    State(const State&) = delete;
    State& operator=(const State&) = delete;
    ~State() {
        // Saves the pipelines that the driver has compiled besides those that were read.
        try {
            if (*pipelines && pipelines.getData().size() != pipelines_read) {
                const auto data = pipelines.getData();
                write_cached(pipelines_name, std::as_bytes(std::span(data)));
            }
        } catch (const std::exception&) { // without the cache they are only compiled again
        }
    }

    std::shared_ptr<const Loader> drivers = open_drivers();
    vk::raii::PhysicalDevice physical{nullptr};
    vk::raii::Device device{nullptr};
    struct Queue {
        explicit Queue(vk::raii::Queue of_device) : queue(std::move(of_device)) {}
        vk::raii::Queue queue;
        std::mutex submitting;
    };
    // The queue of a lane; lanes for which the device offers no queue share the last one.
    Queue& queue_of(Lane lane) { return queues[std::min(static_cast<std::size_t>(lane), queues.size() - 1)]; }

    std::deque<Queue> queues;
    vk::raii::PipelineCache pipelines{nullptr};
    CompiledKernels kernels;
    std::string pipelines_name;     // name of the cache for this device and driver
    std::size_t pipelines_read = 0; // bytes
    std::uint32_t queue_family = 0;
    double timestamp_period = 0; // s
    std::uint32_t timestamp_bits = 64;
    vk::PhysicalDeviceMemoryProperties memory;
    std::atomic<std::int64_t> taken{0}; // bytes taken by buffers
    std::atomic<std::int64_t> most_taken{0};
    DeviceReport report;
    std::string choice;
    bool ray_pipelines = false;
};

std::size_t choose_device(std::span<const DeviceReport> reports, const DeviceOptions& options) {
    return choose_devices(reports, options.selector).front();
}

std::vector<std::size_t> choose_devices(std::span<const DeviceReport> reports, const std::string& selector) {
    std::vector<std::size_t> chosen;
    const auto is_one = [&](const DeviceReport& report) { return matches(report, selector, reports.size()); };
    if (selector == "all") {
        const DeviceReport& best = reports[one_device(reports, "")];
        for (std::size_t i = 0; i < reports.size(); ++i) {
            if (reports[i].lacking.empty() && is_same_model(reports[i], best)) {
                chosen.push_back(i);
            }
        }
        return chosen;
    }
    if (selector.find(',') == std::string::npos || std::ranges::any_of(reports, is_one)) {
        return {one_device(reports, selector)};
    }
    std::istringstream names(selector + ","); // the comma makes a missing last name count too
    for (std::string name; std::getline(names, name, ',');) {
        const auto begin = name.find_first_not_of(' ');
        name = begin == std::string::npos ? "" : name.substr(begin, name.find_last_not_of(' ') - begin + 1);
        if (name.empty()) {
            throw DeviceError(fmt::format("A device without a name in \"{}\". Write a list as \"0,1\"", selector));
        }
        chosen.push_back(one_device(reports, name));
        if (!is_same_model(reports[chosen.back()], reports[chosen.front()])) {
            throw DeviceError(fmt::format("The devices of \"{}\" are of different models or drivers, whose images "
                                          "would differ:{}\nName devices that are alike",
                                          selector, describe(reports)));
        }
    }
    return chosen;
}

Device::Device(const DeviceOptions& options) : state_(std::make_unique<State>()) {
    State& state = *state_;
    std::vector<vk::raii::PhysicalDevice> devices = physical_devices(state.drivers->instance);
    std::vector<DeviceReport> reports = examine(devices);
    const std::size_t chosen = choose_device(reports, options);
    state.choice = explain(reports, chosen, options);
    state.report = std::move(reports[chosen]);
    state.report.preferred = true;
    state.physical = std::move(devices[chosen]);
    state.queue_family = compute_family(state.physical).value();
    constexpr double seconds_per_nanosecond = 1e-9;
    state.timestamp_period = seconds_per_nanosecond * state.physical.getProperties().limits.timestampPeriod;
    state.timestamp_bits = state.physical.getQueueFamilyProperties()[state.queue_family].timestampValidBits;
    state.memory = state.physical.getMemoryProperties();

    std::vector<const char*> extensions = {VK_KHR_PUSH_DESCRIPTOR_EXTENSION_NAME};
    vk::StructureChain<vk::DeviceCreateInfo, vk::PhysicalDeviceFeatures2, vk::PhysicalDeviceVulkan12Features,
                       vk::PhysicalDeviceAccelerationStructureFeaturesKHR, vk::PhysicalDeviceRayQueryFeaturesKHR,
                       vk::PhysicalDeviceRayTracingPipelineFeaturesKHR>
        chain;
    chain.get<vk::PhysicalDeviceFeatures2>().features.setShaderInt64(VK_TRUE).setShaderFloat64(
        state.report.doubles ? VK_TRUE : VK_FALSE);
    chain.get<vk::PhysicalDeviceVulkan12Features>()
        .setBufferDeviceAddress(VK_TRUE)
        .setScalarBlockLayout(VK_TRUE)
        .setShaderBufferInt64Atomics(VK_TRUE);
    state.ray_pipelines = options.ray_pipelines;
    if (state.ray_pipelines && !state.report.ray_pipeline) {
        throw DeviceError(
            fmt::format("{} offers no ray-tracing pipelines (VK_KHR_ray_tracing_pipeline). Choose another "
                        "device",
                        state.report.name));
    }
    if (builds_structures()) {
        extensions.insert(extensions.end(), structure_extensions.begin(), structure_extensions.end());
        chain.get<vk::PhysicalDeviceAccelerationStructureFeaturesKHR>().setAccelerationStructure(VK_TRUE);
    } else {
        chain.unlink<vk::PhysicalDeviceAccelerationStructureFeaturesKHR>();
    }
    if (state.report.ray_query) {
        extensions.push_back(VK_KHR_RAY_QUERY_EXTENSION_NAME);
        chain.get<vk::PhysicalDeviceRayQueryFeaturesKHR>().setRayQuery(VK_TRUE);
    } else {
        chain.unlink<vk::PhysicalDeviceRayQueryFeaturesKHR>();
    }
    if (state.ray_pipelines) {
        extensions.push_back(VK_KHR_RAY_TRACING_PIPELINE_EXTENSION_NAME);
        chain.get<vk::PhysicalDeviceRayTracingPipelineFeaturesKHR>().setRayTracingPipeline(VK_TRUE);
    } else {
        chain.unlink<vk::PhysicalDeviceRayTracingPipelineFeaturesKHR>();
    }
    const std::array<float, 2> priorities = {0.5F, 1.0F}; // evaluation, which takes far less time, goes first
    const std::uint32_t queues =
        std::min<std::uint32_t>(static_cast<std::uint32_t>(priorities.size()),
                                state.physical.getQueueFamilyProperties()[state.queue_family].queueCount);
    const vk::DeviceQueueCreateInfo queue_info({}, state.queue_family, queues, priorities.data());
    vk::DeviceCreateInfo& info = chain.get<vk::DeviceCreateInfo>();
    info.setQueueCreateInfos(queue_info);
    info.setPEnabledExtensionNames(extensions);
    try {
        state.device = vk::raii::Device(state.physical, info);
    } catch (const vk::SystemError& error) {
        if (may_pass_next_time(error)) {
            throw run_error_of(error, state.report.name);
        }
        throw DeviceError(fmt::format("The device {} does not open: {}. Another program may hold all of it: end that, "
                                      "or choose another device",
                                      state.report.name, error.what()));
    }
    for (std::uint32_t queue = 0; queue < queues; ++queue) {
        state.queues.emplace_back(vk::raii::Queue(state.device, state.queue_family, queue));
    }
    state.pipelines_name = pipelines_name(state.physical);
    const std::vector<std::byte> pipelines = read_cached(state.pipelines_name);
    state.pipelines_read = pipelines.size();
    try {
        // The driver checks that it wrote the data itself.
        state.pipelines =
            vk::raii::PipelineCache(state.device, vk::PipelineCacheCreateInfo({}, pipelines.size(), pipelines.data()));
    } catch (const vk::SystemError& error) {
        throw run_error_of(error, state.report.name);
    }
}

Device::~Device() = default;
Device::Device(Device&&) noexcept = default;
Device& Device::operator=(Device&&) noexcept = default;

const DeviceReport& Device::report() const {
    return state_->report;
}
const std::string& Device::choice() const {
    return state_->choice;
}
bool Device::has_ray_pipelines() const {
    return state_->ray_pipelines;
}
const vk::raii::Device& Device::handle() const {
    return state_->device;
}
const vk::raii::PhysicalDevice& Device::physical() const {
    return state_->physical;
}
const vk::raii::PipelineCache& Device::pipelines() const {
    return state_->pipelines;
}
Device::HeldQueue Device::hold_queue() const {
    auto& held = state_->queue_of(Lane::evaluation);
    return {std::unique_lock(held.submitting), *held.queue};
}
void Device::submit(Lane lane, const vk::SubmitInfo& info, vk::Fence done) const {
    auto& own = state_->queue_of(lane);
    const std::scoped_lock lock(own.submitting);
    own.queue.submit(info, done);
}
CompiledKernels& Device::kernels() const {
    return state_->kernels;
}
std::uint32_t Device::queue_family() const {
    return state_->queue_family;
}
double Device::seconds_between(std::uint64_t first, std::uint64_t second) const {
    // The highest valid bit of the difference is its sign.
    const std::uint32_t unused = 64U - state_->timestamp_bits;
    const auto ticks = static_cast<std::int64_t>((second - first) << unused) >> unused;
    return static_cast<double>(ticks) * state_->timestamp_period;
}

std::uint64_t Device::peak_memory() const {
    return static_cast<std::uint64_t>(state_->most_taken.load());
}

void Device::count_memory(std::int64_t bytes) const {
    const std::int64_t now = state_->taken += bytes;
    for (std::int64_t most = state_->most_taken; now > most && !state_->most_taken.compare_exchange_weak(most, now);) {
    }
}

std::uint32_t Device::memory_type(std::uint32_t type_bits, vk::MemoryPropertyFlags properties) const {
    for (std::uint32_t type = 0; type < state_->memory.memoryTypeCount; ++type) {
        if ((type_bits >> type & 1U) != 0 &&
            (state_->memory.memoryTypes[type].propertyFlags & properties) == properties) {
            return type;
        }
    }
    throw DeviceError(fmt::format("The device {} has no memory that is {}. Choose another device", state_->report.name,
                                  vk::to_string(properties)));
}

namespace {

struct KeptDevices {
    std::mutex changing;
    std::map<std::string, OpenedDevice> by_selector;
};
std::unique_ptr<KeptDevices> kept_devices; // devices of the DeviceScope

} // namespace

OpenedDevice begin_to_open(const DeviceOptions& options) {
    const auto open = [&options] {
        return std::async(std::launch::async, [options] { return std::make_shared<const Device>(options); }).share();
    };
    if (!kept_devices) {
        return open();
    }
    const std::scoped_lock lock(kept_devices->changing);
    auto& kept = kept_devices->by_selector[options.selector];
    if (!kept.valid()) {
        kept = open();
    }
    return kept;
}

DeviceScope::DeviceScope() {
    kept_devices = std::make_unique<KeptDevices>();
}
DeviceScope::~DeviceScope() {
    kept_devices.reset();
}

std::vector<DeviceReport> list_devices() {
    const auto drivers = open_drivers();
    const std::vector<vk::raii::PhysicalDevice> devices = physical_devices(drivers->instance);
    std::vector<DeviceReport> reports = examine(devices);
    if (std::ranges::any_of(reports, [](const DeviceReport& report) { return report.lacking.empty(); })) {
        reports[choose_device(reports, {})].preferred = true;
    }
    return reports;
}

bool is_hardware(const std::string& selector) {
    const auto reports = list_devices();
    return !is_software(reports[choose_device(reports, {selector})]);
}

} // namespace vkfv::vulkan
