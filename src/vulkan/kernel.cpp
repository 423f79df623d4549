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

// What every Vulkan device grants; more would run here and fail elsewhere.
constexpr std::uint32_t portable_push_constant_bytes = 128;

// Mesa puts every call of a kernel in its place before it looks at constants. With tens of surfaces that may or may not
// be there this takes half a minute at every start, as only what comes of it is kept.
constexpr std::size_t constants_to_put_in = 100;

vk::DescriptorType type_of(BindingKind kind) {
    switch (kind) {
    case BindingKind::storage_buffer:
        return vk::DescriptorType::eStorageBuffer;
    case BindingKind::uniform_buffer:
        return vk::DescriptorType::eUniformBuffer;
    case BindingKind::acceleration_structure:
        return vk::DescriptorType::eAccelerationStructureKHR;
    }
    throw std::logic_error("unknown kind of binding");
}

const Binding& binding_at(std::uint32_t slot, std::span<const Binding> bindings, const Kernel& kernel) {
    const auto found = std::ranges::find(bindings, slot, &Binding::slot);
    if (found == bindings.end()) {
        throw std::logic_error(fmt::format("kernel {}: nothing is bound to slot {}", kernel.name(), slot));
    }
    return *found;
}

void check_range(const Device& device, const Kernel& kernel, const BindingDeclaration& declaration, std::size_t bytes) {
    const vk::PhysicalDeviceLimits limits = device.physical().getProperties().limits;
    const std::uint32_t allowed =
        declaration.kind == BindingKind::uniform_buffer ? limits.maxUniformBufferRange : limits.maxStorageBufferRange;
    if (bytes > allowed) {
        throw DeviceError(
            fmt::format("{} binds at most {} bytes to a kernel, but {} needs {} at slot {}. Use a smaller "
                        "specimen, smaller batches or another device",
                        device.report().name, allowed, kernel.name(), bytes, declaration.slot));
    }
}

// Throws vk::SystemError.
CompiledKernel compile(const Device& device, std::span<const std::uint32_t> spirv,
                       std::span<const BindingDeclaration> bindings, std::uint32_t push_constant_bytes,
                       std::span<const SpecializationConstant> constants) {
    std::vector<vk::DescriptorSetLayoutBinding> slots;
    for (const BindingDeclaration& declaration : bindings) {
        slots.emplace_back(declaration.slot, type_of(declaration.kind), 1, vk::ShaderStageFlagBits::eCompute);
    }
    std::vector<vk::SpecializationMapEntry> entries;
    std::vector<std::uint32_t> values;
    for (const SpecializationConstant& constant : constants) {
        entries.emplace_back(constant.id, static_cast<std::uint32_t>(values.size() * sizeof(std::uint32_t)),
                             sizeof(std::uint32_t));
        values.push_back(constant.value);
    }
    const vk::SpecializationInfo specialization(static_cast<std::uint32_t>(entries.size()), entries.data(),
                                                values.size() * sizeof(std::uint32_t), values.data());
    std::vector<std::uint32_t> specialised;
    if (constants.size() >= constants_to_put_in && is_software(device.report())) {
        specialised = specialised_spirv(spirv, constants);
        spirv = specialised.empty() ? spirv : specialised;
    }
    vk::ShaderModuleCreateInfo module_info;
    module_info.setCodeSize(spirv.size_bytes()).setPCode(spirv.data());
    CompiledKernel made;
    made.set_layout = vk::raii::DescriptorSetLayout(
        device.handle(),
        vk::DescriptorSetLayoutCreateInfo(vk::DescriptorSetLayoutCreateFlagBits::ePushDescriptorKHR, slots));
    const vk::DescriptorSetLayout set_layout = *made.set_layout;
    const vk::PushConstantRange push_range(vk::ShaderStageFlagBits::eCompute, 0, push_constant_bytes);
    vk::PipelineLayoutCreateInfo layout_info({}, set_layout);
    if (push_constant_bytes > 0) {
        layout_info.setPushConstantRanges(push_range);
    }
    made.layout = vk::raii::PipelineLayout(device.handle(), layout_info);
    const vk::raii::ShaderModule module(device.handle(), module_info);
    const vk::PipelineShaderStageCreateInfo stage({}, vk::ShaderStageFlagBits::eCompute, *module, "main",
                                                  &specialization);
    made.pipeline =
        vk::raii::Pipeline(device.handle(), device.pipelines(), vk::ComputePipelineCreateInfo({}, stage, *made.layout));
    return made;
}

} // namespace

