// place: 4
#pragma once

#include "dimensions/feature.hpp"
#include "specimen/square.hpp"

namespace vkfv::specimen {

// A wave along x.
struct Sinusoid : Continuous {
    double amplitude = 0; // half the peak-to-valley height, mm
    double period = 0;    // mm

    static constexpr const char* name = "sinusoid";
    static constexpr const char* meaning = "A sinusoidal wave along x.";
    static std::vector<const Key*> keys();
    static Sinusoid read(const Section& section);
    Analytic function(const SourceLocation& where) const;
    dimensions::Sinusoid feature() const;
    bool operator==(const Sinusoid&) const = default;
};

} // namespace vkfv::specimen
