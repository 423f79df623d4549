// Sizes of the planes of complex floats that a device transforms for the wave image.
#pragma once

#include "core/mathematics/pixel_grid.hpp"

#include <algorithm>
#include <cstddef>
#include <cstdint>

namespace vkfv::trace {

class WavePlanes {
  public:
    static constexpr std::uint64_t a_group = 2; // planes of a group of four cells that are mirror images

    // cells: across the pupil; image: size of a window, in parts of pixels; filters: number blended in a window;
    // binding: most bytes of a buffer that a kernel can reach. The planes that are transformed at once fit in it if two
    // planes do.
    WavePlanes(int cells, ImageSize image, int filters, std::uint64_t binding)
        : plane_(image.count() * complex_bytes), filters_(static_cast<std::uint64_t>(filters)) {
        groups_ = static_cast<std::uint32_t>(cells / 2) * static_cast<std::uint32_t>(cells / 2);
        // A larger number is no quicker on an H100, and a driver takes a tenth of a second to give gigabytes back.
        constexpr std::uint64_t most_bytes = std::uint64_t{1} << 28;
        const std::uint64_t most = std::max<std::uint64_t>(1, std::min(most_bytes, binding) / (a_group * plane_));
        at_once_ = static_cast<std::uint32_t>(std::min<std::uint64_t>(most, groups_));
        // The groups are divided evenly, since the transform is made for one number of planes.
        while (groups_ % at_once_ != 0) {
            --at_once_;
        }
    }

    std::uint32_t groups() const { return groups_; }
    std::uint32_t groups_at_once() const { return at_once_; }
    int planes_at_once() const { return static_cast<int>(a_group * at_once_); }

    std::size_t plane_bytes() const { return a_group * at_once_ * plane_; } // planes of the groups transformed at once
    std::size_t spectrum_bytes() const { return filters_ * 2 * plane_; }    // half of the image's spectrum
    // Planes of the filters' images: two real images are the real and the imaginary part of one.
    int image_planes() const { return static_cast<int>((filters_ + 1) / 2); }
    std::size_t image_bytes() const { return (filters_ + 1) / 2 * 4 * plane_; } // image with its mirror images
    std::size_t largest_bytes() const { return std::max(plane_bytes(), image_bytes()); }

  private:
    static constexpr std::uint64_t complex_bytes = 2 * sizeof(float);

    std::uint64_t plane_;
    std::uint64_t filters_;
    std::uint32_t groups_ = 0;
    std::uint32_t at_once_ = 0;
};

} // namespace vkfv::trace
