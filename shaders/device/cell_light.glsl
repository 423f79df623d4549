// Light sorted by pupil cells, reached by its address: it may be larger than a descriptor spans. Cell after cell, row
// after row of parts of pixels.
layout(buffer_reference, scalar, buffer_reference_align = 8) buffer CellLight { uint64_t light; };

const bool sorts_light = (scene_features & FEATURE_PUPIL_CELLS) != 0u;

uint64_t cell_index(CellPlace place) {
    uint64_t columns = uint64_t(uint(instrument.detector_columns) * pupil_cells.parts);
    uint64_t rows = uint64_t(uint(instrument.detector_rows) * pupil_cells.parts);
    return (uint64_t(place.cell) * rows + uint64_t(place.row)) * columns + uint64_t(place.column);
}

void add_cell_light(uint64_t index, uint64_t light) {
    CellLight part = CellLight(packUint2x32(cell_light) + uint64_t(8) * index);
    atomicAdd(part.light, light);
}
