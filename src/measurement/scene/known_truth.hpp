// The true surface where the pixels look.
#pragma once

#include "configuration/configuration.hpp"
#include "core/mathematics/pixel_grid.hpp"
#include "optics/instrument/instrument.hpp"
#include "optics/instrument/pixel_mapping.hpp"
#include "specimen/specimen.hpp"
#include "surface/height_map.hpp"

#include <optional>

namespace vkfv::measurement {

// Both maps stand on the regular grid that measured heights are told on: the nominal pitch, its middle where the middle
// of the detector looks, in the specimen's frame.
struct KnownTruth {
    surface::HeightMap heights; // of each pixel where it looks
    // At the grid's own points, which no mapping has distorted: what the true dimensions of a standard are found on.
    // None of other specimens.
    std::optional<surface::HeightMap> undistorted;
    // How far the pixels look from the grid before its middle was moved. The shift holds the mean displacement of the
    // specimen by its stage while the pixels are in focus.
    optics::MappingDeviation mapping;
};

// The regular grid of an image of the configuration at this focal height (mm): as that of KnownTruth, but with the
// stage where it is at this image.
PixelGrid grid_of_image(const optics::Instrument& instrument, const Configuration& configuration, double focal_height);

// The truth that the configuration's stack is compared with. Where a stage moves the specimen sideways, a pixel's place
// is the one that the pixel sees at the moment when it is in focus.
KnownTruth truth_on_pixels(const optics::Instrument& instrument, const Configuration& configuration,
                           const specimen::Specimen& specimen);

} // namespace vkfv::measurement
