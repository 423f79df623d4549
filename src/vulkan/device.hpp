// A Vulkan device that can run the trace, and how it was chosen.
#pragma once

#include "vulkan/opened_device.hpp"

#include <vulkan/vulkan_raii.hpp>

#include <cstdint>
#include <memory>
#include <mutex>
#include <span>
#include <string>
#include <vector>

namespace vkfv::vulkan {

class CompiledKernels;

// Properties of a physical device. `lacking` names what the trace needs and the device lacks; empty: usable.
struct DeviceReport {
    int index = 0; // in the order of vkEnumeratePhysicalDevices
    std::string name;
    std::string driver;          // driver name and version
    std::uint32_t vendor_id = 0; // PCI vendor
    std::uint32_t device_id = 0;
    std::string type; // "discrete GPU", "integrated GPU", "CPU", ...
    std::string api_version;
    bool ray_query = false;    // not needed: the trace has other traversals
    bool ray_pipeline = false; // VK_KHR_ray_tracing_pipeline; not needed: it can probe structures without ray query
    bool doubles = false;      // in shaders; not needed: the host has doubles
    std::uint32_t subgroup_size = 0;
    std::uint64_t memory_bytes = 0; // the largest device-local heap
    std::uint64_t max_storage_buffer_bytes = 0;
    std::uint64_t max_allocation_bytes = 0; // largest buffer; 0: the device has no Vulkan 1.2
    std::vector<std::string> lacking;
    bool preferred = false; // the device that is used by default
};

// True if the device is the host's own cores.
inline bool is_software(const DeviceReport& report) {
    return report.type == "CPU";
}

struct DeviceOptions {
    std::string selector;       // empty: the best; else an index or a part of the name, or a list for choose_devices()
    bool ray_pipelines = false; // also opens it for RayPipeline; DeviceError if it has no such pipelines
};

// The index into `reports` of the device to use: the selector's, else discrete before integrated before virtual before
// CPU, and the larger memory among equals. For a list of devices it is the first. Throws DeviceError that says what
// each device lacks.
std::size_t choose_device(std::span<const DeviceReport> reports, const DeviceOptions& options);

// All devices that a selector names: one device, "all" that are like the best, or several separated by commas ("0,1"),
// of which one may be named twice. Throws DeviceError, also where they are of different models or drivers, as their
// images would differ.
std::vector<std::size_t> choose_devices(std::span<const DeviceReport> reports, const std::string& selector);

// One logical device with a compute queue, or two; devices that exist at the same time share one instance. Move-only;
// construct valid, then const. Buffers, kernels and commands point to it: it must outlive them, unmoved. With
// VKFV_VALIDATION the Khronos layer checks every call, and a message from it aborts the program.
class Device {
  public:
    // Prefers discrete over integrated over CPU; choice() gives the reason.
    // Throws DeviceError that says what each device lacks, or that no driver was found, with the remedy.
    explicit Device(const DeviceOptions& options = {});
    ~Device();
    Device(Device&&) noexcept;
    Device& operator=(Device&&) noexcept;

    const DeviceReport& report() const;
    const std::string& choice() const; // one sentence: which device, and why
    bool has_ray_pipelines() const;    // true: opened for them
    bool builds_structures() const { return report().ray_query || has_ray_pipelines(); }
    const vk::raii::Device& handle() const;
    const vk::raii::PhysicalDevice& physical() const;
    // Queue of work. Submissions to one lane run in their order; lanes run in parallel where the device offers several
    // queues.
    enum class Lane { trace, evaluation };
    // Submits from any thread, one at a time. Throws vk::SystemError.
    void submit(Lane lane, const vk::SubmitInfo& info, vk::Fence done) const;
    // The queue of Lane::evaluation, for a library that submits by itself: no one else submits to it while it is held.
    // On devices with one queue it is also the trace's.
    struct HeldQueue {
        std::unique_lock<std::mutex> lock;
        vk::Queue queue;
    };
    HeldQueue hold_queue() const;
    // The pipelines that the driver has compiled, here and in earlier runs on this device and driver
    // (core/files/user_cache.hpp); saved to disk when the device closes.
    const vk::raii::PipelineCache& pipelines() const;
    // The kernels that this device has compiled, for kernel.hpp.
    CompiledKernels& kernels() const;
    std::uint32_t queue_family() const;
    // Seconds between two timestamps, whose counter may wrap; if they are less than half of its range apart, either may
    // be the later one.
    double seconds_between(std::uint64_t first, std::uint64_t second) const;
    // Most bytes that its buffers have taken at one time so far.
    std::uint64_t peak_memory() const;
    void count_memory(std::int64_t bytes) const; // positive: taken, negative: given back; any thread
    // Index of a memory type among `type_bits` with the properties; throws DeviceError when there is none.
    std::uint32_t memory_type(std::uint32_t type_bits, vk::MemoryPropertyFlags properties) const;

  private:
    struct State;
    std::unique_ptr<State> state_;
};

// While it exists, the drivers that a first device has opened stay open, for the many devices that a sweep of stacks
// makes one after the other: a driver that is opened and closed each time is refused at about the hundredth (NVIDIA
// 580.159). A process has one, in main(): the drivers are closed before their static objects end.
class DriverScope {
  public:
    DriverScope();
    ~DriverScope();
    DriverScope(const DriverScope&) = delete;
    DriverScope& operator=(const DriverScope&) = delete;
};

// While it exists, begin_to_open() returns the device opened before by the same selector, which keeps its kernels: for
// tests, many of which run in one process. A process has one, in main(), within a DriverScope.
class DeviceScope {
  public:
    DeviceScope();
    ~DeviceScope();
    DeviceScope(const DeviceScope&) = delete;
    DeviceScope& operator=(const DeviceScope&) = delete;
};

// Reports all devices that the loader finds; throws DeviceError if there is no Vulkan at all.
std::vector<DeviceReport> list_devices();

// True if the selector's device has cores of its own, so that its work costs the host nothing. Throws DeviceError.
bool is_hardware(const std::string& selector);

} // namespace vkfv::vulkan
