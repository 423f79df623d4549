// The host's own way of meeting a specimen with a ray, in double: the reference for every traversal on a device.
#pragma once

#include "specimen/specimen.hpp"

#include <memory>

namespace vkfv::specimen {

// Shares no code with the device's traversals: a cell-by-cell walk for height fields, a median-split hierarchy for
// meshes, marching for analytic surfaces (through the shared height function). Immutable; safe from any thread.
class Intersector {
  public:
    explicit Intersector(const Specimen& specimen);
    ~Intersector();
    Intersector(Intersector&&) noexcept;

    // Nearest meeting at a distance > 0 (mm for a unit direction); specimen frame.
    physics::f64::Hit hit(glm::dvec3 origin, glm::dvec3 direction) const;

    // What the shared physics asks of the specimen besides: FEATURE_REFLECTANCE_MAP if it has one, and its grid;
    // FEATURE_SPECTRAL_MATERIAL if the wavelength changes its material, and that material's numbers.
    std::uint32_t features() const;
    double reflectance_at(int column, int row) const;
    double material_number(int index) const;

  private:
    struct State;
    std::unique_ptr<State> state_;
};

} // namespace vkfv::specimen
