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

#define ECHO_LOBE(lobe) \
    echo[k++] = real(lobe.model); \
    echo[k++] = lobe.weight; \
    echo[k++] = lobe.parameter_0; \
    echo[k++] = lobe.parameter_1; \
    echo[k++] = lobe.parameter_2; \
    echo[k++] = lobe.parameter_3; \
    for (int i = 0; i < LOBE_TABLE_SIZE; ++i) { \
        echo[k++] = lobe.table[i]; \
    }

void main() {
    int k = 0;
    // The last of three, so that the array's stride is seen too.
    Surface s = surfaces[2];
    echo[k++] = s.curvature;
    echo[k++] = s.conic;
    echo[k++] = s.semi_diameter_squared;
    echo[k++] = s.distance;
    echo[k++] = s.index_before;
    echo[k++] = s.index_after;
    echo[k++] = s.a4;
    echo[k++] = s.a6;
    echo[k++] = s.a8;
    echo[k++] = s.a10;
    echo[k++] = s.a12;
    echo[k++] = s.a14;
    echo[k++] = s.a16;
    echo[k++] = s.decentre_x;
    echo[k++] = s.decentre_y;
    echo[k++] = s.rotation_xx;
    echo[k++] = s.rotation_xy;
    echo[k++] = s.rotation_xz;
    echo[k++] = s.rotation_yx;
    echo[k++] = s.rotation_yy;
    echo[k++] = s.rotation_yz;
    echo[k++] = s.rotation_zx;
    echo[k++] = s.rotation_zy;
    echo[k++] = s.rotation_zz;
    echo[k++] = s.power;
    echo[k++] = s.reflectance;
    echo[k++] = s.layer_index;
    echo[k++] = s.layer_thickness;
    echo[k++] = s.bend_residual;
    Dispersion d = s.dispersion_before;
    echo[k++] = d.c1;
    echo[k++] = d.c2;
    echo[k++] = d.c3;
    echo[k++] = d.c4;
    echo[k++] = d.c5;
    echo[k++] = d.c6;
    d = s.dispersion_after;
    echo[k++] = d.c1;
    echo[k++] = d.c2;
    echo[k++] = d.c3;
    echo[k++] = d.c4;
    echo[k++] = d.c5;
    echo[k++] = d.c6;
    echo[k++] = real(s.flags);
    echo[k++] = instrument.source_radius;
    echo[k++] = instrument.source_distance;
    echo[k++] = instrument.emission_sine;
    echo[k++] = instrument.magnification;
    echo[k++] = instrument.detector_distance;
    echo[k++] = instrument.detector_half_size;
    echo[k++] = instrument.gate_position;
    echo[k++] = instrument.gate_slope;
    echo[k++] = instrument.gate_radius;
    echo[k++] = instrument.spectrum_centre;
    echo[k++] = instrument.spectrum_half_width;
    echo[k++] = instrument.specimen_index;
    d = instrument.specimen_dispersion;
    echo[k++] = d.c1;
    echo[k++] = d.c2;
    echo[k++] = d.c3;
    echo[k++] = d.c4;
    echo[k++] = d.c5;
    echo[k++] = d.c6;
    RingLight ring = instrument.ring;
    echo[k++] = ring.aim_distance;
    echo[k++] = ring.distance;
    echo[k++] = ring.elevation_sine;
    echo[k++] = ring.elevation_cosine;
    echo[k++] = ring.half_width;
    echo[k++] = ring.fill;
    echo[k++] = real(ring.segments);
    echo[k++] = real(ring.switched_on);
    echo[k++] = real(instrument.spectral_bins);
    echo[k++] = real(instrument.illumination_first);
    echo[k++] = real(instrument.illumination_count);
    echo[k++] = real(instrument.imaging_first);
    echo[k++] = real(instrument.imaging_count);
    echo[k++] = real(instrument.detector_pixels);
    echo[k++] = specimen.x_min;
    echo[k++] = specimen.y_min;
    echo[k++] = specimen.x_max;
    echo[k++] = specimen.y_max;
    echo[k++] = specimen.bottom;
    echo[k++] = specimen.top;
    echo[k++] = specimen.pitch_x;
    echo[k++] = specimen.pitch_y;
    echo[k++] = specimen.shape_parameter_0;
    echo[k++] = specimen.shape_parameter_1;
    echo[k++] = specimen.shape_parameter_2;
    echo[k++] = specimen.shape_parameter_3;
    echo[k++] = specimen.lipschitz;
    ECHO_LOBE(specimen.material.lobe_0)
    ECHO_LOBE(specimen.material.lobe_1)
    ECHO_LOBE(specimen.material.lobe_2) ECHO_LOBE(specimen.material.lobe_3) echo[k++] = real(specimen.columns);
    echo[k++] = real(specimen.rows);
    echo[k++] = real(specimen.max_bounces);
    echo[k++] = real(specimen.kind);
    echo[k++] = real(specimen.shape);
    echo[k++] = exposure.top_distance;
    echo[k++] = real(exposure.seed);
    echo[k++] = real(exposure.image);
    echo[k++] = exposure.focal_height;
    echo[k++] = exposure.top_distance_residual;
    SpectralBin bin = spectrum[2];
    echo[k++] = bin.cumulative;
    echo[k++] = bin.start;
    echo[k++] = bin.stop;
    echo[k++] = bin.tilt;
    Survivor v = survivors[2];
    echo[k++] = v.position.x;
    echo[k++] = v.position.y;
    echo[k++] = v.position.z;
    echo[k++] = v.direction_x;
    echo[k++] = v.direction_y;
    echo[k++] = v.spectral;
    echo[k++] = v.survival;
    echo[k++] = real(v.mark);
}
