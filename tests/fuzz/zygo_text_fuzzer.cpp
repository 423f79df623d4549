// Any bytes are a surface or an InputError.
#include "core/messages/error.hpp"
#include "surface_files/instruments.hpp"

#include <cstddef>
#include <cstdint>

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
    using namespace vkfv;
    for (const surface::ImageScale& scale : {surface::ImageScale{}, {.pitch = 0.001, .unit = 0.001}}) {
        try {
            (void)surface::parse_zygo_text({reinterpret_cast<const char*>(data), size}, "fuzzed", scale);
        } catch (const InputError&) {
        }
    }
    return 0;
}
