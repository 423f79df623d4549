#include "vulkan/loader.hpp"

#include "core/messages/error.hpp"
#include "vulkan/device.hpp"
#include "vulkan/loader_version.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <array>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <mutex>
#include <string_view>

#ifdef VKFV_VALIDATION
#include <dlfcn.h>
#endif

namespace vkfv::vulkan {

std::string driver_selection() {
    std::vector<std::string> set;
    for (const char* variable :
         {"VK_DRIVER_FILES", "VK_ICD_FILENAMES", "VK_LOADER_DRIVERS_SELECT", "VK_LOADER_DRIVERS_DISABLE"}) {
        if (const char* value = std::getenv(variable)) {
            set.push_back(fmt::format("{}={}", variable, value));
        }
    }
    return set.empty() ? "" : fmt::format(" The environment restricts the drivers: {}.", fmt::join(set, ", "));
}

namespace {

[[noreturn]] void throw_no_driver(std::string_view cause) {
    const std::string selection = driver_selection();
    throw DeviceError(
        fmt::format("No Vulkan driver can be used ({}).{} {} the driver of the graphics card, or the package "
                    "mesa-vulkan-drivers, which also holds a driver for the CPU (lavapipe)",
                    cause, selection, selection.empty() ? "Install" : "Unset what names no driver, or install"));
}

vk::raii::Context make_context() {
    try {
        return vk::raii::Context();
    } catch (const std::runtime_error& error) {
        throw DeviceError(
            fmt::format("The Vulkan loader cannot be used ({}). Install the package libvulkan1", error.what()));
    }
}

#ifdef VKFV_VALIDATION

constexpr const char* validation_layer = "VK_LAYER_KHRONOS_validation";

VKAPI_ATTR VkBool32 VKAPI_CALL on_validation_message(VkDebugUtilsMessageSeverityFlagBitsEXT,
                                                     VkDebugUtilsMessageTypeFlagsEXT,
                                                     const VkDebugUtilsMessengerCallbackDataEXT* data, void*) {
    // An exception must not pass through the frames above, which are the layer's, in C.
    std::fprintf(stderr, "Vulkan validation: %s\n", data->pMessage);
    std::abort();
}

// Messages of the loader ("general") are not reported: a broken driver beside a good one causes some.
vk::DebugUtilsMessengerCreateInfoEXT messenger_info() {
    VkDebugUtilsMessengerCreateInfoEXT info{};
    info.sType = VK_STRUCTURE_TYPE_DEBUG_UTILS_MESSENGER_CREATE_INFO_EXT;
    info.messageSeverity =
        VK_DEBUG_UTILS_MESSAGE_SEVERITY_WARNING_BIT_EXT | VK_DEBUG_UTILS_MESSAGE_SEVERITY_ERROR_BIT_EXT;
    info.messageType = VK_DEBUG_UTILS_MESSAGE_TYPE_VALIDATION_BIT_EXT | VK_DEBUG_UTILS_MESSAGE_TYPE_PERFORMANCE_BIT_EXT;
    info.pfnUserCallback = on_validation_message;
    return info;
}

#endif

vk::raii::Instance make_instance(const vk::raii::Context& context) {
    const vk::ApplicationInfo application("vkfv", 0, "vkfv", 0, api_version);
    vk::InstanceCreateInfo info({}, &application);
#ifdef VKFV_VALIDATION
    const auto layers = context.enumerateInstanceLayerProperties();
    if (std::ranges::none_of(layers, [](const vk::LayerProperties& layer) {
            return std::strcmp(layer.layerName, validation_layer) == 0;
        })) {
        throw DeviceError(fmt::format("This build validates its Vulkan calls, but the layer {} is not installed. "
                                      "Install the package vulkan-validationlayers, or use the release build",
                                      validation_layer));
    }
    const std::array extensions = {VK_EXT_DEBUG_UTILS_EXTENSION_NAME, VK_EXT_VALIDATION_FEATURES_EXTENSION_NAME};
    const vk::ValidationFeatureEnableEXT enabled = vk::ValidationFeatureEnableEXT::eSynchronizationValidation;
    vk::DebugUtilsMessengerCreateInfoEXT messenger = messenger_info();
    vk::ValidationFeaturesEXT validation(enabled);
    validation.setPNext(&messenger);
    info.setPEnabledLayerNames(validation_layer);
    info.setPEnabledExtensionNames(extensions);
    info.setPNext(&validation);
#endif
    try {
        vk::raii::Instance instance(context, info);
#ifdef VKFV_VALIDATION
        // The library stays loaded: the leak sanitizer identifies leaks by library, and only while it is loaded.
        dlopen("libVkLayer_khronos_validation.so", RTLD_LAZY | RTLD_NOLOAD | RTLD_NODELETE);
#endif
        return instance;
    } catch (const vk::IncompatibleDriverError& error) {
        throw_no_driver(error.what());
    } catch (const vk::SystemError& error) {
        throw DeviceError(fmt::format("Vulkan does not start: {}.{} Check that the Vulkan loader and the drivers fit "
                                      "each other: `vulkaninfo` should run",
                                      error.what(), driver_selection()));
    }
}

std::mutex loader_mutex;
std::weak_ptr<const Loader> open_loader;
std::shared_ptr<const Loader> kept_loader; // from the first device of a DriverScope to its end
bool loader_is_kept = false;

} // namespace

#if defined(VKFV_VALIDATION) && defined(__SANITIZE_ADDRESS__)
// The layer's synchronisation validation leaks some kilobytes, and so does VkFFT where it writes kernels.
extern "C" const char* __lsan_default_suppressions() {
    return "leak:libVkLayer_khronos_validation.so\nleak:initializeVkFFT\n";
}
extern "C" const char* __lsan_default_options() {
    return "print_suppressions=0";
}
#endif

Loader::Loader()
    : context(make_context()), instance(make_instance(context))
#ifdef VKFV_VALIDATION
      ,
      messenger(instance, messenger_info())
#endif
{
}

std::shared_ptr<const Loader> open_drivers() {
    const std::lock_guard lock(loader_mutex);
    auto loader = open_loader.lock();
    if (!loader) {
        loader = std::make_shared<const Loader>();
        open_loader = loader;
    }
    if (loader_is_kept) {
        kept_loader = loader;
    }
    return loader;
}

std::optional<std::string> loader_version() {
    try {
        const auto version = make_context().enumerateInstanceVersion();
        return fmt::format("{}.{}.{}", VK_API_VERSION_MAJOR(version), VK_API_VERSION_MINOR(version),
                           VK_API_VERSION_PATCH(version));
    } catch (const DeviceError&) {
        return std::nullopt;
    }
}

std::vector<vk::raii::PhysicalDevice> physical_devices(const vk::raii::Instance& instance) {
    try {
        vk::raii::PhysicalDevices devices(instance);
        if (devices.empty()) {
            throw_no_driver("none offers a device");
        }
        return devices;
    } catch (const vk::SystemError& error) {
        throw_no_driver(error.what());
    }
}

DriverScope::DriverScope() {
    const std::lock_guard lock(loader_mutex);
    loader_is_kept = true;
}

DriverScope::~DriverScope() {
    const std::lock_guard lock(loader_mutex);
    loader_is_kept = false;
    kept_loader.reset();
}

} // namespace vkfv::vulkan
