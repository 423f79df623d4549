// Finds the cell of the emission that a path starts in (physics/emission_cell.glsl): cells are in the order of their
// paths, and the cell is the last one that begins at or before the path.
layout(set = 0, binding = BINDING_EMISSION_CELLS, scalar) readonly buffer EmissionCells {
    uvec2 emission_given[]; // the upper 16 bits of each number, lower half of a word first
};
layout(set = 0, binding = BINDING_EMISSION_FIRST, scalar) readonly buffer EmissionFirst {
    uint64_t emission_first[]; // number of each cell's first path
};

uint emission_place = 0xFFFFFFFFu; // cell of the invocation's last path, as its paths ascend; 0xFFFFFFFF: none yet

EmissionCell emission_cell(uvec2 path) {
    uint64_t number = packUint2x32(path);
    uint last = emission_cells - 1u;
    if (emission_place > last) {
        // Cells have nearly equal numbers of paths, so the search starts at the average place, mostly within eight
        // steps.
        real average = (real(path.y) * real(4294967296.0) + real(path.x)) * emission_cells_per_path;
        emission_place = uint(min(average, real(last)));
        while (emission_first[emission_place] > number) {
            --emission_place;
        }
    }
    while (emission_place < last && emission_first[emission_place + 1u] <= number) {
        ++emission_place;
    }
    uvec2 given = emission_given[emission_place];
    EmissionCell cell;
    cell.given = uvec4(given.x & 0xFFFFu, given.x >> 16, given.y & 0xFFFFu, given.y >> 16) << 5;
    cell.drawn = emission_drawn;
    return cell;
}
