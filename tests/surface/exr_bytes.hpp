// OpenEXR files byte by byte, after the file layout that openexr.com documents (version 2): uncompressed, one float32
// channel, little-endian. Attributes are name NUL type NUL size value; a header ends with a NUL.
#pragma once

#include <algorithm>
#include <bit>
#include <cstdint>
#include <string>
#include <vector>

namespace vkfv::test {

struct ExrBytes {
    int columns = 3, rows = 2;
    std::vector<float> values = {1, 2, 3, 4, 5, 6}; // first row on top
    // The header's statements; the pixels stay those of columns x rows.
    std::vector<std::int32_t> window = {0, 0, 2, 1}; // least and greatest x and y
    std::uint32_t tile = 0;                          // columns and rows of a tile; 0: scan lines
    int parts = 1;                                   // further ones hold zeros
    std::int32_t chunks = -1;                        // said of every part; -1: the true number
    std::string channel = "Y";
    std::string description = {};

    std::string bytes() const;

  private:
    std::string header(int part) const;
    std::vector<std::string> chunk_bodies(int part) const; // coordinates, size and pixels
};

inline std::string little_endian(std::uint64_t value, int bytes) {
    std::string result;
    for (int k = 0; k < bytes; ++k)
        result += static_cast<char>(value >> (8 * k));
    return result;
}

inline std::string int32(std::int64_t value) {
    return little_endian(static_cast<std::uint64_t>(value), 4);
}

inline std::string float32(float value) {
    return int32(std::bit_cast<std::int32_t>(value));
}

inline std::string ExrBytes::header(int part) const {
    std::string result;
    const auto attribute = [&](const char* name, const char* type, const std::string& value) {
        result += std::string(name) + '\0' + type + '\0' + int32(static_cast<std::int64_t>(value.size())) + value;
    };
    std::string box;
    for (const std::int32_t side : window)
        box += int32(side);
    // A channel is of type 2, float32; then follow linearity and three reserved bytes, and sampling in x and y.
    const std::string described = channel + '\0' + int32(2) + int32(0) + int32(1) + int32(1);
    attribute("channels", "chlist", described + '\0');
    attribute("compression", "compression", std::string(1, '\0'));
    attribute("dataWindow", "box2i", box);
    attribute("displayWindow", "box2i", box);
    attribute("lineOrder", "lineOrder", std::string(1, '\0'));
    attribute("pixelAspectRatio", "float", float32(1));
    attribute("screenWindowCenter", "v2f", float32(0) + float32(0));
    attribute("screenWindowWidth", "float", float32(1));
    if (!description.empty())
        attribute("comments", "string", description);
    if (tile > 0)
        attribute("tiles", "tiledesc", int32(tile) + int32(tile) + std::string(1, '\0')); // of one level
    if (parts > 1) {
        const auto count = chunks >= 0 ? chunks : static_cast<std::int32_t>(chunk_bodies(part).size());
        attribute("name", "string", "part" + std::to_string(part));
        attribute("type", "string", tile > 0 ? "tiledimage" : "scanlineimage");
        attribute("chunkCount", "int", int32(count));
    }
    return result + '\0';
}

inline std::vector<std::string> ExrBytes::chunk_bodies(int part) const {
    const auto block = [&](int left, int top, int right, int bottom) {
        std::string pixels;
        for (int row = top; row < bottom; ++row)
            for (int column = left; column < right; ++column)
                pixels += float32(part == 0 ? values[static_cast<std::size_t>(row * columns + column)] : 0.0f);
        return int32(static_cast<std::int64_t>(pixels.size())) + pixels;
    };
    std::vector<std::string> bodies;
    const int size = static_cast<int>(std::min(tile, 1024u)); // no image of ours is larger
    if (tile == 0)
        for (int row = 0; row < rows; ++row)
            bodies.push_back(int32(window[1] + row) + block(0, row, columns, row + 1));
    else
        for (int top = 0; top < rows; top += size)
            for (int left = 0; left < columns; left += size)
                bodies.push_back(int32(left / size) + int32(top / size) + int32(0) + int32(0) +
                                 block(left, top, std::min(left + size, columns), std::min(top + size, rows)));
    return bodies;
}

inline std::string ExrBytes::bytes() const {
    const bool many = parts > 1;
    // Flags beside the version: 0x200 one part of tiles, 0x1000 several parts.
    std::string result = int32(20000630) + int32(2 | (many ? 0x1000 : tile > 0 ? 0x200 : 0));
    std::vector<std::string> chunk_list;
    for (int part = 0; part < parts; ++part) {
        result += header(part);
        for (const std::string& body : chunk_bodies(part))
            chunk_list.push_back((many ? int32(part) : "") + body);
    }
    if (many)
        result += '\0';
    std::size_t offset = result.size() + 8 * chunk_list.size();
    for (const std::string& chunk : chunk_list) {
        result += little_endian(offset, 8);
        offset += chunk.size();
    }
    for (const std::string& chunk : chunk_list)
        result += chunk;
    return result;
}

} // namespace vkfv::test
