// place: 4
#pragma once

#include "dimensions/feature.hpp"
#include "specimen/square.hpp"

namespace vkfv::specimen {

// A sine wave along x.
struct Sinusoid : Continuous {
    double amplitude = 0; // mm, half the peak-to-valley height
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
