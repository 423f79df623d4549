#version 460
#extension GL_GOOGLE_include_directive : require
// Makes rays on the device and counts their meetings with the specimen, for bench/hit_times.hpp to time.
layout(local_size_x = 128) in;

#include "device/kernel.glsl"

layout(constant_id = CONSTANT_HITS_WAY) const uint way = HITS_ARRIVE;

layout(set = 0, binding = BINDING_FOUND, scalar) buffer Count { uint64_t met; };
layout(set = 0, binding = BINDING_GIVEN, scalar) buffer Starts { TimedStart starts[]; };

layout(push_constant, scalar) uniform Push { TimedHits timed; };

uint even_bits(uint word) {
    uint bits = word & 0x55555555u;
    bits = (bits | (bits >> 1)) & 0x33333333u;
    bits = (bits | (bits >> 2)) & 0x0F0F0F0Fu;
    bits = (bits | (bits >> 4)) & 0x00FF00FFu;
    return (bits | (bits >> 8)) & 0x0000FFFFu;
}

shared uint group_met;

void main() {
    if (gl_LocalInvocationIndex == 0u) {
        group_met = 0u;
    }
    barrier();
    uint stride = gl_NumWorkGroups.x * gl_WorkGroupSize.x;
    uint own = 0u;
    for (uint index = gl_GlobalInvocationID.x; index < timed.count; index += stride) {
        Draws draws = draw(timed.seed, 0u, uvec2(index, 0u), way);
        real3 origin;
        real3 direction;
        real angle = real(6.283185307179586) * draws.u1;
        if (way == HITS_LEAVE) {
            TimedStart start = starts[index % uint(starts.length())];
            real z = real(2.0) * draws.u0 - real(1.0);
            real across = sqrt(real(1.0) - z * z);
            // The sphere is scaled to 0.999, so that no sum of normal and point is zero.
            direction = normalize(start.normal + real(0.999) * real3(across * cos(angle), across * sin(angle), z));
            origin = start.position;
        } else {
            real sine = timed.aperture * sqrt(draws.u0);
            direction = real3(sine * cos(angle), sine * sin(angle), -sqrt(real(1.0) - sine * sine));
            // A subgroup takes the 32 rays of a stratum.
            uint stratum = index >> 5;
            uint mask = (1u << timed.strata_bits) - 1u;
            real side = real(1u << timed.strata_bits);
            real u = (real(even_bits(stratum) & mask) + draws.u2) / side;
            real v = (real(even_bits(stratum >> 1) & mask) + draws.u3) / side;
            origin = real3(specimen.x_min + u * (specimen.x_max - specimen.x_min),
                           specimen.y_min + v * (specimen.y_max - specimen.y_min), specimen.top);
        }
        Hit hit = specimen_hit(origin, direction);
        if (way == HITS_RECORD) {
            // The start of a ray that met nothing is above everything.
            starts[index].position = hit.found == 1u ? scatter_origin(hit) : origin;
            starts[index].normal = hit.found == 1u ? hit.normal : real3(real(0.0), real(0.0), real(1.0));
        }
        // This is never true; it keeps the compiler from dropping the position and normal that a path would use.
        bool used = hit.position.x + hit.position.y + hit.position.z + hit.normal.x + hit.normal.y > real(1e30);
        own += hit.found + (used ? 1u : 0u);
    }
    atomicAdd(group_met, own);
    barrier();
    if (gl_LocalInvocationIndex == 0u) {
        atomicAdd(met, uint64_t(group_met));
    }
}
