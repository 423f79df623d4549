#include "vulkan/kernel.hpp"

#include "core/files/digest.hpp"
#include "core/messages/error.hpp"
#include "vulkan/failure.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <limits>
#include <stdexcept>

namespace vkfv::vulkan {

namespace {

// Kernels with at least so many constants are specialised before the driver compiles them. Mesa inlines every call of a
// kernel before it looks at constants: with tens of optional surfaces this takes half a minute at every start, as only
// the result is cached.
constexpr std::size_t constants_to_put_in = 100;

// Compiles a pipeline. Throws vk::SystemError.
CompiledKernel compile(const Device& device, std::span<const std::uint32_t> spirv,
                       std::span<const BindingDeclaration> bindings, std::uint32_t push_constant_bytes,
                       std::span<const SpecializationConstant> constants) {
    const Specialization specialization(constants);
    const vk::SpecializationInfo values = specialization.info();
    std::vector<std::uint32_t> specialised;
    if (constants.size() >= constants_to_put_in && is_software(device.report())) {
        specialised = specialised_spirv(spirv, constants);
        spirv = specialised.empty() ? spirv : specialised;
    }
    vk::ShaderModuleCreateInfo module_info;
    module_info.setCodeSize(spirv.size_bytes()).setPCode(spirv.data());
    CompiledKernel made;
    made.layout = PipelineLayout(device, {bindings.begin(), bindings.end()}, push_constant_bytes,
                                 vk::ShaderStageFlagBits::eCompute);
    const vk::raii::ShaderModule module(device.handle(), module_info);
    const vk::PipelineShaderStageCreateInfo stage({}, vk::ShaderStageFlagBits::eCompute, *module, "main", &values);
    made.pipeline = vk::raii::Pipeline(device.handle(), device.pipelines(),
                                       vk::ComputePipelineCreateInfo({}, stage, made.layout.handle()));
    return made;
}

} // namespace

Kernel::Kernel(const Device& device, std::string name, std::span<const std::uint32_t> spirv,
               const std::vector<BindingDeclaration>& bindings, std::uint32_t push_constant_bytes,
               std::span<const SpecializationConstant> constants)
    : name_(std::move(name)) {
    for (const BindingDeclaration& declaration : bindings) {
        if (declaration.kind == BindingKind::acceleration_structure && !device.report().ray_query) {
            throw DeviceError(fmt::format("{} offers no ray query (VK_KHR_ray_query), which {} needs. Choose "
                                          "--traversal quadtree or another device",
                                          device.report().name, name_));
        }
    }
    // The sizes separate one list from the next in the digest.
    const std::array<std::size_t, 4> sizes = {spirv.size(), bindings.size(), constants.size(), push_constant_bytes};
    const std::string key = Digest()
                                .add_values(std::span<const std::size_t>(sizes))
                                .add_values(spirv)
                                .add_values(std::span<const BindingDeclaration>(bindings))
                                .add_values(constants)
                                .sha256();
    try {
        compiled_ =
            device.kernels().get(key, [&] { return compile(device, spirv, bindings, push_constant_bytes, constants); });
    } catch (const vk::SystemError& error) {
        if (may_pass_next_time(error)) {
            throw run_error_of(error, device.report().name);
        }
        throw DeviceError(
            fmt::format("{} ({}) does not compile the kernel {}: {}. Update its driver, or choose another "
                        "device",
                        device.report().name, device.report().driver, name_, error.what()));
    }
}

Commands::Commands(const Device& device, std::uint32_t timestamp_capacity, Device::Lane lane) try
    : device_(&device), pool_(device.handle(), vk::CommandPoolCreateInfo(vk::CommandPoolCreateFlagBits::eTransient,
                                                                         device.queue_family())),
      buffers_(device.handle(), vk::CommandBufferAllocateInfo(*pool_, vk::CommandBufferLevel::ePrimary, 1)),
      lane_(lane), timestamp_capacity_(timestamp_capacity) {
    handle().begin(vk::CommandBufferBeginInfo(vk::CommandBufferUsageFlagBits::eOneTimeSubmit));
    if (timestamp_capacity_ > 0) {
        queries_ = vk::raii::QueryPool(device.handle(),
                                       vk::QueryPoolCreateInfo({}, vk::QueryType::eTimestamp, timestamp_capacity_));
        handle().resetQueryPool(*queries_, 0, timestamp_capacity_);
    }
    barrier();
} catch (const vk::SystemError& error) {
    throw run_error_of(error, device.report().name);
}

void Commands::dispatch(const Kernel& kernel, std::span<const Binding> bindings,
                        std::span<const std::byte> push_constants, std::uint32_t groups_x, std::uint32_t groups_y) {
    const vk::PhysicalDeviceLimits limits = device_->physical().getProperties().limits;
    if (groups_x > limits.maxComputeWorkGroupCount[0] || groups_y > limits.maxComputeWorkGroupCount[1]) {
        throw std::logic_error(fmt::format("kernel {}: {} x {} workgroups, the device allows {} x {}", kernel.name(),
                                           groups_x, groups_y, limits.maxComputeWorkGroupCount[0],
                                           limits.maxComputeWorkGroupCount[1]));
    }
    handle().bindPipeline(vk::PipelineBindPoint::eCompute, kernel.pipeline());
    kernel.layout().bind(*device_, handle(), vk::PipelineBindPoint::eCompute, kernel.name(), bindings, push_constants);
    handle().dispatch(groups_x, groups_y, 1);
}

void Commands::fill_zero(const Buffer& buffer) {
    handle().fillBuffer(buffer.handle(), 0, VK_WHOLE_SIZE, 0);
}

void Commands::copy(const Buffer& from, const Buffer& to, std::size_t bytes, std::size_t from_offset,
                    std::size_t to_offset) {
    if (from_offset > from.bytes() || bytes > from.bytes() - from_offset || to_offset > to.bytes() ||
        bytes > to.bytes() - to_offset) {
        throw std::logic_error(fmt::format("copy of {} bytes from {} of {} to {} of {}", bytes, from_offset,
                                           from.bytes(), to_offset, to.bytes()));
    }
    if (bytes > 0) {
        handle().copyBuffer(from.handle(), to.handle(), vk::BufferCopy(from_offset, to_offset, bytes));
    }
}

void Commands::barrier() {
    using Stage = vk::PipelineStageFlagBits;
    using Access = vk::AccessFlagBits;
    vk::PipelineStageFlags stages = Stage::eComputeShader | Stage::eTransfer;
    vk::AccessFlags writes = Access::eShaderWrite | Access::eTransferWrite;
    vk::AccessFlags reads = Access::eShaderRead | Access::eUniformRead | Access::eTransferRead;
    if (device_->builds_structures()) {
        stages |= Stage::eAccelerationStructureBuildKHR;
        writes |= Access::eAccelerationStructureWriteKHR;
        reads |= Access::eAccelerationStructureReadKHR;
    }
    if (device_->has_ray_pipelines()) {
        stages |= Stage::eRayTracingShaderKHR;
    }
    handle().pipelineBarrier(stages, stages | Stage::eHost, {},
                             vk::MemoryBarrier(writes, writes | reads | Access::eHostRead), {}, {});
}

void Commands::timestamp() {
    if (timestamps_ == timestamp_capacity_) {
        throw std::logic_error(fmt::format("more than {} timestamps", timestamp_capacity_));
    }
    handle().writeTimestamp(vk::PipelineStageFlagBits::eBottomOfPipe, *queries_, timestamps_++);
}

Commands::~Commands() {
    try {
        wait();
    } catch (const std::exception&) { // no work is done on a lost device
    }
}

void Commands::submit() {
    if (*done_) {
        throw std::logic_error("commands are submitted once");
    }
    try {
        barrier();
        handle().end();
        vk::raii::Fence done(device_->handle(), vk::FenceCreateInfo());
        const vk::CommandBuffer commands = *handle();
        vk::SubmitInfo info;
        info.setCommandBuffers(commands);
        device_->submit(lane_, info, *done);
        done_ = std::move(done);
    } catch (const vk::SystemError& error) {
        throw run_error_of(error, device_->report().name);
    }
}

void Commands::wait() {
    if (!*done_ || waited_) {
        return;
    }
    try {
        const vk::Fence fence = *done_;
        // The wait has no time limit, so that it ends in success or throws.
        static_cast<void>(device_->handle().waitForFences(fence, VK_TRUE, std::numeric_limits<std::uint64_t>::max()));
        waited_ = true;
    } catch (const vk::SystemError& error) {
        throw run_error_of(error, device_->report().name);
    }
}

std::vector<std::uint64_t> Commands::ticks() const {
    if (!*done_) {
        throw std::logic_error("timestamps are read after the submission");
    }
    if (timestamps_ == 0) {
        return {};
    }
    try {
        return queries_
            .getResults<std::uint64_t>(0, timestamps_, timestamps_ * sizeof(std::uint64_t), sizeof(std::uint64_t),
                                       vk::QueryResultFlagBits::e64 | vk::QueryResultFlagBits::eWait)
            .second;
    } catch (const vk::SystemError& error) {
        throw run_error_of(error, device_->report().name);
    }
}

std::vector<double> Commands::seconds() const {
    const std::vector<std::uint64_t> ticks = this->ticks();
    std::vector<double> seconds;
    for (const std::uint64_t tick : ticks) {
        seconds.push_back(device_->seconds_between(ticks.front(), tick));
    }
    return seconds;
}

} // namespace vkfv::vulkan
