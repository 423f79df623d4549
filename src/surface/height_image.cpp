#include "surface/height_image.hpp"

#include "core/error.hpp"
#include "surface/exr_header.hpp"
#include "surface/image_file.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>

namespace vkfv::surface {
namespace {

// Of the text that height_map_bytes() begins an image's description with.
constexpr std::string_view own_title = "vkfv height map", last_grid_key = "pitch_y_mm=";

std::optional<ImageFormat> format_of(std::string_view bytes) {
    using namespace std::string_view_literals;
    for (const std::string_view magic : {"II*\0"sv, "MM\0*"sv, "II+\0"sv, "MM\0+"sv})
        if (bytes.starts_with(magic))
            return ImageFormat::tiff;
    if (looks_like_exr(bytes))
        return ImageFormat::openexr;
    return std::nullopt;
}

} // namespace

bool looks_like_height_image(std::string_view bytes) {
    return format_of(bytes).has_value();
}

SurfaceFile parse_height_image(std::string_view bytes, const std::filesystem::path& path, const ImageScale& scale) {
    const auto reject = [&](std::string key, std::string found, std::string expected, std::string remedy) {
        throw InputError({{path, 0, 0, {}}, std::move(key), std::move(found), std::move(expected), std::move(remedy)});
    };
    const std::optional<ImageFormat> format = format_of(bytes);
    if (!format)
        reject("", "a file of unknown kind", "a TIFF or OpenEXR file", "Export the surface in one of these formats.");
    const DescribedImage image = parse_image(bytes, *format, path);
    const std::string& description = image.description;
    if (description.starts_with(own_title)) {
        if (scale.pitch || scale.unit)
            reject(scale.pitch ? "pitch" : "unit", "given", "no second scale: the file states its own",
                   "Leave it out.");
        SurfaceFile result{.map = height_map_of(image, path), .provenance = {}};
        const auto grid = description.find(last_grid_key);
        const auto rest = std::min(description.find('\n', grid), description.size());
        result.provenance = parse_provenance(std::string_view(description).substr(rest));
        return result;
    }
    const auto check = [&](const char* key, const std::optional<double>& value) {
        if (!value || !(std::isfinite(*value) && *value > 0))
            reject(key, value ? fmt::format("{}", *value) : "not given",
                   "a positive length, which an image does not state",
                   fmt::format(
                       "Give the {} that belongs to this image; vkfv --surface IMAGE --pitch_um P --unit_um U --out "
                       "NAME.x3p writes a file that states its own.",
                       key));
    };
    check("pitch", scale.pitch);
    check("unit", scale.unit);
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
