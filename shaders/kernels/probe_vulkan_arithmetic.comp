// Tests the features that every kernel relies on: specialization and push constants, 64-bit integers and atomics,
// uniforms, device addresses, scalar layout, subgroup operations. Invocation i of `count` writes offset + base + factor
// * i.
#version 460
#extension GL_EXT_buffer_reference : require
#extension GL_EXT_scalar_block_layout : require
#extension GL_EXT_shader_atomic_int64 : require
#extension GL_EXT_shader_explicit_arithmetic_types_int64 : require
#extension GL_KHR_shader_subgroup_arithmetic : require
#extension GL_KHR_shader_subgroup_ballot : require

layout(local_size_x = 64) in;
layout(constant_id = 3) const uint factor = 1u;

layout(buffer_reference, scalar) writeonly buffer Values { uint64_t values[]; };

layout(push_constant, scalar) uniform Push {
    uint64_t base;
    Values values;
    uint count;
}
push;

layout(set = 0, binding = 0, scalar) uniform Offset { uint64_t offset; };

layout(set = 0, binding = 2, scalar) buffer Sums {
    uint64_t of_values;    // every invocation adds to it
    uint of_invocations;   // counted by ballot, a subgroup at a time
    uint of_indices;       // summed by subgroup arithmetic
    uint length_of_padded; // length of the array below, as the device sees it
};

layout(set = 0, binding = 5, scalar) readonly buffer Padded { vec3 padded[]; };

void main() {
    uint i = gl_GlobalInvocationID.x;
    if (i >= push.count) {
        return;
    }
    uint64_t value = offset + push.base + uint64_t(factor) * uint64_t(i);
    push.values.values[i] = value;
    atomicAdd(of_values, value);
    uint invocations = subgroupBallotBitCount(subgroupBallot(true));
    uint indices = subgroupAdd(i);
    if (subgroupElect()) {
        atomicAdd(of_invocations, invocations);
        atomicAdd(of_indices, indices);
    }
    if (i == 0u) {
        length_of_padded = uint(padded.length());
    }
}
