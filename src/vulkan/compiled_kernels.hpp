// The kernels that a device has compiled.
#pragma once

#include "vulkan/pipeline_layout.hpp"

#include <vulkan/vulkan_raii.hpp>

#include <functional>
#include <future>
#include <map>
#include <memory>
#include <mutex>
#include <string>

namespace vkfv::vulkan {

struct CompiledKernel {
    PipelineLayout layout;
    vk::raii::Pipeline pipeline{nullptr};
};

// Compiled pipelines by a key of all that they are made from. It may be called from any thread: a caller that asks for
// a pipeline that another thread is making waits for it, and others are made meanwhile.
class CompiledKernels {
  public:
    using Made = std::shared_ptr<const CompiledKernel>;

    // The pipeline of `key`, made by `make` if there is none. Throws what `make` throws; the next call tries again.
    Made get(const std::string& key, const std::function<CompiledKernel()>& make);

  private:
    std::mutex changing_;
    std::map<std::string, std::shared_future<Made>> made_;
};

} // namespace vkfv::vulkan
