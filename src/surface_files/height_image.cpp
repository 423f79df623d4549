#include "surface_files/height_image.hpp"

#include "core/mathematics/units.hpp"
#include "core/messages/error.hpp"
#include "images/exr_header.hpp"
#include "images/image_file.hpp"
#include "surface_files/image_scale.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <cmath>
#include <limits>

namespace vkfv::surface {
namespace {

// Of the text that height_map_bytes() begins an image's description with.
constexpr std::string_view height_image_title = "vkfv height map", last_grid_key = "pitch_y_mm=";

// The value of "key=value" on a line of its own.
double described_number(const std::filesystem::path& path, std::string_view description, std::string_view key) {
    const std::string label = fmt::format("\n{}=", key);
    const auto at = description.find(label);
    double value = 0;
    bool good = at != std::string_view::npos;
    if (good) {
        const char* begin = description.data() + at + label.size();
        const auto [end, error] = std::from_chars(begin, description.data() + description.size(), value);
        good = error == std::errc() && std::isfinite(value);
    }
    if (!good)
        refuse_file(path, std::string(key), "no such number in the ImageDescription", fmt::format("{}=<number>", key),
                    "Use a height map that vkfv wrote, or give a plain image with its pitch as a specimen.");
    return value;
}

// Of an image whose description is the one that height_map_bytes() wrote.
HeightMap height_map_of(const images::DescribedImage& image, const std::filesystem::path& path) {
    HeightMap map;
    map.x0 = described_number(path, image.description, "x0_mm");
    map.y0 = described_number(path, image.description, "y0_mm");
    map.pitch_x = described_number(path, image.description, "pitch_x_mm");
    map.pitch_y = described_number(path, image.description, "pitch_y_mm");
    if (map.pitch_x <= 0 || map.pitch_y <= 0)
        refuse_file(path, "pitch_x_mm, pitch_y_mm", fmt::format("{}, {}", map.pitch_x, map.pitch_y), "positive pitches",
                    "Use a height map that vkfv wrote.");
    map.height = Grid<double>(image.values.columns, image.values.rows);
    std::transform(image.values.values.begin(), image.values.values.end(), map.height.values.begin(),
                   [](double height) {
                       return std::isfinite(height) ? height * mm_per_um : std::numeric_limits<double>::quiet_NaN();
                   });
    return map;
}

} // namespace

std::string height_map_bytes(const HeightMap& map, const Provenance& provenance) {
    Grid<float> heights(map.columns(), map.rows());
    std::transform(map.height.values.begin(), map.height.values.end(), heights.values.begin(), [](double height) {
        return std::isfinite(height) ? static_cast<float>(height * um_per_mm) : std::numeric_limits<float>::quiet_NaN();
    });
    return images::tiff_bytes(
        heights, {.pitch_x = map.pitch_x,
                  .pitch_y = map.pitch_y,
                  .description = fmt::format("vkfv height map: heights in um, NaN is not measured, the first row has "
                                             "the highest y; x0 and y0 are of the last row's first pixel\n"
                                             "x0_mm={}\ny0_mm={}\npitch_x_mm={}\npitch_y_mm={}\n{}",
                                             map.x0, map.y0, map.pitch_x, map.pitch_y, provenance_text(provenance))});
}

bool looks_like_height_image(std::string_view bytes) {
    using namespace std::string_view_literals;
    const auto begins = [&](std::string_view magic) { return bytes.starts_with(magic); };
    return begins("II*\0"sv) || begins("MM\0*"sv) || begins("II+\0"sv) || begins("MM\0+"sv) ||
           images::looks_like_exr(bytes);
}

SurfaceFile parse_height_image(std::string_view bytes, const std::filesystem::path& path, const ImageScale& scale) {
    if (!looks_like_height_image(bytes))
        refuse_file(path, "", "a file of unknown kind", "a TIFF or OpenEXR file",
                    "Export the surface in one of these formats.");
    const images::DescribedImage image = images::parse_image(bytes, path);
    const std::string& description = image.description;
    if (description.starts_with(height_image_title)) {
        refuse_second_scale(path, scale);
        SurfaceFile result{.map = height_map_of(image, path), .provenance = {}};
        const auto grid = description.find(last_grid_key);
        const auto rest = std::min(description.find('\n', grid), description.size());
        result.provenance = parse_provenance(std::string_view(description).substr(rest));
        return result;
    }
    check_scale(path, scale);
    SurfaceFile result;
    result.map.pitch_x = result.map.pitch_y = *scale.pitch;
    result.map.height = Grid<double>(image.values.columns, image.values.rows);
    for (std::size_t k = 0; k < image.values.values.size(); ++k) {
        const double height = image.values.values[k] * *scale.unit;
        result.map.height.values[k] = std::isfinite(height) ? height : std::numeric_limits<double>::quiet_NaN();
    }
    return result;
}

} // namespace vkfv::surface
