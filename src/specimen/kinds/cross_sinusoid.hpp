// place: 14
#pragma once

#include "dimensions/feature.hpp"
#include "specimen/square.hpp"

namespace vkfv::specimen {

// Type ACS (ISO 25178-70): the sum of a wave along x and one along y, both rising through 0 at the origin.
struct CrossSinusoid : Square {
    double amplitude = 0; // mm, of each wave
    double period = 0;    // mm, along x
    double period_y = 0;

    static constexpr const char* name = "cross-sinusoid";
    static constexpr const char* meaning =
        "Type ACS of ISO 25178-70: the sum of two sinusoidal waves across each other.";
    static std::vector<const Key*> keys();
    static CrossSinusoid read(const Section& section);
    void raise(HeightField& field, double asked_pitch, const SourceLocation& where) const;
    dimensions::CrossSinusoid feature() const;
    bool operator==(const CrossSinusoid&) const = default;
};

} // namespace vkfv::specimen
