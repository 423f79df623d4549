// place: 8
#pragma once

#include "specimen/square.hpp"

#include <cstdint>
#include <filesystem>

namespace vkfv::specimen {

// Type AIR (ISO 25178-70): irregular roughness, in tiles x tiles sub-surfaces side by side. Each sub-surface is an
// independent normal random surface whose power spectrum is constant below the frequency 1 / roll_off, falls with the
// power -2 (1 + hurst) above it and ends at 1 / shortest (B. N. J. Persson et al., "On the nature of surface roughness
// with application to contact mechanics, sealing, rubber friction and adhesion", 2005); its mean is 0 and its Sq is
// `sq` exactly. With a file, each is the middle of the measured surface in `file`, levelled as a whole and of mean 0.
// Neighbours differ in height at the seams, which are steps one pitch wide.
struct Air : Square {
    int tiles = 1;       // number along each side; the size is that of all tiles
    double sq = 0;       // mm
    double roll_off = 0; // mm, wavelength
    double shortest = 0; // mm, wavelength
    double hurst = 0;    // Hurst exponent
    std::uint32_t seed = 0;
    std::filesystem::path file; // measured surface; empty: random sub-surfaces

    static constexpr const char* name = "air";
    static constexpr const char* meaning =
        "Type AIR of ISO 25178-70: irregular roughness, in sub-surfaces side by side.";
    static std::vector<const Key*> keys();
    static Air read(const Section& section);
    void raise(HeightField& field, double asked_pitch, const SourceLocation& where) const;
    bool operator==(const Air&) const = default;
};

} // namespace vkfv::specimen
