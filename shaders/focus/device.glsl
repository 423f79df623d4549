// The kernels of the evaluation include this file first. An invocation takes a pixel; workgroups stand in rows where
// one row holds too few.
#extension GL_EXT_scalar_block_layout : require
#include "physics/lang.glsl"
#include "focus/arithmetic.glsl"
#include "focus/all.glsl"
#include "focus/interface.glsl"

uint invocation() {
    return (gl_WorkGroupID.y * gl_NumWorkGroups.x + gl_WorkGroupID.x) * gl_WorkGroupSize.x + gl_LocalInvocationIndex;
}
