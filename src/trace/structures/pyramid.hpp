// Bounds of a specimen's heights over blocks of cells: minima and maxima as boxes are made of, and the ceilings that
// shaders/device/specimen_quadtree.glsl jumps by.
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
    std::int32_t padded_x = 0; // the same rounded up to multiples of 2^top_level
    std::int32_t padded_y = 0;
    std::int32_t top_level = 0;
    float cell_x = 0; // mm
    float cell_y = 0;
};

// (lowest, highest) height in mm of every block of 2^level x 2^level cells: level by level from the finest,
// row-major, row 0 at the lowest y. Each range encloses the surface over its block with what float arithmetic
// may add to a height. Blocks beyond the cells hold the empty range (+inf, -inf).
struct Pyramid {
    PyramidHeader header;
    std::vector<glm::vec2> ranges;

    // Of block (column, row) of a level.
    glm::vec2 range(int level, int column, int row) const;
};

// Over the cells of the lattice, or over tiles of the footprint where there is none. shape: the record of the
// same surface without its lattice, whose lipschitz bounds the slope of the shape alone.
Pyramid make_pyramid(const specimen::Analytic& surface, const physics::f64::SpecimenRecord& shape);

// Cells of that pyramid: (columns, rows).
glm::ivec2 pyramid_cells(const specimen::Analytic& surface);

// mm: of every block of 2^level x 2^level cells the highest point of it and of the blocks around it, with what float
// arithmetic may add to a height. Two levels, row-major, row 0 at the lowest y.
struct Ceilings {
    kernels::CeilingsHeader header{};
    std::vector<float> heights;
};

// Whichever way its cells are split.
Ceilings make_ceilings(const specimen::HeightField& field);
// relief: highest less lowest height of the surface, mm.
Ceilings make_ceilings(const Pyramid& pyramid, double relief);

} // namespace vkfv::trace
