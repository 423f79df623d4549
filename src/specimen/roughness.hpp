// Roughness over another surface, with a lattice of its own.
#pragma once

#include "specimen/specimen.hpp"

#include <cstdint>

namespace vkfv::specimen {

// Gaussian white noise of standard deviation `noise` on a grid of exactly `pitch` from the footprint's corner, filtered
// by a Gaussian of standard deviation `kernel`, periodic; mm. What remains is about noise * pitch / (2 sqrt(pi)
// kernel); the log prints what it is.
struct Roughness {
    double noise = 0;
    double kernel = 0;
    double pitch = 0;
    std::uint32_t seed = 0;

    bool operator==(const Roughness&) const = default;
};

// Whether roughness on this rectangle (mm) has sensible lengths and can be made in reasonable time; else InputError.
void check_roughness(double width, double height, const Roughness& roughness, const SourceLocation& where);

// Roughness added, interpolated (bicubic) to the points of a height field whose pitch is no coarser; else InputError.
void add_roughness(HeightField& field, const Roughness& roughness, const SourceLocation& where);

} // namespace vkfv::specimen
