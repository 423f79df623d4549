// place: 3
#pragma once

#include "dimensions/feature.hpp"
#include "specimen/square.hpp"

namespace vkfv::specimen {

// A spherical cap on a plane, or a dimple in it.
struct Sphere : Continuous {
    double radius = 0; // mm, radius of the sphere
    double height = 0; // mm, height of the cap above the plane; negative: a dimple

    static constexpr const char* name = "sphere";
    static constexpr const char* meaning = "The cap of a sphere on a plane, or a dimple in it.";
    static std::vector<const Key*> keys();
    static Sphere read(const Section& section);
    Analytic function(const SourceLocation& where) const;
    dimensions::SphereCap feature() const;
    bool operator==(const Sphere&) const = default;
};

} // namespace vkfv::specimen
