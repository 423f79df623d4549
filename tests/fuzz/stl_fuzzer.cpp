// Any bytes are a mesh, every index of which is one of a vertex, and which can be placed or is refused, or an
// InputError.
#include "core/messages/error.hpp"
#include "specimen/files.hpp"
#include "specimen/mesh_file.hpp"

#include <spdlog/spdlog.h>

#include <cstddef>
#include <cstdint>
#include <cstdlib>
#include <string_view>

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
    using namespace vkfv;
    spdlog::set_level(spdlog::level::off);
    try {
        auto mesh = specimen::parse_stl({reinterpret_cast<const char*>(data), size}, "fuzzed.stl");
        for (const auto& triangle : mesh.triangles)
            for (int corner = 0; corner < 3; ++corner)
                if (triangle[corner] >= mesh.vertices.size())
                    std::abort();
        // Centring takes seconds under the fuzzer, and mathematics alone.
        (void)specimen::placed_mesh(std::move(mesh), {.centre = false}, {});
    } catch (const InputError&) {
    }
    return 0;
}
