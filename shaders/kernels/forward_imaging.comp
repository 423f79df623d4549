#version 460
#extension GL_GOOGLE_include_directive : require
// Second half of the forward trace: occlusion of the survivors by the specimen, the imaging train, the detector. The
// layout stands before the includes, which ask for gl_WorkGroupSize: glslang takes it as 1 when it is declared later.
layout(local_size_x = 128) in;

#include "device/kernel.glsl"
#include "device/tally.glsl"
#include "device/survivors.glsl"
#include "device/cell_light.glsl"

layout(set = 0, binding = BINDING_PIXELS, scalar) buffer Pixels { uint64_t pixels[]; };

layout(constant_id = CONSTANT_STOP_AFTER) const uint stop_after = STOP_NOWHERE;

void main() {
    tally_clear();
    uint stride = gl_NumWorkGroups.x * gl_WorkGroupSize.x;
    for (uint index = gl_GlobalInvocationID.x; index < survivor_count; index += stride) {
        Detection detection;
        if (stop_after == STOP_AFTER_SPECIMEN) {
            detection.fate =
                make_fate(survivor_occluded(exposure, survivors[index]) ? PATH_BOUNCE_LIMIT : PATH_OFF_DETECTOR, -1);
        } else {
            detection = image_survivor(known_instrument(), known_specimen(), exposure, survivors[index]);
        }
        bool counted =
            detection.fate.status == PATH_DETECTED && (stop_after == STOP_NOWHERE || detection.x > real(1e30));
        int pixel = detection.row * instrument.detector_columns + detection.column;
        uint weight = survivor_weight(survivors[index]);
        if (counted && weighted) {
            // The sum of squares follows the sum, in units of 2^-24: both hold 1e11 rays of weight 1 on one pixel.
            atomicAdd(pixels[2 * pixel], uint64_t(weight));
            atomicAdd(pixels[2 * pixel + 1], (uint64_t(weight) * uint64_t(weight)) >> 20);
        } else if (counted) {
            atomicAdd(pixels[pixel], uint64_t(1));
        }
        if (counted && sorts_light) {
            add_cell_light(cell_address(detection_place(instrument, pupil_cells, detection)),
                           weighted ? uint64_t(weight) : uint64_t(1));
        }
        if (weighted && detection.fate.status == PATH_ALIVE) {
            // The first half counted this light in the path's square; it is taken off here.
            uint own = weight_beside(survivors[index]);
            atomicAdd(ledger_counts[2u * ledger_slots],
                      uint64_t(weight_square(own)) - uint64_t(weight_square(own + weight)));
        } else {
            tally_fate(detection.fate, weight);
        }
        VKFV_LEAVE_IF(index + stride >= survivor_count);
    }
    tally_flush();
}
