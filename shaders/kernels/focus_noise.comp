#version 460
#extension GL_GOOGLE_include_directive : require
// Adds an image to the sums that the noise is judged by: brightness, and squared second differences along z.
layout(local_size_x = 128) in;

#include "focus/device.glsl"

layout(set = 0, binding = BINDING_IMAGE, scalar) readonly buffer Latest { float latest[]; };
layout(set = 0, binding = BINDING_BEFORE, scalar) readonly buffer Before { float before[]; };
layout(set = 0, binding = BINDING_EARLIER, scalar) readonly buffer Earlier { float earlier[]; };
layout(set = 0, binding = BINDING_BRIGHTNESS, scalar) buffer Brightness { float brightness[]; };
layout(set = 0, binding = BINDING_SQUARED_DIFFERENCES, scalar) buffer SquaredDifferences {
    float squared_differences[];
};

layout(push_constant, scalar) uniform Push { NoiseSizes sizes; };

void main() {
    uint k = invocation();
    if (k < sizes.pixels) {
        for (uint channel = 0u; channel < sizes.channels; ++channel) {
            uint at = channel * sizes.pixels + k;
            brightness[k] += latest[at] / float(sizes.channels);
            if (sizes.differences == 1u) {
                precise float difference = earlier[at] - 2.0 * before[at] + latest[at];
                squared_differences[k] += difference * difference;
            }
        }
    }
}
