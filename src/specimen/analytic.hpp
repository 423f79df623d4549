// Host access, in double, of the physics to an analytic specimen's lattice.
#pragma once

#include "specimen/description.hpp"

namespace vkfv::specimen {

// Gives the lattice's heights; it is not called for a specimen without a lattice.
struct LatticeScene {
    const HeightField* lattice = nullptr;
    double lattice_at(int column, int row) const { return static_cast<double>(lattice->heights(column, row)); }
};

// The record that physics::surface_height() needs for a lattice on the plane z = 0. It has no bounds, which would take
// longer than the heights.
physics::f64::SpecimenRecord record_of_lattice(const HeightField& lattice);

} // namespace vkfv::specimen
