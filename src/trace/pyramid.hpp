// Minimum/maximum pyramid over the cells of a specimen, as shaders/device/specimen_quadtree.glsl reads it.
#pragma once

#include "physics/physics.hpp"
#include "specimen/specimen.hpp"

#include <glm/glm.hpp>

#include <cstddef>
#include <cstdint>
#include <vector>

namespace vkfv::trace {

// The head of the device's buffer, in scalar layout; the ranges follow.
struct PyramidHeader {
    std::int32_t cells_x = 0; // cells with a surface
    std::int32_t cells_y = 0;
    std::int32_t padded_x = 0; // the same rounded up to multiples of 2^top_level
    std::int32_t padded_y = 0;
    std::int32_t top_level = 0;
    float cell_x = 0; // mm
    float cell_y = 0;
    float unused = 0;
};
static_assert(sizeof(PyramidHeader) == 8 * 4);

// (lowest, highest) height in mm of every block of 2^level x 2^level cells: level by level from the finest,
// row-major, row 0 at the lowest y. Each range encloses the surface over its block with what float arithmetic
// may add to a height. Blocks beyond the cells hold the empty range (+inf, -inf).
struct Pyramid {
    PyramidHeader header;
    std::vector<glm::vec2> ranges;

    // Of block (column, row) of a level.
    glm::vec2 range(int level, int column, int row) const;
    std::size_t bytes() const { return sizeof header + ranges.size() * sizeof(glm::vec2); }
};

// How many bytes the pyramid over so many cells takes: known before it is made.
std::size_t pyramid_bytes(int cells_x, int cells_y);

// Over the cells of the height field.
Pyramid make_pyramid(const specimen::HeightField& field);

// Over the cells of the lattice, or over tiles of the footprint where there is none. shape: the record of the
// same surface without its lattice, whose lipschitz bounds the slope of the shape alone.
Pyramid make_pyramid(const specimen::Analytic& surface, const physics::f64::SpecimenRecord& shape);

// Cells of that pyramid: (columns, rows).
glm::ivec2 pyramid_cells(const specimen::Analytic& surface);

} // namespace vkfv::trace
