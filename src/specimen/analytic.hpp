// What the physics reads an analytic specimen's lattice through, on the host in double.
#pragma once

#include "specimen/description.hpp"

namespace vkfv::specimen {

// Without a lattice it is never asked.
struct LatticeScene {
    const HeightField* lattice = nullptr;
    double lattice_at(int column, int row) const { return static_cast<double>(lattice->heights(column, row)); }
};

// What physics::surface_height() needs of a lattice on the plane z = 0: no bounds, which take longer than heights.
physics::f64::SpecimenRecord record_of_lattice(const HeightField& lattice);

} // namespace vkfv::specimen
