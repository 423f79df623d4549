// place: 13
#pragma once

#include "dimensions/feature.hpp"
#include "specimen/square.hpp"

namespace vkfv::specimen {

// Type ACG (ISO 25178-70): raised parallelograms where the lines of two gratings cross, one of them centred on the
// origin.
struct CrossGrating : Square {
    double period = 0;     // mm, across the first lines, which lie along y
    double period_y = 0;   // mm, across the second lines
    double angle = 0;      // rad, from the normal of the first lines to that of the second
    double line_width = 0; // mm, width of the lines of both gratings
    double depth = 0;      // mm, depth of the ground below the parallelograms

    static constexpr const char* name = "cross-grating";
    static constexpr const char* meaning =
        "Type ACG of ISO 25178-70: raised areas where the lines of two gratings cross.";
    static std::vector<const Key*> keys();
    static CrossGrating read(const Section& section);
    void raise(HeightField& field, double asked_pitch, const SourceLocation& where) const;
    dimensions::CrossGrating feature() const;
    bool operator==(const CrossGrating&) const = default;
};

} // namespace vkfv::specimen