Kernel::Kernel(const Device& device, std::string name, std::span<const std::uint32_t> spirv,
               std::vector<BindingDeclaration> bindings, std::uint32_t push_constant_bytes,
               std::span<const SpecializationConstant> constants)
    : name_(std::move(name)), bindings_(std::move(bindings)), push_constant_bytes_(push_constant_bytes) {
    if (push_constant_bytes_ > portable_push_constant_bytes || push_constant_bytes_ % 4 != 0) {
        throw std::logic_error(fmt::format("kernel {}: {} bytes of push constants, expected a multiple of 4 up to {}",
                                           name_, push_constant_bytes_, portable_push_constant_bytes));
    }
    for (const BindingDeclaration& declaration : bindings_) {
        if (declaration.kind == BindingKind::acceleration_structure && !device.report().ray_query) {
            throw DeviceError(fmt::format("{} offers no ray query (VK_KHR_ray_query), which {} needs. Choose "
                                          "--traversal quadtree or another device",
                                          device.report().name, name_));
        }
    }
    // The sizes tell where a list ends and the next begins.
    const std::array<std::size_t, 4> sizes = {spirv.size(), bindings_.size(), constants.size(), push_constant_bytes_};
    const std::string key = Digest()
                                .add_values(std::span<const std::size_t>(sizes))
                                .add_values(spirv)
                                .add_values(std::span<const BindingDeclaration>(bindings_))
                                .add_values(constants)
                                .sha256();
    try {
        compiled_ = device.kernels().get(
            key, [&] { return compile(device, spirv, bindings_, push_constant_bytes_, constants); });
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
    if (push_constants.size() != kernel.push_constant_bytes()) {
        throw std::logic_error(fmt::format("kernel {}: {} bytes of push constants, expected {}", kernel.name(),
                                           push_constants.size(), kernel.push_constant_bytes()));
    }
    if (bindings.size() != kernel.bindings().size()) {
        throw std::logic_error(fmt::format("kernel {}: {} bindings, expected {}", kernel.name(), bindings.size(),
                                           kernel.bindings().size()));
    }

    const std::size_t count = bindings.size();
    // The writes point into these: no growth after this.
    std::vector<vk::DescriptorBufferInfo> buffers(count);
    std::vector<vk::AccelerationStructureKHR> structures(count);
    std::vector<vk::WriteDescriptorSetAccelerationStructureKHR> structure_writes(count);
    std::vector<vk::WriteDescriptorSet> writes(count);
    for (std::size_t i = 0; i < count; ++i) {
        const BindingDeclaration& declaration = kernel.bindings()[i];
        const Binding& binding = binding_at(declaration.slot, bindings, kernel);
        vk::WriteDescriptorSet& write = writes[i];
        write.setDstBinding(declaration.slot).setDescriptorCount(1).setDescriptorType(type_of(declaration.kind));
        const auto* buffer = std::get_if<const Buffer*>(&binding.resource);
        if ((buffer == nullptr) != (declaration.kind == BindingKind::acceleration_structure)) {
            throw std::logic_error(fmt::format("kernel {}: slot {} is bound to the wrong kind of resource",
                                               kernel.name(), declaration.slot));
        }
        if (buffer != nullptr) {
            const std::size_t all = (*buffer)->bytes();
            const bool is_part = binding.bytes > 0;
            const std::size_t bytes = is_part ? binding.bytes : all;
            if (binding.first_byte % binding_alignment != 0 || (!is_part && binding.first_byte > 0) ||
                (is_part && (binding.first_byte > all || bytes > all - binding.first_byte))) {
                throw std::logic_error(fmt::format("kernel {}: slot {} is bound to {} bytes from {} on of {}",
                                                   kernel.name(), declaration.slot, bytes, binding.first_byte, all));
            }
            check_range(*device_, kernel, declaration, bytes);
            // Without its padding, so that a run-time array's length() is right.
            const vk::DeviceSize range = bytes > 0 ? bytes : VK_WHOLE_SIZE;
            buffers[i] = vk::DescriptorBufferInfo((*buffer)->handle(), binding.first_byte, range);
            write.setBufferInfo(buffers[i]);
        } else {
            structures[i] = std::get<const AccelerationStructure*>(binding.resource)->top_level();
            structure_writes[i].setAccelerationStructures(structures[i]);
            write.setPNext(&structure_writes[i]);
        }
    }

    handle().bindPipeline(vk::PipelineBindPoint::eCompute, kernel.pipeline());
    if (!writes.empty()) {
        handle().pushDescriptorSetKHR(vk::PipelineBindPoint::eCompute, kernel.layout(), 0, writes);
    }
    if (!push_constants.empty()) {
        handle().pushConstants<std::byte>(
            kernel.layout(), vk::ShaderStageFlagBits::eCompute, 0,
            vk::ArrayProxy<const std::byte>(static_cast<std::uint32_t>(push_constants.size()), push_constants.data()));
    }
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
    if (device_->report().ray_query) {
        stages |= Stage::eAccelerationStructureBuildKHR;
        writes |= Access::eAccelerationStructureWriteKHR;
        reads |= Access::eAccelerationStructureReadKHR;
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
    } catch (const std::exception&) { // of a lost device nothing works on
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
        // Without a limit the wait ends in success or throws.
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
