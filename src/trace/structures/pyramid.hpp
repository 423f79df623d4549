// Bounds of a specimen's heights over blocks of cells: minima and maxima, of which boxes are made, and the ceilings
// over which shaders/device/specimen_quadtree.glsl jumps.
#pragma once

#include "device/interface.hpp"
#include "specimen/specimen.hpp"

#include <glm/glm.hpp>

#include <cstddef>
#include <cstdint>
#include <vector>

namespace vkfv::trace {

struct PyramidHeader {
    std::int32_t cells_x = 0; // cells with a surface
    std::int32_t cells_y = 0;
    std::int32_t padded_x = 0; // rounded up to multiples of 2^top_level
    std::int32_t padded_y = 0;
    std::int32_t top_level = 0;
    float cell_x = 0; // mm
    float cell_y = 0;
};

// (lowest, highest) height in mm of every block of 2^level x 2^level cells: level by level from the finest, row-major,
// row 0 at the lowest y. Each range encloses the surface over its block and the error that float arithmetic may add to
// a height. Blocks beyond the cells hold the empty range (+inf, -inf).
struct Pyramid {
    PyramidHeader header;
    std::vector<glm::vec2> ranges;

    // The range of block (column, row) of a level.
    glm::vec2 range(int level, int column, int row) const;
};

// The pyramid over the cells of the lattice, or over tiles of the footprint where there is none. shape: the record of
// the same surface without its lattice, whose lipschitz bounds the slope of the shape alone.
Pyramid make_pyramid(const specimen::Analytic& surface, const physics::f64::SpecimenRecord& shape);

// The number of cells of that pyramid: (columns, rows).
glm::ivec2 pyramid_cells(const specimen::Analytic& surface);

// Ceilings, mm: for every block of 2^level x 2^level cells the highest point of it and of the blocks around it, with
// the error that float arithmetic may add to a height. There are two levels, row-major, row 0 at the lowest y.
struct Ceilings {
    kernels::CeilingsHeader header{};
    std::vector<float> heights;
};

// The ceilings of a height field, whichever way its cells are split.
Ceilings make_ceilings(const specimen::HeightField& field);
// The ceilings over a pyramid's cells. relief: highest less lowest height of the surface, mm.
Ceilings make_ceilings(const Pyramid& pyramid, double relief);

} // namespace vkfv::trace
