// Any bytes are a surface or an InputError.
#include "core/messages/error.hpp"
#include "surface_files/al3d.hpp"

#include <cstddef>
#include <cstdint>

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
    using namespace vkfv;
    try {
        (void)surface::parse_al3d({reinterpret_cast<const char*>(data), size}, "fuzzed.al3d");
    } catch (const InputError&) {
    }
    return 0;
}
