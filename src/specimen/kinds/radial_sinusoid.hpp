// place: 15
#pragma once

#include "dimensions/feature.hpp"
#include "specimen/square.hpp"

namespace vkfv::specimen {

// Type ARS (ISO 25178-70): circular waves about the origin, with a peak there.
struct RadialSinusoid : Square {
    double amplitude = 0; // mm
    double period = 0;    // mm, along the radius

    static constexpr const char* name = "radial-sinusoid";
    static constexpr const char* meaning = "Type ARS of ISO 25178-70: circular sinusoidal waves about the middle.";
    static std::vector<const Key*> keys();
    static RadialSinusoid read(const Section& section);
    void raise(HeightField& field, double asked_pitch, const SourceLocation& where) const;
    dimensions::RadialSinusoid feature() const;
    bool operator==(const RadialSinusoid&) const = default;
};

} // namespace vkfv::specimen
