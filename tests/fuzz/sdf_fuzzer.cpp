#include "surface_files/sdf.hpp"

#include "surface_fuzzing.hpp"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
    using namespace vkfv;
    fuzzing::read_write_read(data, size, surface::parse_sdf, surface::sdf_text);
    return fuzzing::read_write_read(data, size, surface::parse_sdf, surface::sdf_bytes);
}
