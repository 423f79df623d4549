// place: 9
#pragma once

#include "dimensions/feature.hpp"
#include "specimen/square.hpp"

namespace vkfv::specimen {

// Type ASG (ISO 25178-70): a star of raised sectors within a radius; the level outside is the lower one. A sector has
// an edge at the azimuth 0.
struct Star : Square {
    int petals = 0;    // number of raised sectors
    double radius = 0; // mm, radius of the sectors' outer end
    double height = 0; // mm, height above the sectors between them

    static constexpr const char* name = "star";
    static constexpr const char* meaning = "Type ASG of ISO 25178-70: a star of raised sectors.";
    static std::vector<const Key*> keys();
    static Star read(const Section& section);
    void raise(HeightField& field, double asked_pitch, const SourceLocation& where) const;
    dimensions::Star feature() const;
    bool operator==(const Star&) const = default;
};

} // namespace vkfv::specimen
