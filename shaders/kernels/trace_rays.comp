#version 460
#extension GL_GOOGLE_include_directive : require
// Traces given rays through one of the trains and on to a plane behind it: --trace-rays --precision float.
#include "device/bindings.glsl"

layout(local_size_x = 64) in;

layout(set = 0, binding = BINDING_GIVEN, scalar) readonly buffer Rays { Ray rays[]; }; // in the first vertex' frame
layout(set = 0, binding = BINDING_FOUND, scalar) writeonly buffer TracedRays { TracedRay traced_rays[]; };

layout(push_constant, scalar) uniform Push { TrainPassage passage; };

// Only the train is traced; the functions that the physics needs besides do nothing.
Hit specimen_hit(real3 origin, real3 direction) {
    Hit hit;
    hit.found = 0u;
    return hit;
}
real lattice_at(int column, int row) { return real(0.0); }
real material_number(int index) { return real(0.0); }
real pattern_point(Pattern pattern, int column, int row) { return real(0.0); }

void main() {
    uint index = gl_GlobalInvocationID.x;
    if (index < passage.count) {
        Light light = light_of_spectral(instrument, real(0.0));
        TrainResult train;
        if (passage.form == 0u) {
            train = trace_train(passage.first_surface, passage.surfaces, rays[index], passage.index,
                                passage.apertures != 0u, light);
        } else {
            train = trace_short_train(passage.first_surface, passage.surfaces, rays[index], passage.index, light,
                                      passage.form);
        }
        Ray arrived = fly_to_plane(train.ray, passage.plane, train.index);
        TracedRay traced;
        traced.position = arrived.position;
        traced.direction = arrived.direction;
        traced.path_length = arrived.path_length;
        traced.status = train.status;
        traced.surface = train.surface;
        traced_rays[index] = traced;
    }
}
