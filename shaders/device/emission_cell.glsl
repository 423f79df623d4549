// In which cell of the emission a path is (physics/emission_cell.glsl): of cells in the order of their paths, the
// last that begins at or before the path.
layout(set = 0, binding = BINDING_EMISSION_CELLS, scalar) readonly buffer EmissionCells { uvec4 emission_given[]; };
layout(set = 0, binding = BINDING_EMISSION_FIRST, scalar) readonly buffer EmissionFirst {
    uint64_t emission_first[]; // path of each cell
};

EmissionCell emission_cell(uvec2 path) {
    uint64_t number = packUint2x32(path);
    // Cells have nearly equal numbers of paths: from where it is on average, mostly within two steps.
    real average = (real(path.y) * real(4294967296.0) + real(path.x)) * emission_cells_per_path;
    uint last = emission_cells - 1u;
    uint place = uint(min(average, real(last)));
    while (place < last && emission_first[place + 1u] <= number) {
        ++place;
    }
    while (emission_first[place] > number) {
        --place;
    }
    EmissionCell cell;
    cell.given = emission_given[place];
    cell.drawn = emission_drawn;
    return cell;
}
