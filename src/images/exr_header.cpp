#include "images/exr_header.hpp"

#include "core/parsing/byte_reader.hpp"

#include <fmt/format.h>

namespace vkfv::images {
namespace {

constexpr std::string_view magic = "\x76\x2f\x31\x01";
constexpr std::uint64_t first_attribute = 8;    // offset behind the magic number and the version
constexpr std::uint32_t several_parts = 0x1000; // flag in the version field
// The library allocates whole tiles when it opens a file; tiles in use have sides of tens to hundreds of pixels.
constexpr std::uint64_t most_pixels_of_a_tile = std::uint64_t{1} << 24;

} // namespace

bool looks_like_exr(std::string_view bytes) {
    return bytes.starts_with(magic);
}

// By "OpenEXR File Layout" an attribute consists of name, type, both ended by a zero, length and value; a zero ends a
// header, and in a file of several parts another one ends the headers.
void check_exr_attributes(std::string_view bytes, const std::filesystem::path& path) {
    const ByteReader file(bytes, path);
    const bool parts = (file.at<std::uint32_t>(magic.size(), "version") & several_parts) != 0;
    std::uint64_t place = first_attribute;
    const auto text = [&] {
        const auto end = bytes.find('\0', place);
        if (end == std::string_view::npos)
            file.fail(place, "header", "no end", "attributes and a zero behind them");
        const auto found = bytes.substr(place, end - place);
        place = end + 1;
        return found;
    };
    for (bool after_header = false;;) {
        const std::string_view name = text();
        if (name.empty()) {
            if (!parts || after_header)
                return;
            after_header = true;
            continue;
        }
        after_header = false;
        const std::string_view type = text();
        const auto length = file.at<std::int32_t>(place, "length of an attribute");
        place += sizeof length;
        if (length < 0 || static_cast<std::uint64_t>(length) > bytes.size() - place)
            file.fail(place - sizeof length, "length of an attribute", fmt::format("{}", length),
                      fmt::format("at most the {} bytes that are left", bytes.size() - place));
        if (type == "tiledesc" && length >= 8) {
            const auto columns = file.at<std::uint32_t>(place, "columns of a tile");
            const auto rows = file.at<std::uint32_t>(place + sizeof columns, "rows of a tile");
            if (std::uint64_t{columns} * rows > most_pixels_of_a_tile)
                file.fail(place, "size of a tile", fmt::format("{} x {} pixels", columns, rows),
                          fmt::format("at most {} pixels", most_pixels_of_a_tile));
        }
        place += static_cast<std::uint64_t>(length);
    }
}

} // namespace vkfv::images
