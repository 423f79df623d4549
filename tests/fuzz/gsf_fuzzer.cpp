#include "surface_files/gsf.hpp"

#include "surface_fuzzing.hpp"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
    using namespace vkfv;
    return fuzzing::read_write_read(data, size, surface::parse_gsf, [](const auto& map, const auto& provenance) {
        return surface::gsf_bytes(map, provenance);
    });
}
