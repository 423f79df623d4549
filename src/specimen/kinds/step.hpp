// place: 2
#pragma once

#include "dimensions/feature.hpp"
#include "specimen/square.hpp"

namespace vkfv::specimen {

// A step between two levels, with a straight flank along y.
struct Step : Continuous {
    double height = 0; // mm, of the upper level, at x > 0, above the lower one
    double wall = 0;   // mm, width of the flank; 0: one pitch

    static constexpr const char* name = "step";
    static constexpr const char* meaning = "A step between two levels, along y through the middle.";
    static std::vector<const Key*> keys();
    static Step read(const Section& section);
    Analytic function(const SourceLocation& where) const;
    dimensions::Step feature() const;
    bool operator==(const Step&) const = default;
};

} // namespace vkfv::specimen
