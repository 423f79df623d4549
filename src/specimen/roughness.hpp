// Roughness over another surface, with a lattice of its own.
#pragma once

#include "specimen/specimen.hpp"

#include <cstdint>
#include <optional>

namespace vkfv::specimen {

// Gaussian white noise of standard deviation `noise` on a grid of exactly `pitch` from the footprint's corner, filtered
// by a Gaussian of standard deviation `kernel` (0: none), periodic; mm. What remains is about noise * pitch / (2
// sqrt(pi) kernel); the log prints what it is. With sq or ra, of which one may be given, the mean is removed and the
// heights are scaled to it, whatever `noise` is.
struct Roughness {
    double noise = 0;
    double kernel = 0;
    double pitch = 0;
    std::uint32_t seed = 0;
    std::optional<double> sq{};       // root mean square height
    std::optional<double> ra{};       // as RoughnessHeights::ra
    std::optional<double> shortest{}; // wavelengths, mm: shorter and longer ones are taken out of the spectrum
    std::optional<double> longest{};

    bool operator==(const Roughness&) const = default;
};

// Of heights over a grid, about their mean; in its unit.
struct RoughnessHeights {
    double sq = 0; // root mean square height, ISO 25178-2
    double sa = 0; // arithmetic mean height, ISO 25178-2
    double ra = 0; // mean of all rows' and columns' arithmetic mean deviation from their own mean: Ra (ISO 21920-2)
                   // over the whole length, without a filter
};
RoughnessHeights roughness_heights(const Grid<double>& heights);

// Whether roughness on this rectangle (mm) has sensible lengths and can be made in reasonable time; else InputError.
void check_roughness(double width, double height, const Roughness& roughness, const SourceLocation& where);

// Roughness added, interpolated (bicubic) to the points of a height field whose pitch is no coarser; else InputError.
void add_roughness(HeightField& field, const Roughness& roughness, const SourceLocation& where);

} // namespace vkfv::specimen
