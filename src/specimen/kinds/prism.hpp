// place: 12
#pragma once

#include "dimensions/feature.hpp"
#include "specimen/square.hpp"

namespace vkfv::specimen {

// Type PRI (ISO 25178-70): two flanks along y on a plane, with a level top or an edge between them.
struct Prism : Square {
    double height = 0; // mm, above the plane; negative: a V-groove
    double flank = 0;  // rad, angle of either flank to the plane
    double top = 0;    // mm, width of the level top between the flanks

    static constexpr const char* name = "prism";
    static constexpr const char* meaning = "Type PRI of ISO 25178-70: a prism along y, a roof or a V-groove.";
    static std::vector<const Key*> keys();
    static Prism read(const Section& section);
    void raise(HeightField& field, double asked_pitch, const SourceLocation& where) const;
    dimensions::Prism feature() const;
    bool operator==(const Prism&) const = default;
};

} // namespace vkfv::specimen
