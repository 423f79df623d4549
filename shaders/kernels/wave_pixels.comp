#version 460
#extension GL_GOOGLE_include_directive : require
// Adds the filters' light to each pixel of a window: the sum over the sensitive shares of the pixel's parts.
layout(local_size_x = 128) in;

#include "waves/device.glsl"

layout(set = 0, binding = WAVES_BINDING_IMAGE, scalar) readonly buffer Image { vec2 image[]; };
layout(set = 0, binding = WAVES_BINDING_PIXELS, scalar) buffer Pixels { float pixels[]; };
layout(push_constant, scalar) uniform Push { WaveSize size; };
layout(constant_id = WAVES_CONSTANT_FILTERS) const uint filters = 1u;

void main() {
    uint place = invocation();
    uint parts = size.cells.parts;
    uint columns = size.columns / parts;
    if (place < columns * (size.rows / parts)) {
        uint pixel_column = size.first_column + place % columns;
        uint pixel_row = size.first_row + place / columns;
        uint column = place % columns * parts;
        uint row = place / columns * parts;
        vec2 along = tile_weights(size.along, float(pixel_column) + 0.5);
        vec2 up = tile_weights(size.up, float(pixel_row) + 0.5);
        uint pixel = pixel_row * size.image_columns + pixel_column;
        float light = pixels[pixel];
        for (uint k = 0u; k < filters; ++k) {
            uint first = k / 2u * 4u * size.columns * size.rows; // two filters a plane
            float sum = 0.0;
            for (uint j = 0u; j < parts; ++j) {
                for (uint i = 0u; i < parts; ++i) {
                    sum += sensitive_share(size.cells, i) * sensitive_share(size.cells, j) *
                           image[first + (row + j) * 2u * size.columns + column + i][k % 2u];
                }
            }
            // A cosine stands at four frequencies, and a transform there and back counts 4 columns rows times.
            light += along[k % 2u] * up[k / 2u] * (sum / (float(size.columns) * float(size.rows)));
        }
        pixels[pixel] = light;
    }
}
