// place: 13
#pragma once

#include "dimensions/feature.hpp"
#include "specimen/square.hpp"

namespace vkfv::specimen {

// Type ACG (ISO 25178-70): raised parallelograms where the lines of two gratings cross, the middle of one at the
// origin.
struct CrossGrating : Square {
    double period = 0;     // across the first lines, which lie along y; mm
    double period_y = 0;   // across the second ones
    double angle = 0;      // from the first direction across the lines to the second, rad
    double line_width = 0; // of either lines, mm
    double depth = 0;      // of the ground below them, mm

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
