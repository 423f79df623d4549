// Letters as pixels: implements functions of images/picture.hpp.
#include "core/messages/error.hpp"
#include "images/openimageio/functions.hpp"

#include <OpenImageIO/imagebuf.h>
#include <OpenImageIO/imagebufalgo.h>
#include <OpenImageIO/imageio.h>

namespace vkfv::images::openimageio {

Ink ink_of(const std::string& letter, int size, const std::string& font) {
    const auto ink = OIIO::ImageBufAlgo::text_size(letter, size, font);
    if (!ink.defined() || ink.width() < 1) {
        return {.reason = OIIO::geterror()};
    }
    return {.left = ink.xbegin, .right = ink.xend, .top = ink.ybegin, .bottom = ink.yend};
}

Grid<float> drawn(const DrawnLetter& letter, int columns, int rows) {
    OIIO::ImageBuf mask(OIIO::ImageSpec(columns, rows, 1, OIIO::TypeDesc::FLOAT));
    OIIO::ImageBufAlgo::zero(mask);
    const float white = 1;
    if (!OIIO::ImageBufAlgo::render_text(mask, letter.x, letter.baseline, letter.letter, letter.size, letter.font,
                                         OIIO::cspan<float>(&white, 1))) {
        throw RunError(mask.geterror());
    }
    Grid<float> result(columns, rows);
    for (int row = 0; row < rows; ++row) {
        for (int column = 0; column < columns; ++column) {
            result(column, row) = mask.getchannel(column, rows - 1 - row, 0, 0);
        }
    }
    return result;
}

} // namespace vkfv::images::openimageio
