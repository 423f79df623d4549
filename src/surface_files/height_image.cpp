#include "surface_files/height_image.hpp"

#include "core/mathematics/units.hpp"
#include "core/messages/error.hpp"
#include "core/parsing/byte_reader.hpp"
#include "core/parsing/length_unit.hpp"
#include "images/exr_header.hpp"
#include "images/image_file.hpp"
#include "images/tiff.hpp"
#include "surface_files/image_scale.hpp"
#include "surface_files/lengths.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <cmath>
#include <limits>
#include <optional>
#include <string_view>

namespace vkfv::surface {
namespace {

// The first and the last key of the text with which height_map_bytes() begins an image's description.
constexpr std::string_view height_image_title = "vkfv height map", last_grid_key = "pitch_y_mm=";

// The value of a line "key=value".
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

// The height map of an image whose description height_map_bytes() wrote.
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

// The scale stated in ImageJ's description of a height map: lengths in mm, and heights as offset + gain * value.
struct Calibration {
    std::optional<double> pitch_x{}, pitch_y{}, unit{};
    double offset = 0, gain = 1;
};

Calibration calibration_of(const images::DescribedImage& image, const std::filesystem::path& path) {
    Calibration result;
    if (!image.description.starts_with("ImageJ="))
        return result;
    const auto value_of = [&](std::string_view key) -> std::string_view {
        const std::string_view text = image.description;
        const auto at = text.find(fmt::format("\n{}=", key));
        if (at == std::string_view::npos)
            return {};
        const std::string_view rest = text.substr(at + key.size() + 2);
        const std::string_view value = rest.substr(0, rest.find('\n'));
        return value.ends_with('\r') ? value.substr(0, value.size() - 1) : value;
    };
    const auto along_x = mm_per_length_unit(value_of("unit"));
    const auto along_y = value_of("yunit").empty() ? along_x : mm_per_length_unit(value_of("yunit"));
    if (along_x && along_y && image.columns_per_unit > 0 && image.rows_per_unit > 0) {
        result.pitch_x = *along_x / image.columns_per_unit;
        result.pitch_y = *along_y / image.rows_per_unit;
    }
    // Calibrated values have a unit of their own; others are lengths in that of the plane.
    result.unit = value_of("vunit").empty() ? along_x : mm_per_length_unit(value_of("vunit"));
    if (const std::string_view function = value_of("cf"); !function.empty()) {
        constexpr std::string_view straight_line = "0", none = "20";
        if (function == straight_line) {
            result.offset = number_in<double>(value_of("c0")).value_or(0);
            result.gain = number_in<double>(value_of("c1")).value_or(1);
        } else if (function != none) {
            refuse_file(path, "cf", std::string(function),
                        "values that are calibrated by a straight line, or not at all",
                        "Convert the image to 32 bits in ImageJ: that keeps calibrated values.");
        }
    }
    return result;
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
    SurfaceFile result;
    const Calibration stated = calibration_of(image, path);
    const ImageScale whole{.pitch = scale.pitch ? scale.pitch : stated.pitch_x,
                           .unit = scale.unit ? scale.unit : stated.unit};
    check_scale(path, whole);
    const auto warn = [&](const char* what, const std::optional<double>& given, const std::optional<double>& own) {
        if (given && own && contradicts(*given, *own))
            result.warnings.push_back(
                fmt::format("{}: the {} of {:.6g} um of the option is used, not the {:.6g} um that the "
                            "file states",
                            path.string(), what, *given * um_per_mm, *own * um_per_mm));
    };
    warn("pitch", scale.pitch, stated.pitch_x);
    warn("unit", scale.unit, stated.unit);
    result.map.pitch_x = *whole.pitch;
    result.map.pitch_y = scale.pitch ? *scale.pitch : stated.pitch_y.value_or(*whole.pitch);
    constexpr std::uint32_t gdal_nodata = 42113;
    const auto mark = number_in<double>(images::tiff_text(bytes, gdal_nodata));
    result.map.height = Grid<double>(image.values.columns, image.values.rows);
    for (std::size_t k = 0; k < image.values.values.size(); ++k) {
        const double value = image.values.values[k];
        const double height = (stated.offset + stated.gain * value) * *whole.unit;
        const bool measured = std::abs(height) < no_height_from && std::abs(value) < not_measured_from &&
                              !(mark && is_mark(value, *mark));
        result.map.height.values[k] = measured ? height : std::numeric_limits<double>::quiet_NaN();
    }
    return result;
}

} // namespace vkfv::surface
