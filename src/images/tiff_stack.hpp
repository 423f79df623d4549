// A stack of images as one TIFF, calibrated as ImageJ writes it: all directories, then all values as one block, which
// is how ImageJ reads a stack; each page is a TIFF image of its own for other readers. libtiff writes a page's
// directory before its values, so it cannot make this.
#pragma once

#include "core/mathematics/grid.hpp"

#include <cstdint>
#include <span>
#include <string>
#include <vector>

namespace vkfv::images {

enum class PixelBits { float32, uint16, uint8 };

struct TiffStack {
    int columns = 0;
    int rows = 0;
    PixelBits bits = PixelBits::float32;
    double pitch = 0;                 // of columns and rows, um
    double first = 0;                 // height of the first image, um
    double step = 0;                  // from one image to the next, um; 0: there is one image
    std::string notes{};              // lines of the first ImageDescription, below those of ImageJ: ASCII
    std::vector<std::string> pages{}; // of each image: its label in ImageJ, and the others' ImageDescription; ASCII
};

// All that stands before the values. They follow: image after image, the first row with the highest y, each value in
// the machine's order of bytes, which the file states. Beyond 4 GB of all the file is a BigTIFF, which tifffile and
// Bio-Formats read, and ImageJ alone does not.
std::string tiff_stack_head(const TiffStack& stack);

// Values of one image in that order.
template <class Value>
std::string tiff_stack_values(const Grid<Value>& image) {
    std::string bytes;
    bytes.reserve(image.values.size() * sizeof(Value));
    for (int row = image.rows - 1; row >= 0; --row) {
        const auto values =
            std::as_bytes(std::span(image.values))
                .subspan(image.index(0, row) * sizeof(Value), static_cast<std::size_t>(image.columns) * sizeof(Value));
        bytes.append(reinterpret_cast<const char*>(values.data()), values.size());
    }
    return bytes;
}

} // namespace vkfv::images
