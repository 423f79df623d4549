// What the address sanitizer is to find while the driver has a heap of its own: see CMakeLists.txt.
#include "vulkan/device.hpp"

#include <dlfcn.h>

#include <cstddef>
#include <cstdio>
#include <memory>
#include <string>

int main(int argc, char** argv) {
    const std::string fault = argc > 1 ? argv[1] : "";
    const auto* device = std::make_unique<const vkfv::vulkan::Device>().release();
    auto* const bytes = reinterpret_cast<std::size_t (*)()>(dlsym(RTLD_DEFAULT, "vkfv_driver_heap_bytes"));
    std::printf("the driver has %s\n", bytes != nullptr && bytes() > 1000000 ? "a heap of its own" : "no heap");
    auto* text = new std::string(1000, 'x');
    if (fault == "use-after-free") {
        delete text;
        std::puts(text->c_str());
    } else if (fault == "leak") {
        text = nullptr;
    } else if (fault == "overflow") {
        const std::unique_ptr<std::string> owner(text);
        char* const end = owner->data() + owner->capacity() + 1;
        *const_cast<volatile char*>(end) = 'x';
    } else {
        delete text;
    }
    delete device;
    return 0;
}
