#version 460
#extension GL_GOOGLE_include_directive : require
// Backward paths: an invocation takes some points of one pixel's lattice, so no two share the sums that they keep in
// registers. The sums are added up as integers, whose order does not matter: the same bits for any batch. The layout
// stands before the includes, which ask for gl_WorkGroupSize: glslang takes it as 1 when it is declared later.
layout(local_size_x = 128) in;

#include "device/kernel.glsl"
#include "device/cell_light.glsl"

layout(set = 0, binding = BINDING_PIXELS, scalar) buffer Pixels {
    uint64_t pixels[];
}; // in units of 2^-BACKWARD_FRACTION_BITS
layout(set = 0, binding = BINDING_BACKWARD, scalar) uniform Backward { BackwardBlock backward; };

layout(push_constant, scalar) uniform Push { BackwardBatch batch; };

// Fields of BackwardOptics as constants, so that loops have a known length.
layout(constant_id = CONSTANT_CONE_CANDIDATES) const uint cone_candidates = 1u;
layout(constant_id = CONSTANT_LOBE_CANDIDATES) const uint lobe_candidates = 0u;
layout(constant_id = CONSTANT_SURE_CANDIDATES) const uint sure_candidates = 1u;
layout(constant_id = CONSTANT_RIM_PERIOD) const uint rim_period = 0u;

// Source queries that only tracing can answer are kept until a lane has no room for more, or no more to come: few
// directions lie at the rim of the source's cone, and lanes that wait for each one's neighbour would trace for all.
layout(constant_id = CONSTANT_QUERY_CAPACITY) const uint query_capacity =
    12u; // more than a path asks: one at each bounce, and one at its end
SourceQuery queries[query_capacity];
uint query_count = 0u;
// The addresses at which the light of the path under way, and of each query, is added; used with pupil cells.
uint64_t path_cell = uint64_t(0);
uint64_t query_cells[query_capacity];

real ask_source(Instrument, SpecimenRecord, Exposure, SourceQuery query) {
    queries[query_count] = query;
    if (sorts_light) {
        query_cells[query_count] = path_cell;
    }
    query_count += 1u;
    return real(0.0);
}

uint64_t in_units(real value) { return uint64_t(value * BACKWARD_UNIT + real(0.5)); }

void main() {
    uint pixel_count = uint(instrument.detector_columns * instrument.detector_rows);
    // Workgroups stand in rows: a large detector needs more than one row may hold.
    uint group = gl_WorkGroupID.y * gl_NumWorkGroups.x + gl_WorkGroupID.x;
    uint index = group * gl_WorkGroupSize.x + gl_LocalInvocationIndex;
    if (index < batch.chunks) {
        uint pixel = (batch.first_pixel + index) % pixel_count;
        uint chunk = batch.first_chunk + (batch.first_pixel + index) / pixel_count;
        LatticeShift shift = lattice_shift(exposure.seed, exposure.image, pixel, batch.randomisation);
        int row = int(pixel) / instrument.detector_columns;
        int column = int(pixel) - row * instrument.detector_columns;
        BackwardOptics known = backward.optics;
        known.cone_candidates = cone_candidates;
        known.lobe_candidates = lobe_candidates;
        known.sure_candidates = sure_candidates;
        known.rim_period = rim_period;
        uint most_queries = query_capacity - uint(specimen.max_bounces) - 1u;
        real sum = real(0.0);
        for (uint point = 0u; point < batch.chunk_points;) {
            for (bool room = true; room; ++point) {
                uint place = chunk * batch.chunk_points + point;
                if (sorts_light) {
                    path_cell = cell_address(backward_place(known, pupil_cells, column, row,
                                                            backward_start(backward.lattice, shift, place)));
                }
                real value = trace_backward(known_instrument(), known, known_specimen(), exposure, column, row,
                                            batch.randomisation, backward.lattice, shift, place);
                sum += value;
                if (sorts_light && value > real(0.0)) {
                    add_cell_light(path_cell, in_units(value));
                }
                room = query_count <= most_queries && point + 1u < batch.chunk_points;
#ifdef VKFV_SOFTWARE
                if (!room) {
                    ++point;
                    break;
                }
#endif
            }
            for (uint k = 0u; k < query_count; ++k) {
                real value = trace_to_source(known_instrument(), known_specimen(), exposure, queries[k]);
                sum += value;
                if (sorts_light && value > real(0.0)) {
                    add_cell_light(query_cells[k], in_units(value));
                }
                VKFV_LEAVE_IF(k + 1u >= query_count);
            }
            query_count = 0u;
            VKFV_LEAVE_IF(point >= batch.chunk_points);
        }
        atomicAdd(pixels[pixel], in_units(sum));
    }
}
