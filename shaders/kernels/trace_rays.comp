#version 460
#extension GL_GOOGLE_include_directive : require
// Given rays through one of the trains and on to a plane behind it: --trace-rays --precision float.
#extension GL_EXT_scalar_block_layout : require
#include "physics/lang.glsl"
#include "physics/all.glsl"
#include "device/bindings.glsl"

layout(local_size_x = 64) in;

struct TracedRay {
    real3 position; // on the detector's plane, z unused
    real3 direction;
    real path_length;
    uint status;
    int surface;
};

layout(set = 0, binding = 2, scalar) readonly buffer Rays { Ray rays[]; }; // in the first vertex' frame
layout(set = 0, binding = 3, scalar) writeonly buffer TracedRays { TracedRay traced_rays[]; };

layout(push_constant, scalar) uniform Batch {
    uint count;
    uint apertures;
    int first_surface;
    int surface_count;
    real index_before;
    real plane; // mm, from the last vertex
};

// The train alone is traced; the physics' other needs are met by nothing.
Hit specimen_hit(real3 origin, real3 direction) {
    Hit hit;
    hit.found = 0u;
    return hit;
}
real lattice_at(int column, int row) { return real(0.0); }

void main() {
    uint index = gl_GlobalInvocationID.x;
    if (index < count) {
        Light light = light_of_spectral(instrument, real(0.0));
        TrainResult train = trace_train(first_surface, surface_count, rays[index], index_before, apertures, light);
        Ray arrived = fly_to_plane(train.ray, plane, train.index);
        TracedRay traced;
        traced.position = arrived.position;
        traced.direction = arrived.direction;
        traced.path_length = arrived.path_length;
        traced.status = train.status;
        traced.surface = train.surface;
        traced_rays[index] = traced;
    }
}
