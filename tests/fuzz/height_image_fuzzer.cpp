// Any bytes are a height map or an InputError, as TIFF or OpenEXR, with and without a scale given.
#include "core/error.hpp"
#include "surface/surface_file.hpp"

#include <unistd.h>

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <fstream>
#include <string>

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
    using namespace vkfv;
    static const auto file =
        std::filesystem::temp_directory_path() / ("vkfv_height_image_fuzzer_" + std::to_string(::getpid()));
    std::ofstream(file, std::ios::binary)
        .write(reinterpret_cast<const char*>(data), static_cast<std::streamsize>(size));
    for (const surface::ImageScale& scale : {surface::ImageScale{}, surface::ImageScale{1e-3, 1e-3}}) {
        try {
            (void)surface::read_surface(file, scale);
        } catch (const InputError&) {
        }
    }
    std::filesystem::remove(file);
    return 0;
}
