// place: 5
#pragma once

#include "dimensions/feature.hpp"
#include "specimen/square.hpp"

namespace vkfv::specimen {

// A wave along x whose frequency changes linearly.
struct Chirp : Continuous {
    double amplitude = 0;   // half the peak-to-valley height, mm
    double period = 0;      // mm, at the lowest x
    double period_stop = 0; // mm, at the highest x

    static constexpr const char* name = "chirp";
    static constexpr const char* meaning = "A wave along x whose spatial frequency changes linearly.";
    static std::vector<const Key*> keys();
    static Chirp read(const Section& section);
    Analytic function(const SourceLocation& where) const;
    dimensions::Chirp feature() const;
    bool operator==(const Chirp&) const = default;
};

} // namespace vkfv::specimen
