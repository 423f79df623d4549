// place: 11
#pragma once

#include "dimensions/feature.hpp"
#include "specimen/square.hpp"

namespace vkfv::specimen {

// Types PPR and PPT (ISO 25178-70): lines along y over a ground, the middle of one at x = 0.
struct Grating : Square {
    enum class Profile { rectangular, triangular };
    Profile profile = Profile::rectangular;
    double period = 0;     // mm
    double depth = 0;      // of the ground below the lines, mm
    double line_width = 0; // at half depth, mm; of the rectangular profile
    double wall = 0;       // width of a flank, mm; 0: one pitch

    static constexpr const char* name = "grating";
    static constexpr const char* meaning =
        "Types PPR and PPT of ISO 25178-70: parallel lines of rectangular or triangular shape.";
    static std::vector<const Key*> keys();
    static Grating read(const Section& section);
    void raise(HeightField& field, double asked_pitch, const SourceLocation& where) const;
    dimensions::Grating feature() const;
    bool operator==(const Grating&) const = default;
};

} // namespace vkfv::specimen
