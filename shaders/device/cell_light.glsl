// Light sorted by pupil cells. It is reached by addresses, since it may be larger than a descriptor spans or than a
// device allocates at once. A table holds the address of each cell's image, which lies row after row of parts of
// pixels.
layout(buffer_reference, scalar, buffer_reference_align = 8) buffer CellLight { uint64_t light; };
layout(buffer_reference, scalar, buffer_reference_align = 8) readonly buffer CellAddress { uint64_t first; };

const bool sorts_light = (scene_features & FEATURE_PUPIL_CELLS) != 0u;

// The address of the number that counts the light of a cell at a part of a pixel.
uint64_t cell_address(CellPlace place) {
    uint64_t columns = uint64_t(uint(instrument.detector_columns) * pupil_cells.parts);
    uint64_t image = CellAddress(packUint2x32(cell_light) + uint64_t(8) * uint64_t(place.cell)).first;
    return image + uint64_t(8) * (uint64_t(place.row) * columns + uint64_t(place.column));
}

void add_cell_light(uint64_t address, uint64_t light) {
    CellLight part = CellLight(address);
    atomicAdd(part.light, light);
}
