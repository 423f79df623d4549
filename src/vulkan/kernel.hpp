// Compute kernels, their bindings, and the recording of their dispatches.
#pragma once

#include "vulkan/compiled_kernels.hpp"
#include "vulkan/pipeline_layout.hpp"
#include "vulkan/specialised_spirv.hpp"

#include <cstdint>
#include <memory>
#include <span>
#include <string>
#include <vector>

namespace vkfv::vulkan {

// A compute pipeline with push descriptors in set 0 and push constants at offset 0. A device compiles a kernel once:
// kernels of the same code, bindings and constants share one pipeline, which it keeps until it closes.
class Kernel {
  public:
    Kernel(const Device& device, std::string name, std::span<const std::uint32_t> spirv,
           const std::vector<BindingDeclaration>& bindings, std::uint32_t push_constant_bytes = 0,
           std::span<const SpecializationConstant> constants = {});

    const std::string& name() const { return name_; }
    vk::Pipeline pipeline() const { return *compiled_->pipeline; }
    const PipelineLayout& layout() const { return compiled_->layout; }

  private:
    std::string name_;
    std::shared_ptr<const CompiledKernel> compiled_;
};

// Workgroups for so many places (at least 1), in rows where a dispatch cannot hold them in one. The last row may reach
// beyond the places.
inline constexpr std::uint32_t most_groups_in_a_row = 65535; // guaranteed by Vulkan
struct Groups {
    std::uint32_t x;
    std::uint32_t y;
};
inline Groups groups_of(std::uint64_t places, std::uint32_t workgroup) {
    const std::uint64_t groups = (places + workgroup - 1) / workgroup;
    const std::uint64_t rows = (groups + most_groups_in_a_row - 1) / most_groups_in_a_row;
    return {static_cast<std::uint32_t>((groups + rows - 1) / rows), static_cast<std::uint32_t>(rows)};
}

// Commands recorded once and submitted. All barriers are made here: one is placed before the first command and one
// after the last; the caller places those between by barrier(). Submissions to one lane of a device run one after the
// other.
class Commands {
  public:
    explicit Commands(const Device& device, std::uint32_t timestamp_capacity = 0,
                      Device::Lane lane = Device::Lane::trace);
    // Waits for the submitted commands.
    ~Commands();
    Commands(const Commands&) = delete;
    Commands& operator=(const Commands&) = delete;

    // Bindings and push constants must be those that the kernel declares: throws as PipelineLayout::bind().
    void dispatch(const Kernel& kernel, std::span<const Binding> bindings, std::span<const std::byte> push_constants,
                  std::uint32_t groups_x, std::uint32_t groups_y = 1);
    template <class Push>
    void dispatch(const Kernel& kernel, std::span<const Binding> bindings, const Push& push, std::uint32_t groups_x,
                  std::uint32_t groups_y = 1) {
        dispatch(kernel, bindings, std::as_bytes(std::span(&push, 1)), groups_x, groups_y);
    }
    void fill_zero(const Buffer& buffer);
    void copy(const Buffer& from, const Buffer& to, std::size_t bytes, std::size_t from_offset = 0,
              std::size_t to_offset = 0);
    // Everything before is finished and visible (shader, transfer, uniform, build, host read) to everything
    // after.
    void barrier();
    void timestamp(); // the k-th call is seconds()[k]

    // The command buffer, for commands that have no function here.
    const vk::raii::CommandBuffer& handle() const { return buffers_.front(); }

    // submit() and wait() throw RunError if the device is lost. submit() may be called once, from any thread.
    void submit();
    void wait();
    void submit_and_wait() {
        submit();
        wait();
    }
    std::vector<double> seconds() const;      // timestamps since the first, s; waits for them
    std::vector<std::uint64_t> ticks() const; // in timestamp periods of the device's own clock; waits for them

  private:
    const Device* device_;
    vk::raii::CommandPool pool_{nullptr};
    vk::raii::CommandBuffers buffers_{nullptr};
    vk::raii::QueryPool queries_{nullptr};
    vk::raii::Fence done_{nullptr};
    bool waited_ = false; // true: done_ has been waited for
    Device::Lane lane_;
    std::uint32_t timestamp_capacity_;
    std::uint32_t timestamps_ = 0;
};

} // namespace vkfv::vulkan
