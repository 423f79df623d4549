#include "trace/structures/triangle_pairs.hpp"

#include "core/threads/parallel_list.hpp"

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <limits>

namespace vkfv::trace {

namespace {

constexpr std::uint32_t no_triangle = std::numeric_limits<std::uint32_t>::max();

// The triangles at each vertex, one list after the other.
struct Fans {
    std::vector<std::uint32_t> first; // place of each vertex's first triangle, and the end
    std::vector<std::uint32_t> triangles;
};

Fans fans_of(std::size_t vertices, std::span<const glm::uvec3> triangles) {
    Fans fans;
    fans.first.assign(vertices + 1, 0);
    for (const glm::uvec3& triangle : triangles) {
        for (int corner = 0; corner < 3; ++corner) {
            ++fans.first[triangle[corner]];
        }
    }
    std::uint32_t end = 0;
    for (std::uint32_t& first : fans.first) {
        end += first;
        first = end; // filled from the end of each list
    }
    fans.triangles.resize(3 * triangles.size());
    for (std::size_t index = triangles.size(); index-- > 0;) {
        for (int corner = 0; corner < 3; ++corner) {
            fans.triangles[--fans.first[triangles[index][corner]]] = static_cast<std::uint32_t>(index);
        }
    }
    return fans;
}

// Half the surface area of the box around a pair.
float area(const TrianglePair& pair) {
    const vulkan::Box box = pair.box();
    const glm::vec3 size = box.maximum - box.minimum;
    return size.x * size.y + size.y * size.z + size.z * size.x;
}

} // namespace

vulkan::Box TrianglePair::box() const {
    vulkan::Box box{corners[0], corners[0]};
    for (const glm::vec3& corner : corners) {
        box.minimum = glm::min(box.minimum, corner);
        box.maximum = glm::max(box.maximum, corner);
    }
    return box;
}

namespace {

// Pairs the triangles from `begin` up to `end` with each other.
std::vector<TrianglePair> pair_between(std::span<const glm::vec3> vertices, std::span<const glm::uvec3> triangles,
                                       const Fans& fans, std::size_t begin, std::size_t end) {
    std::vector<bool> taken(end - begin, false);
    std::vector<TrianglePair> pairs;
    pairs.reserve((end - begin) / 2 + 1);
    for (std::size_t index = begin; index < end; ++index) {
        if (taken[index - begin]) {
            continue;
        }
        const glm::uvec3& own = triangles[index];
        TrianglePair best{{vertices[own.x], vertices[own.y], vertices[own.z], vertices[own.x]}};
        float least = std::numeric_limits<float>::infinity();
        std::uint32_t partner = no_triangle;
        for (int side = 0; side < 3; ++side) {
            const std::uint32_t a = own[side]; // side opposite to b
            const std::uint32_t b = own[(side + 1) % 3];
            const std::uint32_t c = own[(side + 2) % 3];
            for (std::uint32_t k = fans.first[a]; k < fans.first[a + 1] && a != c; ++k) {
                const std::uint32_t candidate = fans.triangles[k];
                const glm::uvec3& other = triangles[candidate];
                const bool shares = other.x == c || other.y == c || other.z == c;
                if (candidate <= index || candidate >= end || taken[candidate - begin] || !shares) {
                    continue;
                }
                const int third = other.x != a && other.x != c ? 0 : other.y != a && other.y != c ? 1 : 2;
                const TrianglePair pair{{vertices[a], vertices[b], vertices[c], vertices[other[third]]}};
                if (area(pair) < least) {
                    least = area(pair);
                    best = pair;
                    partner = candidate;
                }
            }
        }
        if (partner != no_triangle) {
            taken[partner - begin] = true;
        }
        pairs.push_back(best);
    }
    return pairs;
}

} // namespace

std::vector<TrianglePair> pair_triangles(std::span<const glm::vec3> vertices, std::span<const glm::uvec3> triangles) {
    // The number of triangles that a thread takes at a time; they find no partner beyond.
    constexpr std::size_t triangles_a_part = std::size_t{1} << 16;
    const Fans fans = fans_of(vertices.size(), triangles);
    const auto parts =
        parallel_list(static_cast<int>((triangles.size() + triangles_a_part - 1) / triangles_a_part), [&](int part) {
            const std::size_t begin = triangles_a_part * static_cast<std::size_t>(part);
            return pair_between(vertices, triangles, fans, begin, std::min(triangles.size(), begin + triangles_a_part));
        });
    std::vector<TrianglePair> pairs;
    pairs.reserve(triangles.size() / 2 + parts.size());
    for (const auto& part : parts) {
        pairs.insert(pairs.end(), part.begin(), part.end());
    }
    return pairs;
}

} // namespace vkfv::trace
