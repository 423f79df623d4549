#version 460
#extension GL_GOOGLE_include_directive : require
// Echoes every field of the shared records as a number, so that the host can compare its own layout.
#extension GL_EXT_scalar_block_layout : require
#include "physics/lang.glsl"
#include "physics/all.glsl"
#include "device/bindings.glsl"

layout(local_size_x = 1) in;

layout(set = 0, binding = 2, scalar) readonly buffer Survivors { Survivor survivors[]; };
layout(set = 0, binding = 3, scalar) writeonly buffer Echo { real echo[]; };

Hit specimen_hit(real3 origin, real3 direction) {
    Hit hit;
    hit.found = 0u;
    return hit;
}
real lattice_at(int column, int row) { return real(0.0); }

void main() {
    int k = 0;
    // The last of three, so that the array's stride is seen too.
    Surface s = surfaces[2];
    echo[k++] = s.curvature; echo[k++] = s.conic; echo[k++] = s.semi_diameter_squared; echo[k++] = s.distance;
    echo[k++] = s.index_before; echo[k++] = s.index_after; echo[k++] = s.a4; echo[k++] = s.a6;
    echo[k++] = s.a8; echo[k++] = s.a10; echo[k++] = s.a12; echo[k++] = s.a14; echo[k++] = s.a16;
    echo[k++] = real(s.flags);
    echo[k++] = instrument.source_radius; echo[k++] = instrument.source_distance;
    echo[k++] = instrument.emission_sine; echo[k++] = instrument.magnification;
    echo[k++] = instrument.detector_distance; echo[k++] = instrument.detector_half_size;
    echo[k++] = instrument.gate_position; echo[k++] = instrument.gate_slope; echo[k++] = instrument.gate_radius;
    echo[k++] = real(instrument.illumination_first); echo[k++] = real(instrument.illumination_count);
    echo[k++] = real(instrument.imaging_first); echo[k++] = real(instrument.imaging_count);
    echo[k++] = real(instrument.detector_pixels);
    echo[k++] = specimen.x_min; echo[k++] = specimen.y_min; echo[k++] = specimen.x_max; echo[k++] = specimen.y_max;
    echo[k++] = specimen.bottom; echo[k++] = specimen.top; echo[k++] = specimen.pitch_x; echo[k++] = specimen.pitch_y;
    echo[k++] = specimen.shape_parameter_0; echo[k++] = specimen.shape_parameter_1;
    echo[k++] = specimen.shape_parameter_2; echo[k++] = specimen.shape_parameter_3;
    echo[k++] = specimen.lipschitz; echo[k++] = specimen.scatter_g;
    echo[k++] = real(specimen.columns); echo[k++] = real(specimen.rows); echo[k++] = real(specimen.max_bounces);
    echo[k++] = real(specimen.kind); echo[k++] = real(specimen.shape);
    echo[k++] = exposure.top_distance; echo[k++] = real(exposure.seed); echo[k++] = real(exposure.image);
    echo[k++] = real(exposure.unused);
    Survivor v = survivors[2];
    echo[k++] = v.position.x; echo[k++] = v.position.y; echo[k++] = v.position.z; echo[k++] = v.direction_x;
    echo[k++] = v.direction_y; echo[k++] = real(v.test_occlusion);
}
