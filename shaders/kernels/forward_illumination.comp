#version 460
#extension GL_GOOGLE_include_directive : require
// First half of the forward trace: source, illumination, specimen, gate. Light that passes is appended to the
// survivors. The layout stands before the includes, which ask for gl_WorkGroupSize: glslang takes it as 1 when it is
// declared later.
layout(local_size_x = 128) in;

#include "device/kernel.glsl"
#include "device/emission_cell.glsl"
#include "device/tally.glsl"
#include "device/survivors.glsl"

// Stage after which paths end; if one ends early, nothing is appended.
layout(constant_id = CONSTANT_STOP_AFTER) const uint stop_after = STOP_NOWHERE;

// Survivors are gathered in shared memory and appended a workgroup at a time: one counter in the buffer would be the
// busiest place of the trace. Survivors that do not fit are appended singly.
const uint KEPT_CAPACITY = 192u;
shared Survivor kept[KEPT_CAPACITY];
shared uint kept_count;
shared uint kept_first;

void keep_survivor(Survivor survivor) {
    uint place = atomicAdd(kept_count, 1u);
    if (place < KEPT_CAPACITY) {
        kept[place] = survivor;
    } else {
        survivors[atomicAdd(survivor_count, 1u)] = survivor;
    }
}

void append_kept() {
    barrier();
    uint count = min(kept_count, KEPT_CAPACITY);
    if (gl_LocalInvocationIndex == 0u && count > 0u) {
        kept_first = atomicAdd(survivor_count, count);
    }
    barrier();
    for (uint place = gl_LocalInvocationIndex; place < count; place += gl_WorkGroupSize.x) {
        survivors[kept_first + place] = kept[place];
    }
}

layout(push_constant, scalar) uniform Push { Batch batch; };

void main() {
    if (gl_LocalInvocationIndex == 0u) {
        kept_count = 0u;
    }
    tally_clear(); // contains a barrier
    // A workgroup takes consecutive paths, whose light is close together.
    uint stride = gl_NumWorkGroups.x * gl_WorkGroupSize.x;
    uint rounds = (batch.count + stride - 1u) / stride;
    for (uint round = 0u; round < rounds; ++round) {
        uint index = (gl_WorkGroupID.x * rounds + round) * gl_WorkGroupSize.x + gl_LocalInvocationIndex;
        bool survives = false;
        Departure departure;
        if (index < batch.count) {
            uint carry;
            uint low = uaddCarry(batch.first_path.x, index, carry);
            uvec2 path = uvec2(low, batch.first_path.y + carry);
            if (stop_after == STOP_AFTER_SOURCE) {
                Emission emission = emit_path(known_instrument(), exposure, path);
                departure.fate = make_fate(PATH_ALIVE, -1);
                // This is never true; it keeps the compiler from dropping the timed code.
                survives = emission.ray.position.x + emission.ray.position.y + emission.ray.direction.x +
                               emission.ray.direction.y + emission.ray.direction.z >
                           real(1e30);
            } else if (stop_after == STOP_AFTER_TRAIN) {
                Arrival arrival = illuminate(known_instrument(), known_specimen(), exposure,
                                             emit_path(known_instrument(), exposure, path));
                departure.fate = arrival.fate;
                departure.survives = false;
                // This is never true; it keeps the compiler from dropping the timed code.
                survives = arrival.position.x + arrival.position.y + arrival.direction.z > real(1e30);
            } else {
                departure = trace_to_departure(known_instrument(), known_specimen(), exposure, path);
                survives = departure.survives;
                if (stop_after == STOP_AFTER_SPECIMEN) {
                    survives = departure.survivor.position.z + departure.survivor.direction_x +
                                   departure.survivor.direction_y >
                               real(1e30);
                }
            }
            if (departure.fate.status != PATH_ALIVE) {
                tally_fate(departure.fate, WEIGHT_ONE);
            }
            if (weighted) {
                uint own = departure.fate.status != PATH_ALIVE ? WEIGHT_ONE : 0u;
                tally_sum(ledger_slots, weight_square(own + (survives ? survivor_weight(departure.survivor) : 0u)));
            }
        }
        if (survives) {
            keep_survivor(departure.survivor);
        }
    }
    append_kept();
    tally_flush();
}
