#include "vulkan/acceleration_structure.hpp"

#include "core/messages/error.hpp"
#include "vulkan/failure.hpp"
#include "vulkan/kernel.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <stdexcept>

namespace vkfv::vulkan {

namespace {

static_assert(sizeof(glm::vec3) == 3 * sizeof(float) && sizeof(glm::uvec3) == 3 * sizeof(std::uint32_t));
static_assert(sizeof(Box) == sizeof(vk::AabbPositionsKHR));

bool is_finite(const glm::vec3& v) {
    return std::isfinite(v.x) && std::isfinite(v.y) && std::isfinite(v.z);
}

void require_structures(const Device& device) {
    if (!device.builds_structures()) {
        throw DeviceError(
            fmt::format("{} offers no ray query (VK_KHR_ray_query). Choose --traversal quadtree or another "
                        "device",
                        device.report().name));
    }
}

vk::PhysicalDeviceAccelerationStructurePropertiesKHR limits_of(const Device& device) {
    return device.physical()
        .getProperties2<vk::PhysicalDeviceProperties2, vk::PhysicalDeviceAccelerationStructurePropertiesKHR>()
        .get<vk::PhysicalDeviceAccelerationStructurePropertiesKHR>();
}

// The number of primitives, checked before anything is uploaded.
std::uint32_t count_of(const Device& device, std::size_t primitives) {
    require_structures(device);
    if (primitives == 0) {
        throw std::logic_error("an acceleration structure of no primitives");
    }
    // Counts are 32 bits wide in build ranges, whatever the device allows.
    const std::uint64_t allowed =
        std::min<std::uint64_t>(limits_of(device).maxPrimitiveCount, std::numeric_limits<std::uint32_t>::max());
    if (primitives > allowed) {
        throw DeviceError(
            fmt::format("{} primitives are more than the {} that {} puts into one acceleration structure. "
                        "Use a coarser mesh, --traversal quadtree or another device",
                        primitives, allowed, device.report().name));
    }
    return static_cast<std::uint32_t>(primitives);
}

template <class Value>
Buffer upload(const Device& device, std::span<const Value> values) {
    Buffer buffer(device, values.size_bytes());
    buffer.write_values(values);
    return buffer;
}

vk::raii::AccelerationStructureKHR build(const Device& device, std::vector<Buffer>& storage,
                                         vk::AccelerationStructureTypeKHR type,
                                         const vk::AccelerationStructureGeometryKHR& geometry,
                                         std::uint32_t primitives) {
    vk::AccelerationStructureBuildGeometryInfoKHR info;
    info.setType(type)
        .setFlags(vk::BuildAccelerationStructureFlagBitsKHR::ePreferFastTrace)
        .setMode(vk::BuildAccelerationStructureModeKHR::eBuild)
        .setGeometries(geometry);
    const vk::AccelerationStructureBuildSizesInfoKHR sizes = device.handle().getAccelerationStructureBuildSizesKHR(
        vk::AccelerationStructureBuildTypeKHR::eDevice, info, primitives);
    const Buffer& memory = storage.emplace_back(device, sizes.accelerationStructureSize);
    vk::raii::AccelerationStructureKHR structure(
        device.handle(),
        vk::AccelerationStructureCreateInfoKHR({}, memory.handle(), 0, sizes.accelerationStructureSize, type));

    const vk::DeviceSize alignment = limits_of(device).minAccelerationStructureScratchOffsetAlignment;
    const Buffer scratch(device, sizes.buildScratchSize + alignment);
    info.setDstAccelerationStructure(*structure)
        .setScratchData((scratch.address() + alignment - 1) / alignment * alignment);
    // The first vertex is 0, as lavapipe applies another one twice.
    const vk::AccelerationStructureBuildRangeInfoKHR range(primitives, 0, 0, 0);
    const vk::AccelerationStructureBuildRangeInfoKHR* ranges = &range;
    Commands commands(device);
    commands.handle().buildAccelerationStructuresKHR(info, ranges);
    commands.submit_and_wait();
    return structure;
}

struct Primitive {
    std::array<float, 3> centre;
    std::uint32_t index;
};

void order(std::span<Primitive> primitives) {
    while (primitives.size() > 1) {
        std::array<float, 3> minimum = primitives.front().centre;
        std::array<float, 3> maximum = minimum;
        for (const Primitive& primitive : primitives) {
            for (std::size_t axis = 0; axis < 3; ++axis) {
                minimum[axis] = std::min(minimum[axis], primitive.centre[axis]);
                maximum[axis] = std::max(maximum[axis], primitive.centre[axis]);
            }
        }
        std::size_t longest = 0;
        for (std::size_t axis = 1; axis < 3; ++axis) {
            if (maximum[axis] - minimum[axis] > maximum[longest] - minimum[longest]) {
                longest = axis;
            }
        }
        const std::size_t left = (primitives.size() + 1) / 2;
        // Ties are broken by index, so that the order does not depend on the library's nth_element.
        std::nth_element(primitives.begin(), primitives.begin() + static_cast<std::ptrdiff_t>(left), primitives.end(),
                         [longest](const Primitive& a, const Primitive& b) {
                             return a.centre[longest] != b.centre[longest] ? a.centre[longest] < b.centre[longest]
                                                                           : a.index < b.index;
                         });
        order(primitives.subspan(left));
        primitives = primitives.first(left);
    }
}

} // namespace

AccelerationStructure::AccelerationStructure(const Device& device, const vk::AccelerationStructureGeometryKHR& geometry,
                                             std::uint32_t primitives) {
    try {
        bottoms_.push_back(
            build(device, storage_, vk::AccelerationStructureTypeKHR::eBottomLevel, geometry, primitives));
        constexpr std::array<std::uint8_t, 1> visible_to_all = {0xFF};
        build_top(device, visible_to_all);
    } catch (const vk::SystemError& error) {
        if (may_pass_next_time(error)) {
            throw run_error_of(error, device.report().name);
        }
        throw DeviceError(
            fmt::format("An acceleration structure of {} primitives cannot be built on {}: {}. Use a coarser "
                        "mesh, --traversal quadtree or another device",
                        primitives, device.report().name, error.what()));
    }
}

void AccelerationStructure::build_top(const Device& device, std::span<const std::uint8_t> masks) {
    const vk::TransformMatrixKHR identity(std::array<std::array<float, 4>, 3>{
        {{1.0F, 0.0F, 0.0F, 0.0F}, {0.0F, 1.0F, 0.0F, 0.0F}, {0.0F, 0.0F, 1.0F, 0.0F}}});
    std::vector<vk::AccelerationStructureInstanceKHR> instances;
    for (std::size_t part = 0; part < bottoms_.size(); ++part) {
        instances.emplace_back(identity, static_cast<std::uint32_t>(part), masks[part], 0,
                               vk::GeometryInstanceFlagsKHR(),
                               device.handle().getAccelerationStructureAddressKHR(
                                   vk::AccelerationStructureDeviceAddressInfoKHR(*bottoms_[part])));
    }
    const Buffer buffer = upload(device, std::span<const vk::AccelerationStructureInstanceKHR>(instances));
    const vk::AccelerationStructureGeometryInstancesDataKHR data(VK_FALSE, buffer.address());
    top_ = build(device, storage_, vk::AccelerationStructureTypeKHR::eTopLevel,
                 vk::AccelerationStructureGeometryKHR(vk::GeometryTypeKHR::eInstances, data),
                 static_cast<std::uint32_t>(instances.size()));
}

AccelerationStructure AccelerationStructure::join(const Device& device, std::vector<AccelerationStructure> parts) {
    constexpr std::size_t most_parts = 8; // number of bits of a mask
    if (parts.empty() || parts.size() > most_parts) {
        throw std::logic_error("an acceleration structure joins one to eight parts");
    }
    AccelerationStructure joined;
    std::vector<std::uint8_t> masks;
    for (std::size_t part = 0; part < parts.size(); ++part) {
        for (auto& bottom : parts[part].bottoms_) {
            joined.bottoms_.push_back(std::move(bottom));
            masks.push_back(static_cast<std::uint8_t>(1u << part));
        }
        for (Buffer& buffer : parts[part].storage_) {
            joined.storage_.push_back(std::move(buffer));
        }
    }
    try {
        joined.build_top(device, masks);
    } catch (const vk::SystemError& error) {
        if (may_pass_next_time(error)) {
            throw run_error_of(error, device.report().name);
        }
        throw DeviceError(
            fmt::format("Acceleration structures cannot be joined on {}: {}. Use --traversal quadtree or another "
                        "device",
                        device.report().name, error.what()));
    }
    return joined;
}

AccelerationStructure AccelerationStructure::of_triangles(const Device& device, std::span<const glm::vec3> vertices,
                                                          std::span<const glm::uvec3> triangles) {
    const std::uint32_t count = count_of(device, triangles.size());
    if (!std::ranges::all_of(vertices, is_finite)) {
        throw std::logic_error("a vertex of an acceleration structure is not finite");
    }
    for (const glm::uvec3& triangle : triangles) {
        if (std::max({triangle.x, triangle.y, triangle.z}) >= vertices.size()) {
            throw std::logic_error("a triangle of an acceleration structure has a vertex that does not exist");
        }
    }
    const Buffer vertex_buffer = upload(device, vertices);
    const Buffer index_buffer = upload(device, triangles);
    vk::AccelerationStructureGeometryTrianglesDataKHR data;
    data.setVertexFormat(vk::Format::eR32G32B32Sfloat)
        .setVertexData(vertex_buffer.address())
        .setVertexStride(sizeof(glm::vec3))
        .setMaxVertex(static_cast<std::uint32_t>(vertices.size() - 1))
        .setIndexType(vk::IndexType::eUint32)
        .setIndexData(index_buffer.address());
    return {
        device,
        vk::AccelerationStructureGeometryKHR(vk::GeometryTypeKHR::eTriangles, data, vk::GeometryFlagBitsKHR::eOpaque),
        count};
}

AccelerationStructure AccelerationStructure::of_boxes(const Device& device, std::span<const Box> boxes) {
    const std::uint32_t count = count_of(device, boxes.size());
    float largest = 0.0F;
    for (const Box& box : boxes) {
        if (!is_finite(box.minimum) || !is_finite(box.maximum) ||
            glm::any(glm::greaterThan(box.minimum, box.maximum))) {
            throw std::logic_error("a box of an acceleration structure is not finite or is turned inside out");
        }
        for (int axis = 0; axis < 3; ++axis) {
            largest = std::max({largest, std::abs(box.minimum[axis]), std::abs(box.maximum[axis])});
        }
    }
    // The slab test subtracts the origin, multiplies by a rounded reciprocal and so errs by up to 3 rounding
    // steps of the coordinates; the padding itself is rounded once. Coordinates bound the extent to within a
    // factor 2.
    const float padding = 8.0F * std::numeric_limits<float>::epsilon() * largest;
    std::vector<Box> padded(boxes.begin(), boxes.end());
    for (Box& box : padded) {
        box.minimum -= padding;
        box.maximum += padding;
    }
    const Buffer box_buffer = upload(device, std::span<const Box>(padded));
    const vk::AccelerationStructureGeometryAabbsDataKHR data(box_buffer.address(), sizeof(Box));
    return {device, vk::AccelerationStructureGeometryKHR(vk::GeometryTypeKHR::eAabbs, data), count};
}

std::size_t AccelerationStructure::bytes() const {
    std::size_t bytes = 0;
    for (const Buffer& buffer : storage_) {
        bytes += buffer.bytes();
    }
    return bytes;
}

std::vector<std::uint32_t> median_order(std::span<const glm::vec3> centres) {
    if (!std::ranges::all_of(centres, is_finite)) {
        throw std::logic_error("a centre to be ordered is not finite");
    }
    std::vector<Primitive> primitives;
    primitives.reserve(centres.size());
    for (const glm::vec3& centre : centres) {
        primitives.push_back({{centre.x, centre.y, centre.z}, static_cast<std::uint32_t>(primitives.size())});
    }
    order(primitives);
    std::vector<std::uint32_t> indices;
    indices.reserve(primitives.size());
    for (const Primitive& primitive : primitives) {
        indices.push_back(primitive.index);
    }
    return indices;
}

} // namespace vkfv::vulkan
