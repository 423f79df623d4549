// The true surface at the places that the pixels see.
#pragma once

#include "configuration/configuration.hpp"
#include "core/mathematics/pixel_grid.hpp"
#include "optics/instrument/instrument.hpp"
#include "optics/instrument/pixel_mapping.hpp"
#include "specimen/specimen.hpp"
#include "surface/height_map.hpp"

#include <optional>

namespace vkfv::measurement {

// The side of a pixel on the specimen (mm) by which the instrument places its heights: the assumed one, or else the
// true one.
double height_pitch(const optics::Instrument& instrument, const Configuration& configuration);

// The two maps stand on the regular grid of the measured heights: it has height_pitch(), and its middle is where the
// middle of the detector looks, in the specimen's frame.
struct KnownTruth {
    surface::HeightMap heights; // at the place that each pixel really sees
    // Heights at the points of the grid itself, without the mapping's distortion. The true dimensions of a standard are
    // found on this map; other specimens have none.
    std::optional<surface::HeightMap> undistorted;
    // The deviation of the places that the pixels see from the grid, before its middle was moved. The shift includes
    // the mean displacement of the specimen by its stage while the pixels are in focus, the amplification the mean
    // magnification then.
    optics::MappingDeviation mapping;
};

// The regular grid of an image of the configuration at this focal height (mm). It is the grid of KnownTruth, but with
// the stage where it is at this image.
PixelGrid grid_of_image(const optics::Instrument& instrument, const Configuration& configuration, double focal_height);

// The truth that the configuration's stack is compared with. Where a stage moves the specimen sideways, a pixel's place
// is the one that it sees when it is in focus.
KnownTruth truth_on_pixels(const optics::Instrument& instrument, const Configuration& configuration,
                           const specimen::Specimen& specimen);

} // namespace vkfv::measurement
