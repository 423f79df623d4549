#version 460
#extension GL_GOOGLE_include_directive : require
// Records how and where every path of a batch ended. Tests compare this with the host's reference.
#include "device/kernel.glsl"
#ifndef VKFV_NONSEQUENTIAL
#include "device/emission_cell.glsl"
#endif

layout(local_size_x = 64) in;

layout(set = 0, binding = BINDING_FOUND, scalar) writeonly buffer PathEnds { PathEnd path_ends[]; };

#ifdef VKFV_NONSEQUENTIAL
Batch paths() { return batch.paths; }
#else
layout(push_constant, scalar) uniform Push { Batch batch; };
Batch paths() { return batch; }
#endif

void main() {
    uint index = gl_GlobalInvocationID.x;
    if (index < paths().count) {
        uint carry;
        uint low = uaddCarry(paths().first_path.x, index, carry);
        uvec2 path = uvec2(low, paths().first_path.y + carry);
        PathEnd end;
#ifdef VKFV_NONSEQUENTIAL
        Detection detection = trace_nonsequential(instrument, specimen, exposure, batch.source_frame, path);
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
        if (departure.survives) {
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
