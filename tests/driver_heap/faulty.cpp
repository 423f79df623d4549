// The address sanitizer must find these faults while the driver has a heap of its own: see CMakeLists.txt.
#include "vulkan/device.hpp"

#include <dlfcn.h>

#include <cstddef>
#include <cstdio>
#include <string>

namespace {

constexpr std::size_t length = 1000;

void use_after_free() {
    const char* left = nullptr;
    {
        const std::string text(length, 'x');
        left = text.c_str();
    }
    std::puts(left); // NOLINT(clang-analyzer-cplusplus.InnerPointer): the fault
}

void overflow() {
    std::string text(length, 'x');
    volatile char* last = text.data() + text.capacity();
    last[1] = 'x';
}

std::string* volatile lost = nullptr; // so that no compiler leaves the allocation out

void leak() {
    lost = new std::string(length, 'x');
    lost = nullptr;
}

} // namespace

int main(int argc, char** argv) {
    const std::string fault = argc > 1 ? argv[1] : "none";
    const vkfv::vulkan::Device device;
    auto* const bytes = reinterpret_cast<std::size_t (*)()>(dlsym(RTLD_DEFAULT, "vkfv_driver_heap_bytes"));
    std::printf("the driver has %s\n", bytes != nullptr && bytes() > 1000000 ? "a heap of its own" : "no heap");
    if (fault == "use-after-free") {
        use_after_free();
    }
    if (fault == "overflow") {
        overflow();
    }
    if (fault == "leak") {
        leak();
    }
    return 0;
}
