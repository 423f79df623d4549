// A Vulkan layer in which one call fails that might. The settings are those of plan.hpp; VKFV_FAULT_CALL is the name of
// a function, VKFV_FAULT_EFFECT the name of the VkResult that it returns: VK_ERROR_DEVICE_LOST, after which no queue
// takes or finishes work any more, VK_ERROR_OUT_OF_DEVICE_MEMORY, VK_ERROR_OUT_OF_HOST_MEMORY or
// VK_ERROR_INITIALIZATION_FAILED.
//
// One instance and one kind of device at a time, as vkfv has them.
#include "plan.hpp"

#include <iterator>
#include <string_view>

#include <vulkan/vk_layer.h>
#include <vulkan/vulkan.h>

// Functions of a device that return a VkResult and that vkfv calls.
#define DEVICE_FUNCTIONS(FUNCTION)                                                                                     \
    FUNCTION(AllocateCommandBuffers)                                                                                   \
    FUNCTION(AllocateMemory)                                                                                           \
    FUNCTION(BeginCommandBuffer)                                                                                       \
    FUNCTION(BindBufferMemory)                                                                                         \
    FUNCTION(CreateAccelerationStructureKHR)                                                                           \
    FUNCTION(CreateBuffer)                                                                                             \
    FUNCTION(CreateCommandPool)                                                                                        \
    FUNCTION(CreateComputePipelines)                                                                                   \
    FUNCTION(CreateDescriptorSetLayout)                                                                                \
    FUNCTION(CreateFence)                                                                                              \
    FUNCTION(CreatePipelineCache)                                                                                      \
    FUNCTION(CreatePipelineLayout)                                                                                     \
    FUNCTION(CreateQueryPool)                                                                                          \
    FUNCTION(CreateShaderModule)                                                                                       \
    FUNCTION(DeviceWaitIdle)                                                                                           \
    FUNCTION(EndCommandBuffer)                                                                                         \
    FUNCTION(GetPipelineCacheData)                                                                                     \
    FUNCTION(GetQueryPoolResults)                                                                                      \
    FUNCTION(MapMemory)                                                                                                \
    FUNCTION(QueueSubmit)                                                                                              \
    FUNCTION(QueueWaitIdle)                                                                                            \
    FUNCTION(ResetFences)                                                                                              \
    FUNCTION(WaitForFences)

#define INSTANCE_FUNCTIONS(FUNCTION)                                                                                   \
    FUNCTION(CreateDevice)                                                                                             \
    FUNCTION(EnumerateDeviceExtensionProperties)                                                                       \
    FUNCTION(EnumeratePhysicalDevices)

