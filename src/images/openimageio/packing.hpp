// Decides whether an image of the size stated in a header fits into its file.
#pragma once

#include <OpenImageIO/imageio.h>

#include <algorithm>
#include <cmath>

namespace vkfv::images::openimageio {

// False if the header claims more than any compression in use can achieve. Tiles count whole, as they are read whole;
// small images may have one large tile.
inline bool packing_is_possible(const OIIO::ImageSpec& spec, double file_bytes) {
    constexpr double impossible_packing = 1e4;
    constexpr double freely_given_tile = 1 << 24;
    const double pixel_bytes = spec.nchannels * static_cast<double>(spec.format.size());
    const auto whole = [](int size, int tile) {
        return tile > 0 ? std::ceil(static_cast<double>(size) / tile) * tile : size;
    };
    const double tiles = whole(spec.width, spec.tile_width) * whole(spec.height, spec.tile_height) * pixel_bytes;
    const double pixels = static_cast<double>(spec.width) * spec.height * pixel_bytes;
    return pixels <= impossible_packing * file_bytes &&
           tiles <= std::max(freely_given_tile, impossible_packing * file_bytes);
}

} // namespace vkfv::images::openimageio
