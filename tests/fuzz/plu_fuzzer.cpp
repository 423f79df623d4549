// Any bytes are a surface or an InputError.
#include "core/messages/error.hpp"
#include "surface_files/instruments.hpp"

#include <cstddef>
#include <cstdint>

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
    using namespace vkfv;
    try {
        (void)surface::parse_plu({reinterpret_cast<const char*>(data), size}, "fuzzed");
    } catch (const InputError&) {
    }
    return 0;
}
