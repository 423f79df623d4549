#include "vulkan/compiled_kernels.hpp"

namespace vkfv::vulkan {

CompiledKernels::Made CompiledKernels::get(const std::string& key, const std::function<CompiledKernel()>& make) {
    std::promise<Made> promise;
    std::shared_future<Made> future;
    {
        const std::scoped_lock lock(changing_);
        const auto [entry, is_new] = made_.try_emplace(key);
        if (!is_new) {
            future = entry->second;
        } else {
            entry->second = promise.get_future().share();
        }
    }
    if (future.valid()) {
        return future.get();
    }
    try {
        auto made = std::make_shared<const CompiledKernel>(make());
        promise.set_value(made);
        return made;
    } catch (...) {
        promise.set_exception(std::current_exception());
        const std::scoped_lock lock(changing_);
        made_.erase(key);
        throw;
    }
}

} // namespace vkfv::vulkan
