#include "report/png.hpp"

#include "core/error.hpp"

#include <OpenImageIO/filesystem.h>
#include <OpenImageIO/imageio.h>

#include <cstdint>
#include <memory>
#include <vector>

namespace vkfv::report {

std::string png_bytes(const Grid<Rgb>& pixels) {
    std::vector<std::uint8_t> values;
    values.reserve(pixels.values.size() * 3);
    for (int row = pixels.rows - 1; row >= 0; --row)
        for (int column = 0; column < pixels.columns; ++column) {
            const Rgb& pixel = pixels(column, row);
            values.insert(values.end(), {pixel.red, pixel.green, pixel.blue});
        }
    std::vector<unsigned char> bytes;
    OIIO::Filesystem::IOVecOutput destination(bytes);
    const auto output = OIIO::ImageOutput::create("png");
    OIIO::ImageSpec spec(pixels.columns, pixels.rows, 3, OIIO::TypeDesc::UINT8);
    // Without these OpenImageIO writes its version and the time of day.
    spec.attribute("Software", "vkfv");
    spec.attribute("DateTime", "1970:01:01 00:00:00");
    if (!output || !output->set_ioproxy(&destination) || !output->open("picture.png", spec) ||
        !output->write_image(OIIO::TypeDesc::UINT8, values.data()) || !output->close())
        throw RunError("OpenImageIO cannot write PNG: " + (output ? output->geterror() : OIIO::geterror()));
    return {bytes.begin(), bytes.end()};
}

std::string base64(const std::string& bytes) {
    constexpr const char* digits = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
    std::string text;
    text.reserve((bytes.size() + 2) / 3 * 4);
    for (std::size_t k = 0; k < bytes.size(); k += 3) {
        std::uint32_t word = 0;
        for (std::size_t i = 0; i < 3; ++i)
            word = (word << 8) | (k + i < bytes.size() ? static_cast<unsigned char>(bytes[k + i]) : 0u);
        for (std::size_t i = 0; i < 4; ++i)
            text += k + i <= bytes.size() ? digits[(word >> (18 - 6 * i)) & 63] : '=';
    }
    return text;
}

} // namespace vkfv::report
