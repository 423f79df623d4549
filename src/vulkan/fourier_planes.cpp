#include "vulkan/fourier_planes.hpp"

#include "core/files/digest.hpp"
#include "core/files/user_cache.hpp"
#include "core/messages/error.hpp"

#define VKFFT_BACKEND 0
#include <vkFFT.h>

#include <fmt/format.h>

#include <cstring>
#include <span>
#include <vector>

namespace vkfv::vulkan {

namespace {

// Name of the transform's kernels in the cache, as VkFFT saves them, by all that they depend on.
std::string kept_name(const Device& device, int columns, int rows, int planes, FourierPlanes::Direction direction) {
    const DeviceReport& report = device.report();
    return "fourier-" +
           Digest()
               .add(fmt::format("{} {:x} {:x} {} {} {} {} {} {}", fourier_library(), report.vendor_id, report.device_id,
                                report.driver, report.name, columns, rows, planes, static_cast<int>(direction)))
               .text();
}

} // namespace

struct FourierPlanes::State {
    State() = default;
    State(const State&) = delete;
    State& operator=(const State&) = delete;
    ~State() {
        if (made) {
            deleteVkFFT(&application);
        }
    }

    VkPhysicalDevice physical{};
    VkDevice device{};
    VkQueue queue{};
    VkPipelineCache pipelines{};
    vk::raii::CommandPool pool{nullptr};
    VkCommandPool pool_handle{};
    vk::raii::Fence fence{nullptr};
    VkFence fence_handle{};
    VkBuffer buffer{};
    std::uint64_t bytes = 0;
    Direction direction = Direction::forward;
    VkFFTApplication application{};
    bool made = false;
};

FourierPlanes::FourierPlanes(const Device& device, const Buffer& buffer, int columns, int rows, int planes,
                             Direction direction)
    : state_(std::make_unique<State>()) {
    State& state = *state_;
    state.physical = *device.physical();
    state.device = *device.handle();
    state.pipelines = *device.pipelines();
    state.pool = vk::raii::CommandPool(device.handle(),
                                       {vk::CommandPoolCreateFlagBits::eResetCommandBuffer, device.queue_family()});
    state.pool_handle = *state.pool;
    state.fence = vk::raii::Fence(device.handle(), vk::FenceCreateInfo());
    state.fence_handle = *state.fence;
    state.buffer = buffer.handle();
    state.bytes = static_cast<std::uint64_t>(columns) * static_cast<std::uint64_t>(rows) *
                  static_cast<std::uint64_t>(planes) * 2 * sizeof(float);
    state.direction = direction;

    VkFFTConfiguration configuration{};
    configuration.FFTdim = 2;
    configuration.size[0] = static_cast<std::uint64_t>(columns);
    configuration.size[1] = static_cast<std::uint64_t>(rows);
    configuration.numberBatches = static_cast<std::uint64_t>(planes);
    configuration.physicalDevice = &state.physical;
    configuration.device = &state.device;
    configuration.queue = &state.queue;
    configuration.commandPool = &state.pool_handle;
    configuration.fence = &state.fence_handle;
    configuration.pipelineCache = &state.pipelines;
    configuration.buffer = &state.buffer;
    configuration.bufferSize = &state.bytes;
    configuration.makeForwardPlanOnly = direction == Direction::forward ? 1 : 0;
    configuration.makeInversePlanOnly = direction == Direction::inverse ? 1 : 0;

    // The queue is held to the end: another caller that needs the same kernels then finds them in the cache.
    const auto held = device.hold_queue();
    state.queue = held.queue;
    const std::string name = kept_name(device, columns, rows, planes, direction);
    std::vector<std::byte> kept = read_cached(name);
    configuration.loadApplicationFromString = kept.empty() ? 0 : 1;
    configuration.loadApplicationString = kept.data();
    configuration.saveApplicationToString = kept.empty() ? 1 : 0;
    const VkFFTResult result = initializeVkFFT(&state.application, configuration);
    if (result != VKFFT_SUCCESS) {
        throw RunError(fmt::format("{}: {} cannot transform {} planes of {} x {} (its error {}). Set diffraction.model "
                                   "= \"none\", or take fewer pixels",
                                   device.report().name, fourier_library(), planes, columns, rows,
                                   static_cast<int>(result)));
    }
    state.made = true;
    if (kept.empty() && state.application.saveApplicationString != nullptr) {
        write_cached(name, std::span(static_cast<const std::byte*>(state.application.saveApplicationString),
                                     static_cast<std::size_t>(state.application.applicationStringSize)));
    }
}

FourierPlanes::~FourierPlanes() = default;
FourierPlanes::FourierPlanes(FourierPlanes&&) noexcept = default;
FourierPlanes& FourierPlanes::operator=(FourierPlanes&&) noexcept = default;

void FourierPlanes::record(Commands& commands) const {
    VkCommandBuffer buffer = *commands.handle();
    VkFFTLaunchParams launch{};
    launch.commandBuffer = &buffer;
    const int inverse = state_->direction == Direction::inverse ? 1 : -1;
    if (const VkFFTResult result = VkFFTAppend(&state_->application, inverse, &launch); result != VKFFT_SUCCESS) {
        throw RunError(fmt::format("{}: error {} of a transform", fourier_library(), static_cast<int>(result)));
    }
    commands.barrier();
}

std::string fourier_library() {
    const int version = VkFFTGetVersion();
    return fmt::format("VkFFT {}.{}.{}", version / 10000, version / 100 % 100, version % 100);
}

} // namespace vkfv::vulkan
