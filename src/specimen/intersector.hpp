// The host's intersection of a ray with a specimen, in double: the reference for every traversal on a device.
#pragma once

#include "specimen/specimen.hpp"

#include <memory>

namespace vkfv::specimen {

// Shares no code with the device's traversals: it walks height fields cell by cell, meshes by a median-split hierarchy,
// and analytic surfaces by marching (through the shared height function). Immutable; safe from any thread.
class Intersector {
  public:
    explicit Intersector(const Specimen& specimen);
    ~Intersector();
    Intersector(Intersector&&) noexcept;

    // The nearest hit at a distance > 0 (mm for a unit direction), in the specimen frame.
    physics::f64::Hit hit(glm::dvec3 origin, glm::dvec3 direction) const;

    // The specimen's part of the scene that the shared physics requires: FEATURE_REFLECTANCE_MAP with the map's grid if
    // there is one; FEATURE_SPECTRAL_MATERIAL with the material's numbers if it depends on the wavelength.
    std::uint32_t features() const;
    double reflectance_at(int column, int row) const;
    double material_number(int index) const;

  private:
    struct State;
    std::unique_ptr<State> state_;
};

} // namespace vkfv::specimen
