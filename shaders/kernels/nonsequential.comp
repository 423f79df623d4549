#version 460
#extension GL_GOOGLE_include_directive : require
// Non-sequential paths from the source to their ends.
// The layout stands before the includes, which ask for gl_WorkGroupSize: glslang takes it as 1 when it is declared
// later.
layout(local_size_x = 128) in;

#include "device/kernel.glsl"
#include "device/tally.glsl"

layout(set = 0, binding = BINDING_PIXELS, scalar) buffer Pixels { uint64_t pixels[]; };

void main() {
    tally_clear();
    uint stride = gl_NumWorkGroups.x * gl_WorkGroupSize.x;
    for (uint index = gl_GlobalInvocationID.x; index < batch.paths.count; index += stride) {
        uint carry;
        uint low = uaddCarry(batch.paths.first_path.x, index, carry);
        Detection detection = trace_nonsequential(instrument, specimen, exposure, batch.source_frame,
                                                  uvec2(low, batch.paths.first_path.y + carry));
        if (detection.fate.status == PATH_DETECTED) {
            atomicAdd(pixels[detection.row * instrument.detector_columns + detection.column], uint64_t(1));
        }
        tally_fate(detection.fate, WEIGHT_ONE);
    }
    tally_flush();
}
