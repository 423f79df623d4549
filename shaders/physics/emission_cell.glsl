// Consecutive paths of an image leave the source close together, so that the paths traced at a time meet the same part
// of the specimen. Place and direction at the source are four numbers in (0, 1), drawn of 21 bits each (random.glsl).
// Their cube is cut into equal cells by leading bits; a path's number says in which cell it starts
// (src/trace/interface/emission_order.hpp): there those bits are given and the others drawn.
struct EmissionCell {
    uvec4 given; // values of the given bits, in the words that place and direction are made of
    uvec4 drawn; // mask of the bits that are drawn
};

VKFV_FUNCTION EmissionCell all_emission() {
    EmissionCell cell;
    cell.given = uvec4(0u, 0u, 0u, 0u);
    cell.drawn = uvec4(0xFFFFFFFFu, 0xFFFFFFFFu, 0xFFFFFFFFu, 0xFFFFFFFFu);
    return cell;
}

// The first block of a path's random numbers.
VKFV_FUNCTION Draws draw_in_cell(uint seed, uint image, uvec2 path, EmissionCell cell) {
    uvec4 bits = philox_4x32(uvec4(path.x, path.y, 0u, 0u), seed, image, PHILOX_ROUNDS);
    return draws_of_bits((bits & cell.drawn) | cell.given);
}
