// Traversal of a tree of boxes that knows nothing of the primitives in them: it hands out candidates one by one, as a
// ray query does. Boxes are widened by the walk's margin, so that rounding here loses none.
//
//     BvhWalk walk = bvh_walk(root, origin, direction, start, margin);
//     while (bvh_proceed(walk, farthest)) {
//         ... walk.primitive; what it meets nearer than `farthest` may shorten `farthest`
//     }
//
// bvh_another() hands out further primitives of the same node. Only one walk can be under way, as all share the stack.

const int BVH_STACK =
    32; // hierarchy_depth of src/trace/structures/bounding_volume_hierarchy.hpp: a level leaves one entry

// Nodes of type HierarchyNode (bounding_volume_hierarchy.hpp), five uvec4 each.
layout(set = 0, binding = BINDING_STRUCTURE, scalar) readonly buffer Nodes { uvec4 bvh_nodes[]; };

struct BvhWalk {
    real3 origin;
    real3 slowness; // inverse of the direction, finite
    real3 margin;   // by axis, as a distance along the ray
    real start;
    uint forward; // bit a: the ray does not go towards - along axis a
    uvec2 nodes;  // first sibling's index; bits 24 to 31: siblings to visit, nearest highest; 0 to 7: slots of nodes
    uvec2 primitives; // index of a node's first primitive; bits 0 to 23: primitives still to be handed out
    int depth;        // entries of the stack, each as `nodes`
    uint primitive;   // the primitive handed out, in the order of the tree
};

uvec2 bvh_stack[BVH_STACK];

// Begins a walk. root: index of the tree's first node. start: nearest distance of interest, at least 0. margin: mm, by
// which boxes widen on each side; at least some ten roundings of the largest coordinate of boxes and origin.
BvhWalk bvh_walk(uint root, real3 origin, real3 direction, real start, real margin) {
    BvhWalk walk;
    walk.origin = origin;
    // A ray slower than this across an axis moves by less than the margin over any length that is traced.
    bvec3 moves = greaterThan(abs(direction), real3(1e-12, 1e-12, 1e-12));
    walk.slowness =
        real3(moves.x ? real(1.0) / direction.x : real(1e12), moves.y ? real(1.0) / direction.y : real(1e12),
              moves.z ? real(1.0) / direction.z : real(1e12));
    walk.margin = margin * abs(walk.slowness);
    walk.start = start;
    walk.forward = (walk.slowness.x > real(0.0) ? 1u : 0u) | (walk.slowness.y > real(0.0) ? 2u : 0u) |
                   (walk.slowness.z > real(0.0) ? 4u : 0u);
    walk.nodes = uvec2(root, 0x80000000u); // the root stands as the first of siblings
    walk.primitives = uvec2(0u, 0u);
    walk.depth = 0;
    walk.primitive = 0u;
    return walk;
}

real bvh_byte(uint word, int index) { return real(bitfieldExtract(word, 8 * index, 8)); }

