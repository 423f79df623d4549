// The spread of light from a point of the specimen over the objective's pupil, and the error of contrast that it
// causes.
#pragma once

#include "core/mathematics/grid.hpp"
#include "optics/instrument/instrument.hpp"
#include "specimen/description.hpp"
#include "specimen/specimen.hpp"

#include <cstddef>

namespace vkfv::measurement {

// The numbers of a material, which the shared physics asks its scene for.
class MaterialScene {
  public:
    explicit MaterialScene(const specimen::Material& material) : material_(specimen::material_numbers(material)) {}
    double material_number(int index) const { return material_.numbers[static_cast<std::size_t>(index)]; }

  private:
    specimen::MaterialNumbers material_;
};

// Shares of a source's light that a level point in the middle of the field sends into cells of the objective's pupil.
// The pupil is the circle inscribed in the grid, and its coordinates are direction cosines. A cell whose middle lies
// outside has 0. All cells have 0 where no light arrives.
using PupilLight = Grid<double>;

inline constexpr int pupil_light_cells = 32; // across the pupil

// The light of that source of `instrument` which `source` describes. aperture_sine: of the objective, in the object's
// medium. Mirror lobes and sharp lobes are sampled by 65536 paths, others are integrated over 1024 points of the
// source.
PupilLight pupil_light(const optics::InstrumentDescription& description, const optics::SourceDescription& source,
                       const optics::Instrument& instrument, const specimen::Material& material, double aperture_sine);

// The largest error of contrast, over all frequencies that a pupil passes in focus, of images that add the waves of
// different paths without their phases. Such images count light at the middle m of two points of the pupil, m + lambda
// f / 2 and m - lambda f / 2, whose waves make the frequency f. For weak differences of reflectance the light that
// counts is the mean over the two points themselves (Hopkins, Proc. R. Soc. A 217, 408 (1953), for weak objects). The
// two agree where the pupil is filled evenly. The error is 1 where no light arrives.
double contrast_error_of(const PupilLight& light);

} // namespace vkfv::measurement
