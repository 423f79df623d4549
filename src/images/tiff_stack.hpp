// Writes a stack of images as one TIFF with ImageJ's calibration: first all directories, then all values as one block,
// as ImageJ reads stacks; for other readers each page is a TIFF image of its own. libtiff cannot write it, as it writes
// a page's directory before its values.
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
    double pitch = 0;    // um, of columns and rows
    double first = 0;    // um, height of the first image
    double step = 0;     // um, from one image to the next; 0: a single image
    std::string notes{}; // lines below ImageJ's in the first ImageDescription, ASCII
    // For each image its label in ImageJ, and the ImageDescription of all but the first; ASCII.
    std::vector<std::string> pages{};
};

// The bytes before the values. The values follow image by image, the first row with the highest y, in the machine's
// byte order, which the file states. A file above 4 GB is a BigTIFF, which tifffile and Bio-Formats read, but ImageJ
// alone does not.
std::string tiff_stack_head(const TiffStack& stack);

// The values of one image in this order.
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
