#include "images/codec.hpp"

#include "core/files/installation.hpp"
#include "core/messages/error.hpp"

#include <dlfcn.h>
#include <fmt/format.h>

#include <filesystem>

#ifdef __SANITIZE_ADDRESS__
// The leak sanitizer misinterprets the thread-local storage of libraries that are loaded late (g++ 12).
extern "C" __attribute__((weak)) const char* __asan_default_options(); // a test may define its own
extern "C" __attribute__((weak)) const char* __asan_default_options() {
    return "intercept_tls_get_addr=0";
}
#endif

namespace vkfv::images {

namespace {

// Loads the module from beside the program, or from the installation; else wherever the loader finds it. The path is
// explicit, since sanitizers hide the program's run path from dlopen(). The module is never unloaded.
void* open_module() {
    const std::filesystem::path name = VKFV_IMAGE_MODULE;
    const auto path = find_installed("lib/vkfv" / name);
    return dlopen(path.value_or(name).c_str(), RTLD_NOW | RTLD_LOCAL);
}

const Codec& loaded() {
    void* const module = open_module();
    const void* const found = module != nullptr ? dlsym(module, "vkfv_image_codec") : nullptr;
    if (found == nullptr) {
        throw RunError(
            fmt::format("The module that reads images of all kinds cannot be loaded: {}. Install vkfv again, or "
                        "what is missing of OpenImageIO",
                        dlerror()));
    }
    return *static_cast<const Codec*>(found);
}

} // namespace

const Codec& codec() {
    static const Codec& once = loaded();
    return once;
}

Ink ink_of(const std::string& letter, int size, const std::string& font) {
    return codec().ink_of(letter, size, font);
}

Grid<float> drawn(const DrawnLetter& letter, int columns, int rows) {
    return codec().drawn(letter, columns, rows);
}

} // namespace vkfv::images
