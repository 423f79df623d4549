// place: 1
#pragma once

#include "dimensions/feature.hpp"
#include "specimen/square.hpp"

namespace vkfv::specimen {

// A plane, level or tilted.
struct Plane : Continuous {
    double tilt_x = 0, tilt_y = 0; // rad, slope angles along x and y

    static constexpr const char* name = "plane";
    static constexpr const char* meaning = "A plane, level or tilted.";
    static std::vector<const Key*> keys();
    static Plane read(const Section& section);
    Analytic function(const SourceLocation& where) const;
    dimensions::Flat feature() const;
    bool operator==(const Plane&) const = default;
};

} // namespace vkfv::specimen
