// What the shapes and lattices of analytic specimens are built and evaluated with, on the host in double.
#pragma once

#include "specimen/description.hpp"

namespace vkfv::specimen {

// The scene that the physics reads a lattice through; without a lattice it is never asked.
struct LatticeScene {
    const HeightField* lattice = nullptr;
    double lattice_at(int column, int row) const { return static_cast<double>(lattice->heights(column, row)); }
};

// The specimen of a generated kind. Rough and roughness fields are periodic over their grids.
//   rough      white noise on the grid of `pitch`, filtered by a Gaussian of standard deviation l / 2 (which
//   gives
//              the autocorrelation exp(-(r/l)^2)), its mean removed and scaled so that its Sq is `sq` exactly
//   roughness  on its own grid of exactly `pitch` from the footprint's corner, interpolated (bicubic) to the
//              facets' or lattice's points, which are therefore never further apart: the finer of the two
//              pitches is used. Its Sq is what the noise gives.
// The pitch is adjusted to divide the size.
std::variant<HeightField, Mesh, Analytic> generate(const Description& description);

// Whether roughness on this rectangle (mm) has sensible lengths and can be made in reasonable time; else InputError.
void check_roughness(double width, double height, const Roughness& roughness, const SourceLocation& where);

// Roughness added to a height field whose pitch is no coarser; else InputError.
void add_roughness(HeightField& field, const Roughness& roughness, const SourceLocation& where);

// The field at the points of another grid within it, by surface/resample.hpp; a point is interpolated where the nearest
// one of the field is.
HeightField on_grid(const HeightField& field, double x0, double y0, int columns, int rows, double pitch);

// The same on a grid of a finer pitch, that of [specimen.roughness], around the same centre. Throws InputError for more
// points than fit into memory.
HeightField refined(const HeightField& field, double pitch, const SourceLocation& where);

// White Gaussian noise of unit standard deviation, filtered by a Gaussian of standard deviation `kernel` (in
// points; 0: not at all) whose weights have the sum 1; periodic. Bits depend on std::mt19937_64 and the C
// library's log, sin and cos alone.
Grid<double> filtered_noise(int columns, int rows, double kernel, std::uint32_t seed);

} // namespace vkfv::specimen
