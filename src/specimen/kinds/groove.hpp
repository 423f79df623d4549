// place: 10
#pragma once

#include "dimensions/feature.hpp"
#include "specimen/square.hpp"

namespace vkfv::specimen {

// A groove along y, below a level plane.
struct Groove : Square {
    double width = 0; // mm, between the middles of its flanks
    double depth = 0; // mm
    double wall = 0;  // mm, width of a flank; 0: one pitch

    static constexpr const char* name = "groove";
    static constexpr const char* meaning = "A groove along y.";
    static std::vector<const Key*> keys();
    static Groove read(const Section& section);
    void raise(HeightField& field, double asked_pitch, const SourceLocation& where) const;
    dimensions::Groove feature() const;
    bool operator==(const Groove&) const = default;
};

} // namespace vkfv::specimen