// Tests the slots of a node: those that the ray meets before `farthest` are to be visited or handed out next.
void bvh_visit(inout BvhWalk walk, uint node, real farthest) {
    uvec4 frame = bvh_nodes[5u * node];
    uvec4 slots = bvh_nodes[5u * node + 1u];
    uvec4 corners_0 = bvh_nodes[5u * node + 2u]; // lower x, x, y, y
    uvec4 corners_1 = bvh_nodes[5u * node + 3u]; // lower z, z, upper x, x
    uvec4 corners_2 = bvh_nodes[5u * node + 4u]; // upper y, y, z, z
    // A float with the exponent's bits in its exponent field is 2^(exponent - 127).
    real3 pace =
        walk.slowness * real3(uintBitsToFloat((frame.w & 0xFFu) << 23), uintBitsToFloat((frame.w & 0xFF00u) << 15),
                              uintBitsToFloat((frame.w & 0xFF0000u) << 7));
    real3 base = (uintBitsToFloat(frame.xyz) - walk.origin) * walk.slowness;
    real3 base_enter = base - walk.margin;
    real3 base_leave = base + walk.margin;
    bvec3 forward = notEqual(uvec3(walk.forward) & uvec3(1u, 2u, 4u), uvec3(0u));
    uint met = 0u;
    int start = floatBitsToInt(walk.start);
    int stop = floatBitsToInt(farthest);
    for (int four = 0; four < 2; ++four) {
        uint slot_word = four == 0 ? slots.z : slots.w;
        uvec3 lower = four == 0 ? uvec3(corners_0.xz, corners_1.x) : uvec3(corners_0.yw, corners_1.y);
        uvec3 upper = four == 0 ? uvec3(corners_1.z, corners_2.xz) : uvec3(corners_1.w, corners_2.yw);
        uvec3 first = mix(upper, lower, forward);
        uvec3 last = mix(lower, upper, forward);
        // Four slots are tested at once. A node's bit stands higher the nearer its slot is; primitives keep their
        // order.
        uint inner = ((slot_word & (slot_word << 1)) & 0x10101010u) >> 4;
        uint places = (slot_word ^ (inner * walk.forward)) & 0x1F1F1F1Fu;
        uint held = (slot_word >> 5) & 0x07070707u;
        for (int k = 0; k < 4; ++k) {
            ivec3 enter = floatBitsToInt(
                real3(bvh_byte(first.x, k), bvh_byte(first.y, k), bvh_byte(first.z, k)) * pace + base_enter);
            ivec3 leave = floatBitsToInt(real3(bvh_byte(last.x, k), bvh_byte(last.y, k), bvh_byte(last.z, k)) * pace +
                                         base_leave);
            // The bits of floats order as integers do where one of the two is positive, as the start is; and some
            // devices take the largest of three integers at once.
            bool meets =
                max(max(max(enter.x, enter.y), enter.z), start) <= min(min(min(leave.x, leave.y), leave.z), stop);
            met |= meets ? bitfieldExtract(held, 8 * k, 8) << bitfieldExtract(places, 8 * k, 8) : 0u;
        }
    }
    walk.nodes = uvec2(slots.x, (met & 0xFF000000u) | (frame.w >> 24));
    walk.primitives = uvec2(slots.y, met & 0x00FFFFFFu);
}

// True if there is another primitive whose box the ray meets at a distance between the start and `farthest`.
bool bvh_proceed(inout BvhWalk walk, real farthest) {
    bool under_way = true;
    while (under_way && walk.primitives.y == 0u) {
        if (walk.nodes.y < 0x01000000u) {
            under_way = walk.depth > 0;
            walk.depth -= under_way ? 1 : 0;
            walk.nodes = under_way ? bvh_stack[walk.depth] : walk.nodes;
        }
        if (under_way) {
            int place = findMSB(walk.nodes.y);
            uint slot = uint(place - 24) ^ walk.forward;
            uint node = walk.nodes.x + bitCount(walk.nodes.y & ((1u << slot) - 1u));
            walk.nodes.y &= ~(1u << place);
            if (walk.nodes.y >= 0x01000000u) {
                bvh_stack[walk.depth] = walk.nodes;
                walk.depth += 1;
            }
            bvh_visit(walk, node, farthest);
        }
    }
    int next = findLSB(walk.primitives.y);
    walk.primitive = walk.primitives.x + uint(max(next, 0));
    walk.primitives.y &= walk.primitives.y - 1u; // the lowest one is done; 0 stays 0
    return under_way;
}

// True if the last primitive's node holds another primitive whose box the ray met.
bool bvh_another(inout BvhWalk walk) {
    bool another = walk.primitives.y != 0u;
    walk.primitive = walk.primitives.x + uint(max(findLSB(walk.primitives.y), 0));
    walk.primitives.y &= walk.primitives.y - 1u;
    return another;
}
