#version 460
#extension GL_GOOGLE_include_directive : require
// Second half of the forward trace: whether the survivors meet the specimen again, the imaging train, the detector.
// Before the includes, which ask for gl_WorkGroupSize: glslang takes it as 1 when it is declared later.
layout(local_size_x = 128) in;

#include "device/kernel.glsl"
#include "device/tally.glsl"
#include "device/survivors.glsl"

layout(set = 0, binding = 3, scalar) buffer Pixels { uint64_t pixels[]; };

// For timing alone: 0 the whole half, 1 nothing is counted on the detector, 2 only the occlusion is tested.
layout(constant_id = 2) const uint stop_after = 0u;

void main() {
    tally_clear();
    uint stride = gl_NumWorkGroups.x * gl_WorkGroupSize.x;
    for (uint index = gl_GlobalInvocationID.x; index < survivor_count; index += stride) {
        Detection detection;
        if (stop_after == 2u) {
            detection.fate = make_fate(survivor_occluded(survivors[index]) ? PATH_BOUNCE_LIMIT : PATH_OFF_DETECTOR, -1);
        } else {
            detection = image_survivor(instrument, specimen, exposure, survivors[index]);
        }
        bool counted = detection.fate.status == PATH_DETECTED &&
                       (stop_after == 0u || detection.x > real(1e30));
        if (counted) {
            atomicAdd(pixels[detection.row * instrument.detector_pixels + detection.column], uint64_t(1));
        }
        tally_fate(detection.fate);
    }
    tally_flush();
}
