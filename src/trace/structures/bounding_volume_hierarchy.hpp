// A tree of boxes over any primitives that have boxes, for the traversal of shaders/device/bvh.glsl.
#pragma once

#include "vulkan/acceleration_structure.hpp"

#include <glm/glm.hpp>

#include <cstdint>
#include <span>
#include <vector>

namespace vkfv::trace {

// A node of eight slots in 80 bytes: H. Ylitie, T. Karras, S. Laine, "Efficient incoherent ray traversal on GPUs
// through compressed wide BVHs", HPG 2017. Slot s stands towards + along axis a of the node where bit a of s is set, as
// far as its other children allow, so that a ray's signs alone say which slot to visit first.
struct HierarchyNode {
    glm::vec3 origin;              // lowest corner, in the boxes' unit
    std::uint8_t exponents[3];     // a step along an axis is 2^(exponent - 127)
    std::uint8_t inner;            // bit s: slot s is a node
    std::uint32_t first_node;      // index of its first child node; the others follow in the order of their slots
    std::uint32_t first_primitive; // index of the first primitive in its slots
    std::uint8_t slots[8];         // 0: empty; a node: 32 + 24 + slot; else primitives, see hierarchy_leaf_size
    std::uint8_t lower[3][8];      // corners by axis and slot, in steps from the origin
    std::uint8_t upper[3][8];
};
static_assert(sizeof(HierarchyNode) == 80);

// Most primitives of a slot. Bits 0 to 4: the first one, counted from first_primitive; bits 5 to 7: as many ones as
// there are primitives.
constexpr std::size_t hierarchy_leaf_size = 3;

// Length of the longest path from the root: BVH_STACK of shaders/device/bvh.glsl.
constexpr int hierarchy_depth = 32;

struct BoundingVolumeHierarchy {
    std::vector<HierarchyNode> nodes; // the root is the first
    std::vector<std::uint32_t> order; // order[k]: index of the box of the tree's k-th primitive
};

// Splits by the surface-area heuristic over bins (I. Wald, "On fast construction of SAH-based bounding volume
// hierarchies", RT 2007), by medians where that would grow too deep. The same boxes give the same tree. leaf_size: most
// primitives that share a slot, 1 to hierarchy_leaf_size; 1 where a primitive costs far more than a box. Throws
// std::logic_error for no boxes and for corners that are not finite or not in order.
BoundingVolumeHierarchy build_hierarchy(std::span<const vulkan::Box> boxes, std::size_t leaf_size);

} // namespace vkfv::trace
