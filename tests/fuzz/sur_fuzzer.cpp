#include "surface_files/sur.hpp"

#include "surface_fuzzing.hpp"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
    using namespace vkfv;
    return fuzzing::read_write_read(data, size, surface::parse_sur, surface::sur_bytes);
}
