#version 460
#extension GL_GOOGLE_include_directive : require
// Every path of a batch by itself: how and where it ended. Tests compare it with the host's reference.
#include "device/kernel.glsl"

layout(local_size_x = 64) in;

struct PathEnd {
    uint status;
    int surface;
    real x; // mm, as Detection, for light that left the specimen through the gate (of meaning if it arrived), else 0
    real y;
    real weight; // of the light at x and y
};

layout(set = 0, binding = 6, scalar) writeonly buffer PathEnds { PathEnd path_ends[]; };

#ifndef VKFV_NONSEQUENTIAL
layout(push_constant, scalar) uniform Batch {
    uvec2 first_path;
    uint count;
};
#endif

void main() {
    uint index = gl_GlobalInvocationID.x;
    if (index < count) {
        uint carry;
        uint low = uaddCarry(first_path.x, index, carry);
        uvec2 path = uvec2(low, first_path.y + carry);
        PathEnd end;
#ifdef VKFV_NONSEQUENTIAL
        Detection detection = trace_nonsequential(instrument, specimen, exposure, source_frame, path);
        end.status = detection.fate.status;
        end.surface = detection.fate.surface;
        end.x = detection.x;
        end.y = detection.y;
        end.weight = real(1.0);
#else
        Departure departure = trace_to_departure(instrument, specimen, exposure, path);
        end.status = departure.fate.status;
        end.surface = departure.fate.surface;
        end.x = real(0.0);
        end.y = real(0.0);
        end.weight = real(1.0);
        if (departure.survives == 1u) {
            Detection detection = image_survivor(instrument, specimen, exposure, departure.survivor);
            end.status = detection.fate.status;
            end.surface = detection.fate.surface;
            end.x = detection.x;
            end.y = detection.y;
            if ((scene_features & FEATURE_DIRECTED_SCATTER) != 0u) {
                end.weight = real(survivor_weight(departure.survivor)) / real(WEIGHT_ONE);
            }
        }
#endif
        path_ends[index] = end;
    }
}
