#version 460
#extension GL_GOOGLE_include_directive : require
// Adds an image to the sums that the noise is judged by: brightness, and squared second differences along z.
layout(local_size_x = 128) in;

#include "focus/device.glsl"

layout(set = 0, binding = 0, scalar) readonly buffer Latest { float latest[]; };
layout(set = 0, binding = 1, scalar) readonly buffer Before { float before[]; };
layout(set = 0, binding = 2, scalar) readonly buffer Earlier { float earlier[]; };
layout(set = 0, binding = 3, scalar) buffer Brightness { float brightness[]; };
layout(set = 0, binding = 4, scalar) buffer SquaredDifferences { float squared_differences[]; };

layout(push_constant, scalar) uniform Sizes {
    uint pixels;
    uint channels;
    uint differences; // 0: there are no two images before this
};

void main() {
    uint k = invocation();
    if (k < pixels) {
        for (uint channel = 0u; channel < channels; ++channel) {
            uint at = channel * pixels + k;
            brightness[k] += latest[at] / float(channels);
            if (differences == 1u) {
                precise float difference = earlier[at] - 2.0 * before[at] + latest[at];
                squared_differences[k] += difference * difference;
            }
        }
    }
}
