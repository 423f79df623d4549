#include "surface_files/npy.hpp"

#include "surface_fuzzing.hpp"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
    using namespace vkfv;
    return fuzzing::read_write_read(
        data, size,
        [](std::string_view bytes, const std::filesystem::path& file) {
            return surface::parse_npy(bytes, file, {.pitch = 1e-3, .unit = 1e-3});
        },
        [](const auto& map, const auto&) { return surface::npy_bytes(map); });
}
