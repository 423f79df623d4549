// place: 11
#pragma once

#include "dimensions/feature.hpp"
#include "specimen/square.hpp"

namespace vkfv::specimen {

// Types PPR and PPT (ISO 25178-70): lines along y above a ground, one of them centred on x = 0.
struct Grating : Square {
    enum class Profile { rectangular, triangular };
    Profile profile = Profile::rectangular;
    double period = 0;     // mm
    double depth = 0;      // mm, depth of the ground below the lines
    double line_width = 0; // mm, at half depth; for the rectangular profile
    double wall = 0;       // mm, width of a flank; 0: one pitch

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
