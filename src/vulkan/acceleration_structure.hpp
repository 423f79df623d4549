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

// Geometries under identity instances, built for fast tracing; triangles are opaque, and their front is the side from
// which they are seen counter-clockwise. The caller gives primitives in the order that suits the driver (lavapipe
// splits by index: see median_order). Throws std::logic_error for no primitives, coordinates that are not finite or
// indices out of range, and DeviceError when the device was opened without acceleration structures or cannot hold this
// one.
class AccelerationStructure {
  public:
    static AccelerationStructure of_triangles(const Device& device, std::span<const glm::vec3> vertices,
                                              std::span<const glm::uvec3> triangles);
    // Boxes are padded by a few rounding steps of the largest coordinate: on lavapipe a ray in the face of a box misses
    // it.
    static AccelerationStructure of_boxes(const Device& device, std::span<const Box> boxes);

    // Joins several structures under one top level: a ray query whose mask has bit k meets the k-th part (at most 8
    // parts).
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

// The order of recursive median splits along the longest axis (left half = ceil(n/2)): result[k] is the index of the
// primitive in the k-th place. lavapipe builds its tree by index, and is thousands of times slower without this order.
// Throws std::logic_error for centres that are not finite.
std::vector<std::uint32_t> median_order(std::span<const glm::vec3> centres);

} // namespace vkfv::vulkan
