// The light that a facet of the surface, which is a mirror, sends into the pupil.
#pragma once

#include <vector>

namespace vkfv::fields {

// Functions of a facet's slope (the tangent of its angle), for a pupil and a source that are round; radii in direction
// cosines times the index.
class FacetLight {
  public:
    FacetLight(double pupil_rim, double source_rim, double dark_rim, double index);

    // The share of the source's light that the facet reflects into the pupil: 1 if it is level and the source does not
    // overfill the pupil.
    double share(double slope) const { return at(shares_, slope); }
    // The factor by which the amplitude of a facet's wave is larger than its transfer function makes it. That takes the
    // obliquity factor of Kirchhoff's integral as 1 everywhere; a mirror's is 1 + q p / (q_z gamma_p) in its own
    // direction, so that it reflects all light however it is tilted.
    double amplitude(double slope) const { return at(amplitudes_, slope); }

  private:
    double at(const std::vector<double>& values, double slope) const;

    double step_ = 0; // of the slope
    std::vector<double> shares_, amplitudes_;
};

} // namespace vkfv::fields
