// PNG by libpng: implements functions of images/picture.hpp.
#include "core/messages/error.hpp"
#include "images/picture.hpp"

#include <fmt/format.h>
#include <png.h>
#include <zlib.h>

#include <csetjmp>
#include <cstdio>

namespace vkfv::images {
namespace {

struct PngTarget {
    std::string bytes{};
    char message[200] = "";
};

[[noreturn]] void keep_error(png_structp png, png_const_charp text) {
    (void)std::snprintf(static_cast<PngTarget*>(png_get_error_ptr(png))->message, sizeof(PngTarget::message), "%s",
                        text);
    png_longjmp(png, 1);
}

void append_bytes(png_structp png, png_bytep bytes, std::size_t count) {
    static_cast<PngTarget*>(png_get_io_ptr(png))->bytes.append(reinterpret_cast<const char*>(bytes), count);
}

struct Pixels {
    int columns;
    int rows;
    int channels; // 3: colour; 1: grey
    const std::uint8_t* values;
};

// libpng jumps back to this function when it fails, so no object between may need a destructor.
bool encode(png_structp png, png_infop info, PngTarget& target, const Pixels& pixels) {
    if (setjmp(png_jmpbuf(png)) != 0) {
        return false;
    }
    png_set_write_fn(png, &target, append_bytes, [](png_structp) {});
    png_set_IHDR(png, info, static_cast<png_uint_32>(pixels.columns), static_cast<png_uint_32>(pixels.rows), 8,
                 pixels.channels == 3 ? PNG_COLOR_TYPE_RGB : PNG_COLOR_TYPE_GRAY, PNG_INTERLACE_NONE,
                 PNG_COMPRESSION_TYPE_DEFAULT, PNG_FILTER_TYPE_DEFAULT);
    png_set_compression_strategy(png, Z_DEFAULT_STRATEGY); // as fast as libpng's own choice, and gives the known bytes
    // Constant chunks without meaning, kept for byte-identical files.
    png_set_oFFs(png, info, 0, 0, PNG_OFFSET_PIXEL);
    const png_time epoch{.year = 1970, .month = 1, .day = 1, .hour = 0, .minute = 0, .second = 0};
    png_set_tIME(png, info, &epoch);
    char key[] = "Software", name[] = "vkfv";
    png_text software{};
    software.compression = PNG_TEXT_COMPRESSION_NONE;
    software.key = key;
    software.text = name;
    png_set_text(png, info, &software, 1);
    png_write_info(png, info);
    const std::size_t row_bytes = static_cast<std::size_t>(pixels.channels) * static_cast<std::size_t>(pixels.columns);
    for (int row = 0; row < pixels.rows; ++row) {
        png_write_row(png, pixels.values + row_bytes * static_cast<std::size_t>(row));
    }
    png_write_end(png, info);
    return true;
}

std::string encoded(const Pixels& pixels) {
    PngTarget target;
    png_structp png =
        png_create_write_struct(PNG_LIBPNG_VER_STRING, &target, keep_error, [](png_structp, png_const_charp) {});
    png_infop info = png != nullptr ? png_create_info_struct(png) : nullptr;
    const bool good = info != nullptr && encode(png, info, target, pixels);
    png_destroy_write_struct(&png, &info);
    if (!good) {
        throw RunError(fmt::format("libpng cannot write PNG: {}", target.message));
    }
    return std::move(target.bytes);
}

} // namespace

std::string png_bytes(int columns, int rows, std::span<const std::uint8_t> rgb) {
    return encoded({.columns = columns, .rows = rows, .channels = 3, .values = rgb.data()});
}

std::string grey_png_bytes(int columns, int rows, std::span<const std::uint8_t> grey) {
    return encoded({.columns = columns, .rows = rows, .channels = 1, .values = grey.data()});
}

} // namespace vkfv::images
