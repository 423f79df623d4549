#version 460
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_scalar_block_layout : require
#extension GL_EXT_shader_explicit_arithmetic_types_int64 : require
#extension GL_EXT_buffer_reference : require
// Makes an image of the counted numbers: an invocation takes a pixel; workgroups stand in rows where one row holds too
// few.
#define VKFV_FUNCTION
#define VKFV_PRECISE precise
#include "estimate/pixel.glsl"
#include "estimate/interface.glsl"

layout(local_size_x = ESTIMATE_WORKGROUP) in;
layout(buffer_reference, scalar, buffer_reference_align = 8) readonly buffer Number { uint64_t number; };
layout(buffer_reference, scalar, buffer_reference_align = 4) readonly buffer Wave { float light; };
layout(buffer_reference, scalar, buffer_reference_align = 8) writeonly buffer Estimate { double power; };
layout(push_constant, scalar) uniform Push { EstimatedPixels of; };

double number_at(uint64_t place) { return double(Number(of.numbers + uint64_t(8) * place).number); }

PixelEstimate estimate_of(uint pixel) {
    if (of.rule.kind == ESTIMATE_COUNTS) {
        double rays = number_at(uint64_t(pixel));
        return estimate_of_rays(of.rule, rays, rays);
    }
    if (of.rule.kind == ESTIMATE_WEIGHTS) {
        uint64_t first = uint64_t(2) * uint64_t(pixel);
        return estimate_of_rays(of.rule, of.rule.unit * number_at(first),
                                of.rule.unit_of_squares * number_at(first + uint64_t(1)));
    }
    MeanSums sums;
    sums.sum = double(0.0);
    sums.squares = double(0.0);
    for (uint randomisation = 0u; double(randomisation) < of.rule.count; ++randomisation) {
        sums = with_randomisation(of.rule, sums,
                                  number_at(uint64_t(randomisation) * uint64_t(of.stride) + uint64_t(pixel)));
    }
    return estimate_of_randomisations(of.rule, sums);
}

void put(uint plane, uint pixel, double power) {
    uint64_t place = uint64_t(plane) * uint64_t(of.pixels) + uint64_t(pixel);
    Estimate(of.estimates + uint64_t(8) * place).power = power;
}

void main() {
    uint group = gl_WorkGroupID.y * gl_NumWorkGroups.x + gl_WorkGroupID.x;
    uint pixel = group * gl_WorkGroupSize.x + gl_LocalInvocationIndex;
    if (pixel < of.pixels) {
        PixelEstimate estimate = estimate_of(pixel);
        if (of.waves == uint64_t(0)) {
            put(0u, pixel, estimate.standard_error);
            put(1u, pixel, estimate.flux);
        } else {
            double light = double(Wave(of.waves + uint64_t(4) * uint64_t(pixel)).light);
            put(0u, pixel, estimate.standard_error * of.waves_noise);
            put(1u, pixel, of.waves_scale * light);
            if (of.by_rays != 0u) {
                put(2u, pixel, estimate.flux);
            }
        }
    }
}
