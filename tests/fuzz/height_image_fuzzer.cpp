// Any bytes are a height map or an InputError, as TIFF or OpenEXR, with and without a scale given.
#include "core/messages/error.hpp"
#include "surface_files/height_image.hpp"

#include <cstddef>
#include <cstdint>
#include <string_view>

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
    using namespace vkfv;
    for (const surface::ImageScale& scale : {surface::ImageScale{}, surface::ImageScale{1e-3, 1e-3}}) {
        try {
            (void)surface::parse_height_image({reinterpret_cast<const char*>(data), size}, "fuzzed", scale);
        } catch (const InputError&) {
        }
    }
    return 0;
}
