// Any bytes are a mesh, every index of which is one of a vertex, or an InputError.
#include "core/messages/error.hpp"
#include "specimen/files.hpp"

#include <spdlog/spdlog.h>

#include <cstddef>
#include <cstdint>
#include <cstdlib>
#include <string>

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
    using namespace vkfv;
    spdlog::set_level(spdlog::level::off);
    try {
        const auto mesh = specimen::parse_gltf({reinterpret_cast<const char*>(data), size}, "fuzzed.gltf");
        for (const auto& triangle : mesh.triangles)
            for (int corner = 0; corner < 3; ++corner)
                if (triangle[corner] >= mesh.vertices.size())
                    std::abort();
    } catch (const InputError&) {
    }
    return 0;
}
