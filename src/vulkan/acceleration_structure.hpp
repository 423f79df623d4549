// Bottom- and top-level acceleration structures, for ray queries and for ray-tracing pipelines.
#pragma once

#include "vulkan/buffer.hpp"

#include <glm/glm.hpp>

#include <cstdint>
#include <span>
#include <vector>

namespace vkfv::vulkan {

struct Box {
    glm::vec3 minimum;
    glm::vec3 maximum;
};

// Geometries under identity instances, built for fast tracing; triangles are opaque, and their front is
// where they are seen counter-clockwise. The caller gives primitives in the order the driver likes (lavapipe
// splits by index: see median_order). Throws std::logic_error for no primitives, coordinates that are not
// finite or indices out of range, and DeviceError when the device was opened without them or cannot hold the
// structure.
class AccelerationStructure {
  public:
    static AccelerationStructure of_triangles(const Device& device, std::span<const glm::vec3> vertices,
                                              std::span<const glm::uvec3> triangles);
    // Boxes are padded by a few rounding steps of the largest coordinate: a ray lying in a face of a box
    // misses on lavapipe.
    static AccelerationStructure of_boxes(const Device& device, std::span<const Box> boxes);

    // Several under one top level: a ray query whose mask has bit k meets the k-th part (at most 8).
    static AccelerationStructure join(const Device& device, std::vector<AccelerationStructure> parts);

    vk::AccelerationStructureKHR top_level() const { return *top_; }
    std::size_t bytes() const;

  private:
    AccelerationStructure(const Device& device, const vk::AccelerationStructureGeometryKHR& geometry,
                          std::uint32_t primitives);
    AccelerationStructure() = default;
    void build_top(const Device& device, std::span<const std::uint8_t> masks);

    std::vector<Buffer> storage_;
    std::vector<vk::raii::AccelerationStructureKHR> bottoms_;
    vk::raii::AccelerationStructureKHR top_{nullptr};
};

// The order that recursive median splits along the longest axis give (left half = ceil(n/2)): result[k] is
// the index of the primitive that stands k-th. lavapipe builds its tree by index, and is thousands of times
// slower without. Throws std::logic_error for centres that are not finite.
std::vector<std::uint32_t> median_order(std::span<const glm::vec3> centres);

} // namespace vkfv::vulkan
