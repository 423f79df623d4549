#include "surface_files/al3d.hpp"

#include "core/parsing/byte_reader.hpp"
#include "surface/metres.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <map>

namespace vkfv::surface {
namespace {

constexpr std::string_view al3d_magic("AliconaImaging\0\r\n", 17);
constexpr std::size_t key_length = 20, value_length = 30, tag_length = 52;
constexpr std::uint64_t row_alignment = 8;
constexpr std::array images_behind = {"TextureImageOffset", "IconOffset"}; // offsets of images behind the depths
constexpr std::size_t least_tags = 2;                                      // tags Version and TagCount

class Tags {
  public:
    explicit Tags(const ByteReader& file) : file_(file) {
        std::uint64_t count = least_tags;
        for (std::uint64_t k = 0; k < count; ++k) {
            const auto line = file.bytes(al3d_magic.size() + tag_length * k, tag_length, "tag");
            const std::string key = text_in(line.substr(0, key_length));
            values_[key] = text_in(line.substr(key_length, value_length));
            if (key == "TagCount")
                count = least_tags + number<std::uint32_t>("TagCount");
        }
    }
    template <class Value>
    Value number(const char* key) const {
        const auto tag = values_.find(key);
        const auto value = tag == values_.end() ? std::nullopt : number_in<Value>(tag->second);
        if (!value)
            file_.fail({}, key, tag == values_.end() ? "no such tag" : tag->second, "a number");
        return *value;
    }
    std::string text(const char* key) const {
        const auto tag = values_.find(key);
        return tag == values_.end() ? std::string() : tag->second;
    }

  private:
    static std::string text_in(std::string_view field) { return plain_line(field.substr(0, field.find('\0'))); }

    const ByteReader& file_;
    std::map<std::string, std::string> values_;
};

// The number of bytes from row to row. Rows are padded, except in files of some writers, in which padded rows would not
// fit.
std::uint64_t stride_of(const Tags& tags, std::uint64_t offset, std::uint64_t columns, std::uint64_t rows,
                        std::uint64_t end) {
    for (const char* image : images_behind)
        if (const auto begin = number_in<std::uint64_t>(tags.text(image)); begin && *begin > offset)
            end = std::min(end, *begin);
    const std::uint64_t row = columns * sizeof(float);
    const std::uint64_t padded = (row + row_alignment - 1) / row_alignment * row_alignment;
    return offset <= end && padded * (rows - 1) + row > end - offset ? row : padded;
}

} // namespace

bool looks_like_al3d(std::string_view bytes) {
    return bytes.starts_with(al3d_magic);
}

SurfaceFile parse_al3d(std::string_view bytes, const std::filesystem::path& path) {
    const ByteReader file(bytes, path);
    const Tags tags(file);
    const auto columns = tags.number<std::uint64_t>("Cols"), rows = tags.number<std::uint64_t>("Rows");
    file.check_size(columns, rows);
    const double pitch_x = mm_from_metres(tags.number<double>("PixelSizeXMeter"));
    const double pitch_y = mm_from_metres(tags.number<double>("PixelSizeYMeter"));
    file.check_spacing(pitch_x, "PixelSizeXMeter");
    file.check_spacing(pitch_y, "PixelSizeYMeter");
    const auto offset = tags.number<std::uint64_t>("DepthImageOffset");
    const std::uint64_t stride = stride_of(tags, offset, columns, rows, bytes.size());
    // The last row may lack its padding.
    const auto depth = file.bytes(offset, stride * (rows - 1) + columns * sizeof(float), "DepthImageOffset");
    const auto gap = number_in<float>(tags.text("InvalidPixelValue"));

    SurfaceFile result;
    result.map.pitch_x = pitch_x;
    result.map.pitch_y = pitch_y;
    result.map.height = Grid<double>(static_cast<int>(columns), static_cast<int>(rows));
    for (std::uint64_t row = 0; row < rows; ++row) {
        const auto values = depth.substr(row * stride, columns * sizeof(float));
        for (std::uint64_t column = 0; column < columns; ++column) {
            const float metres = element<float>(values, column);
            // The mark's text is rounded; heights beyond those of any surface are gaps too.
            const bool measured =
                std::abs(metres) < 1e30f && !(gap && std::abs(metres - *gap) <= 1e-6f * std::abs(*gap));
            result.map.height(static_cast<int>(column), static_cast<int>(rows - 1 - row)) =
                measured ? height_from_metres(static_cast<double>(metres)) : std::numeric_limits<double>::quiet_NaN();
        }
    }
    result.provenance.manufacturer = "Alicona";
    result.provenance.creator = tags.text("Creator");
    result.provenance.comment = tags.text("Comment");
    return result;
}

} // namespace vkfv::surface
