// Meshes that are height fields, as instruments and programs export height maps.
#pragma once

#include "specimen/specimen.hpp"

#include <optional>
#include <vector>

namespace vkfv::trace {

// A height field of which each cell is two triangles, split either way.
struct MeshLattice {
    specimen::HeightField field;
    std::vector<bool> falling; // by cell: split from (i+1, j) to (i, j+1), not from (i, j) to (i+1, j+1)
};

// The mesh as a lattice, if it is one: its points lie within lattice_tolerance of a regular grid over x and y, one
// height each, and every cell is covered by two triangles, in any order and orientation, without holes.
std::optional<MeshLattice> lattice_of(const specimen::Mesh& mesh);

// Lateral tolerance, mm: far below what a height shows, and above the rounding of a millimetre in files of six digits.
inline constexpr double lattice_tolerance = 1e-6;

} // namespace vkfv::trace
