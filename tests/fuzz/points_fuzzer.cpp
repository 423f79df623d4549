// Any bytes are points, and triangles between them with corners that there are, or an InputError.
#include "core/messages/error.hpp"
#include "specimen/delaunay.hpp"
#include "specimen/files.hpp"

#include <cstddef>
#include <cstdint>
#include <cstdlib>
#include <string_view>

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
    using namespace vkfv;
    try {
        const auto points = specimen::parse_points({reinterpret_cast<const char*>(data), size}, "fuzzed.csv").points;
        const std::vector<glm::dvec2> plane(points.begin(), points.end());
        for (const glm::uvec3& triangle : specimen::delaunay(plane).triangles)
            for (int corner = 0; corner < 3; ++corner)
                if (triangle[corner] >= points.size())
                    std::abort();
    } catch (const InputError&) {
    }
    return 0;
}