namespace {

#define ENUMERATOR(name) name,
enum Function { DEVICE_FUNCTIONS(ENUMERATOR) INSTANCE_FUNCTIONS(ENUMERATOR) CreateInstance, functions };
#undef ENUMERATOR

#define NAME(name) "vk" #name,
constexpr const char* names[] = {DEVICE_FUNCTIONS(NAME) INSTANCE_FUNCTIONS(NAME) "vkCreateInstance"};
#undef NAME
static_assert(std::size(names) == functions);

std::atomic<PFN_vkVoidFunction> next_functions[functions]; // of the layer or driver below
std::atomic<long> counts[functions];
std::atomic<PFN_vkGetInstanceProcAddr> next_instance_function;
std::atomic<PFN_vkGetDeviceProcAddr> next_device_function;
std::atomic<bool> lost{false};

VkResult result_to_return() {
    const std::string_view effect = vkfv::faults::setting("VKFV_FAULT_EFFECT");
    if (effect == "VK_ERROR_DEVICE_LOST") {
        return VK_ERROR_DEVICE_LOST;
    }
    if (effect == "VK_ERROR_OUT_OF_DEVICE_MEMORY") {
        return VK_ERROR_OUT_OF_DEVICE_MEMORY;
    }
    return effect == "VK_ERROR_OUT_OF_HOST_MEMORY" ? VK_ERROR_OUT_OF_HOST_MEMORY : VK_ERROR_INITIALIZATION_FAILED;
}

// The result with which this call is to fail; success if it is not to.
VkResult fault(Function function) {
    if (vkfv::faults::is_due(names[function], "", counts[function])) {
        const VkResult result = result_to_return();
        lost = lost || result == VK_ERROR_DEVICE_LOST;
        return result;
    }
    const bool needs_the_device = function == QueueSubmit || function == WaitForFences || function == QueueWaitIdle ||
                                  function == DeviceWaitIdle || function == GetQueryPoolResults;
    return lost && needs_the_device ? VK_ERROR_DEVICE_LOST : VK_SUCCESS;
}

// The function of the layer below for a function of this type, and what stands in for it.
template <Function function, class Pointer>
struct Call;

template <Function function, class... Arguments>
struct Call<function, VkResult(VKAPI_PTR*)(Arguments...)> {
    static VKAPI_ATTR VkResult VKAPI_CALL make(Arguments... arguments) {
        const auto next = reinterpret_cast<VkResult(VKAPI_PTR*)(Arguments...)>(next_functions[function].load());
        const VkResult result = fault(function);
        if (result == VK_SUCCESS) {
            return next(arguments...);
        }
        if (function == WaitForFences) {
            next(arguments...); // a device that is lost works no longer on what is about to be destroyed
        }
        return result;
    }
};

VKAPI_ATTR VkResult VKAPI_CALL create_instance(const VkInstanceCreateInfo* info, const VkAllocationCallbacks* allocator,
                                               VkInstance* instance) {
    auto* link = static_cast<VkLayerInstanceCreateInfo*>(const_cast<void*>(info->pNext));
    while (link->sType != VK_STRUCTURE_TYPE_LOADER_INSTANCE_CREATE_INFO || link->function != VK_LAYER_LINK_INFO) {
        link = static_cast<VkLayerInstanceCreateInfo*>(const_cast<void*>(link->pNext));
    }
    const auto next = link->u.pLayerInfo->pfnNextGetInstanceProcAddr;
    link->u.pLayerInfo = link->u.pLayerInfo->pNext;
    if (const VkResult result = fault(CreateInstance); result != VK_SUCCESS) {
        return result;
    }
    const auto create = reinterpret_cast<PFN_vkCreateInstance>(next(VK_NULL_HANDLE, "vkCreateInstance"));
    const VkResult result = create(info, allocator, instance);
    if (result == VK_SUCCESS) {
        next_instance_function = next;
#define LOOK_UP(name) next_functions[name] = next(*instance, "vk" #name);
        INSTANCE_FUNCTIONS(LOOK_UP)
#undef LOOK_UP
    }
    return result;
}

VKAPI_ATTR VkResult VKAPI_CALL create_device(VkPhysicalDevice physical, const VkDeviceCreateInfo* info,
                                             const VkAllocationCallbacks* allocator, VkDevice* device) {
    auto* link = static_cast<VkLayerDeviceCreateInfo*>(const_cast<void*>(info->pNext));
    while (link->sType != VK_STRUCTURE_TYPE_LOADER_DEVICE_CREATE_INFO || link->function != VK_LAYER_LINK_INFO) {
        link = static_cast<VkLayerDeviceCreateInfo*>(const_cast<void*>(link->pNext));
    }
    next_device_function = link->u.pLayerInfo->pfnNextGetDeviceProcAddr;
    link->u.pLayerInfo = link->u.pLayerInfo->pNext;
    const VkResult result = Call<CreateDevice, PFN_vkCreateDevice>::make(physical, info, allocator, device);
    if (result == VK_SUCCESS) {
        lost = false; // a device that is opened again works
#define LOOK_UP(name) next_functions[name] = next_device_function.load()(*device, "vk" #name);
        DEVICE_FUNCTIONS(LOOK_UP)
#undef LOOK_UP
    }
    return result;
}

VKAPI_ATTR PFN_vkVoidFunction VKAPI_CALL instance_function(VkInstance instance, const char* name);
VKAPI_ATTR PFN_vkVoidFunction VKAPI_CALL device_function(VkDevice device, const char* name);

template <class Pointer>
PFN_vkVoidFunction general(Pointer function) {
    return reinterpret_cast<PFN_vkVoidFunction>(function);
}

// The function that stands in for one of Vulkan's; null where none does.
PFN_vkVoidFunction stand_in(std::string_view name) {
    if (name == "vkGetInstanceProcAddr") {
        return general(instance_function);
    }
    if (name == "vkGetDeviceProcAddr") {
        return general(device_function);
    }
    if (name == "vkCreateInstance") {
        return general(create_instance);
    }
    if (name == "vkCreateDevice") {
        return general(create_device);
    }
#define STAND_IN(function)                                                                                             \
    if (name == "vk" #function) {                                                                                      \
        return general(Call<function, PFN_vk##function>::make);                                                        \
    }
    DEVICE_FUNCTIONS(STAND_IN)
    INSTANCE_FUNCTIONS(STAND_IN)
#undef STAND_IN
    return nullptr;
}

VKAPI_ATTR PFN_vkVoidFunction VKAPI_CALL instance_function(VkInstance instance, const char* name) {
    if (const auto function = stand_in(name)) {
        return function;
    }
    const auto next = next_instance_function.load();
    return next != nullptr ? next(instance, name) : nullptr;
}

// Functions of an extension that the device does not have stay unknown.
VKAPI_ATTR PFN_vkVoidFunction VKAPI_CALL device_function(VkDevice device, const char* name) {
    const auto below = next_device_function.load()(device, name);
    const auto function = below != nullptr ? stand_in(name) : nullptr;
    return function != nullptr ? function : below;
}

} // namespace

extern "C" VKAPI_ATTR VkResult VKAPI_CALL vkNegotiateLoaderLayerInterfaceVersion(VkNegotiateLayerInterface* interface) {
    interface->loaderLayerInterfaceVersion = 2;
    interface->pfnGetInstanceProcAddr = instance_function;
    interface->pfnGetDeviceProcAddr = device_function;
    interface->pfnGetPhysicalDeviceProcAddr = nullptr;
    return VK_SUCCESS;
}
