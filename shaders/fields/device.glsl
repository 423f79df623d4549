// What the kernels of fields have in common.
#extension GL_EXT_scalar_block_layout : require
#extension GL_EXT_shader_explicit_arithmetic_types_int64 : require
#extension GL_EXT_buffer_reference : require
#define real float
#define real2 vec2
#define VKFV_FUNCTION
#include "fields/interface.glsl"
#include "fields/turn.glsl"

layout(local_size_x = FIELDS_WORKGROUP) in;
layout(buffer_reference, scalar, buffer_reference_align = 4) readonly buffer Value { float value; };
layout(buffer_reference, scalar, buffer_reference_align = 4) readonly buffer Index { uint index; };
layout(buffer_reference, scalar, buffer_reference_align = 8) buffer Complex { vec2 number; };

float value_at(uint64_t address, uint64_t place) { return Value(address + uint64_t(4) * place).value; }
vec2 complex_at(uint64_t address, uint64_t place) { return Complex(address + uint64_t(8) * place).number; }

// Workgroups stand in rows where one row holds too few.
uint invocation() {
    return (gl_WorkGroupID.y * gl_NumWorkGroups.x + gl_WorkGroupID.x) * gl_WorkGroupSize.x + gl_LocalInvocationIndex;
}

vec2 product(vec2 a, vec2 b) { return vec2(a.x * b.x - a.y * b.y, a.x * b.y + a.y * b.x); }

// sin(pi t) / (pi t)
float sinc_of(float turns) {
    return abs(turns) < 1e-3 ? 1.0 - 1.644934 * turns * turns : turned(0.5 * turns).y / (3.14159265 * turns);
}
