// place: 9
#pragma once

#include "dimensions/feature.hpp"
#include "specimen/square.hpp"

namespace vkfv::specimen {

// Type ASG (ISO 25178-70): a star of raised sectors; beyond its radius is the lower level. The edge of a sector lies at
// an azimuth of 0.
struct Star : Square {
    int petals = 0;    // raised sectors
    double radius = 0; // of their outer end, mm
    double height = 0; // over the sectors between them, mm

    static constexpr const char* name = "star";
    static constexpr const char* meaning = "Type ASG of ISO 25178-70: a star of raised sectors.";
    static std::vector<const Key*> keys();
    static Star read(const Section& section);
    void raise(HeightField& field, double asked_pitch, const SourceLocation& where) const;
    dimensions::Star feature() const;
    bool operator==(const Star&) const = default;
};

} // namespace vkfv::specimen
