// The paths of an image leave the source in an order: consecutive ones close together, so that what is traced at a time
// meets the same part of the specimen. Place and direction at the source are four numbers in (0, 1), drawn of 21 bits
// each (random.glsl). Their cube is cut into equal cells by leading bits, and a path's number says in which cell it is
// (src/trace/interface/emission_order.hpp), where those bits are given and the others drawn.
struct EmissionCell {
    uvec4 given; // of the bits that place and direction are made of
    uvec4 drawn; // mask of the others
};

VKFV_FUNCTION EmissionCell all_emission() {
    EmissionCell cell;
    cell.given = uvec4(0u, 0u, 0u, 0u);
    cell.drawn = uvec4(0xFFFFFFFFu, 0xFFFFFFFFu, 0xFFFFFFFFu, 0xFFFFFFFFu);
    return cell;
}

// The first block of a path.
VKFV_FUNCTION Draws draw_in_cell(uint seed, uint image, uvec2 path, EmissionCell cell) {
    uvec4 bits = philox_4x32(uvec4(path.x, path.y, 0u, 0u), seed, image, PHILOX_ROUNDS);
    return draws_of_bits((bits & cell.drawn) | cell.given);
}
