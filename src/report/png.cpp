#include "report/png.hpp"

#include "images/picture.hpp"

#include <cstdint>
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
    return images::png_bytes(pixels.columns, pixels.rows, values);
}

std::string grey_png_bytes(const Grid<std::uint8_t>& pixels) {
    std::vector<std::uint8_t> values;
    values.reserve(pixels.values.size());
    for (int row = pixels.rows - 1; row >= 0; --row) {
        const auto begin = pixels.values.begin() + static_cast<std::ptrdiff_t>(pixels.index(0, row));
        values.insert(values.end(), begin, begin + pixels.columns);
    }
    return images::grey_png_bytes(pixels.columns, pixels.rows, values);
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
