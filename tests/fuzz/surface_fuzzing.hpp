// The checks that the fuzzers of surface files share.
#pragma once

#include "core/messages/error.hpp"
#include "surface_files/surface_file.hpp"

#include <spdlog/spdlog.h>

#include <cstdint>
#include <cstdlib>
#include <string>
#include <string_view>

namespace vkfv::fuzzing {

// Any bytes are a surface or an InputError; what is a surface is written so that it reads back and is written the same
// again.
template <class Parse, class Write>
int read_write_read(const std::uint8_t* data, std::size_t size, Parse parse, Write write) {
    spdlog::set_level(spdlog::level::off);
    std::string written;
    try {
        const surface::SurfaceFile file = parse(std::string_view(reinterpret_cast<const char*>(data), size), "fuzzed");
        written = write(file.map, file.provenance);
    } catch (const InputError&) {
        return 0;
    } catch (const RunError&) { // a map that the format cannot hold
        return 0;
    }
    const surface::SurfaceFile again = parse(written, "written");
    if (write(again.map, again.provenance) != written)
        std::abort();
    return 0;
}

} // namespace vkfv::fuzzing
