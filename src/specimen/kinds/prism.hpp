// place: 12
#pragma once

#include "dimensions/feature.hpp"
#include "specimen/square.hpp"

namespace vkfv::specimen {

// Type PRI (ISO 25178-70): two flanks along y on a plane, with a level between them or an edge.
struct Prism : Square {
    double height = 0; // over the plane, mm; negative: a V-groove
    double flank = 0;  // angle of either flank against the plane, rad
    double top = 0;    // width of the level between the flanks, mm

    static constexpr const char* name = "prism";
    static constexpr const char* meaning = "Type PRI of ISO 25178-70: a prism along y, a roof or a V-groove.";
    static std::vector<const Key*> keys();
    static Prism read(const Section& section);
    void raise(HeightField& field, double asked_pitch, const SourceLocation& where) const;
    dimensions::Prism feature() const;
    bool operator==(const Prism&) const = default;
};

} // namespace vkfv::specimen
