// Roughness that is added to another surface, from a lattice of its own.
#pragma once

#include "specimen/specimen.hpp"

#include <cstdint>
#include <optional>

namespace vkfv::specimen {

// Periodic Gaussian white noise of standard deviation `noise` (mm) on a grid of exactly `pitch` (mm) from the
// footprint's corner, filtered by a Gaussian of standard deviation `kernel` (mm; 0: no filter). The filtered root mean
// square height is about noise * pitch / (2 sqrt(pi) kernel); the log prints the exact one. If sq or ra is given (one
// of them at most), the mean is removed and the heights are scaled to it, whatever `noise` is.
struct Roughness {
    double noise = 0;
    double kernel = 0;
    double pitch = 0;
    std::uint32_t seed = 0;
    std::optional<double> sq{};       // mm, root mean square height
    std::optional<double> ra{};       // mm, as RoughnessHeights::ra
    std::optional<double> shortest{}; // mm; shorter wavelengths, and ones above the next, are removed
    std::optional<double> longest{};

    bool operator==(const Roughness&) const = default;
};

// Height parameters of roughness over a grid, about its mean, in the unit of the heights.
struct RoughnessHeights {
    double sq = 0; // root mean square height, ISO 25178-2
    double sa = 0; // arithmetic mean height, ISO 25178-2
    // Ra (ISO 21920-2) over the whole length, without a filter: the arithmetic mean deviation from a line's own mean,
    // averaged over all rows and columns.
    double ra = 0;
};
RoughnessHeights roughness_heights(const Grid<double>& heights);

// Throws InputError if roughness on this rectangle (mm) has invalid lengths or would take too long to make.
void check_roughness(double width, double height, const Roughness& roughness, const SourceLocation& where);

// Adds roughness to a height field, interpolated (bicubic) to its points. Throws InputError if the field's pitch is
// coarser than the roughness'.
void add_roughness(HeightField& field, const Roughness& roughness, const SourceLocation& where);

} // namespace vkfv::specimen
