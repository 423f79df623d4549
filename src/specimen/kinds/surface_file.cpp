#include "specimen/kinds/surface_file.hpp"

#include "core/mathematics/pixel_grid.hpp"
#include "specimen/file_keys.hpp"
#include "specimen/lengths.hpp"
#include "surface/fill.hpp"
#include "surface/filter.hpp"
#include "surface_files/surface_file.hpp"

#include <fmt/format.h>
#include <spdlog/spdlog.h>

#include <algorithm>
#include <cmath>

namespace vkfv::specimen {
namespace {

const FileKey surface_key =
    needed_file_key("The surface: any file that `vkfv surface` reads: X3P, SUR, SDF, GWY, a TIFF "
                    "or OpenEXR image of heights and others.");
const NumberKey surface_pitch_key("pitch_um", NumberRange::positive(), Default::in_words("the file's own"),
                                  "Distance of the pixels of an image that has no scale of its own.");
const NumberKey size_key("size_mm", NumberRange::positive(), Default::in_words("all of the file"),
                         "Side of the square around the centre that is taken.");
const BooleanKey level_key("level", true, "Whether the least-squares plane is removed and the mean height 0.");
const ChoiceKey<double> value_unit_key = [] {
    auto key = unit_key(needed, "Of the values of an image that has no scale of its own.");
    key.fallback = Default::in_words("the file's own");
    return key;
}();

// The part of a map around its centre that fits into `size` (mm).
surface::HeightMap cropped(const surface::HeightMap& map, double size, const SourceLocation& mention) {
    const auto points = [size](double pitch) { return static_cast<int>(std::floor(size / pitch * (1 + 1e-9))) + 1; };
    const double width = (map.columns() - 1) * map.pitch_x, height = (map.rows() - 1) * map.pitch_y;
    const double largest = std::min(width, height);
    if (!(size <= largest * (1 + 1e-9))) {
        throw InputError({mention, "specimen.size_mm", fmt::format("{}", size),
                          fmt::format("at most {:.6g}: the surface is {:.6g} x {:.6g} mm", largest, width, height),
                          "Choose a smaller size, or leave it out for the whole surface."});
    }
    surface::HeightMap part = map;
    const int columns = std::min(points(map.pitch_x), map.columns()), rows = std::min(points(map.pitch_y), map.rows());
    part.height = Grid<double>(columns, rows);
    const int first_column = (map.columns() - columns) / 2, first_row = (map.rows() - rows) / 2;
    for (int row = 0; row < rows; ++row) {
        for (int column = 0; column < columns; ++column) {
            part.height(column, row) = map.height(first_column + column, first_row + row);
        }
    }
    return part;
}

} // namespace

std::vector<const Key*> SurfaceFile::keys() {
    return {&surface_key, &surface_pitch_key, &size_key, &level_key, &value_unit_key};
}

SurfaceFile SurfaceFile::read(const Section& section) {
    SurfaceFile surface;
    surface.pitch = from_um(section.number_if_given(surface_pitch_key).value_or(0));
    surface.size = section.number_if_given(size_key).value_or(0);
    surface.level = section.boolean(level_key);
    surface.file = section.file(surface_key);
    if (section.has(value_unit_key)) {
        surface.unit = section.choice(value_unit_key);
    }
    return surface;
}

HeightField SurfaceFile::heights(const SourceLocation& mention) const {
    const auto given = [](double value) { return value > 0 ? std::optional(value) : std::nullopt; };
    surface::HeightMap map = surface::read_surface(file, {.pitch = given(pitch), .unit = given(unit)}).map;
    if (size > 0) {
        map = cropped(map, size, mention);
    }
    const auto gaps = std::ranges::count_if(map.height.values, [](double z) { return !std::isfinite(z); });
    const auto points = std::ssize(map.height.values);
    if (map.columns() < 2 || map.rows() < 2 || gaps == points) {
        throw InputError({{file, 0, 0, {}},
                          "surface",
                          fmt::format("{} x {} points, {} of them measured", map.columns(), map.rows(), points - gaps),
                          "at least 2 x 2 points, not all of them gaps",
                          "Name another file or choose a larger size."});
    }
    if (level) {
        map = remove_plane(map, surface::least_squares_plane(map));
    }
    HeightField field;
    field.pitch_x = map.pitch_x;
    field.pitch_y = map.pitch_y;
    const auto grid = PixelGrid::centred(map.columns(), map.rows(), map.pitch_x, map.pitch_y);
    field.x_min = grid.x0;
    field.y_min = grid.y0;
    if (gaps > 0) {
        for (const double z : map.height.values) {
            field.interpolated.push_back(!std::isfinite(z));
        }
        map = fill_not_measured(std::move(map));
    }
    field.heights = Grid<float>(map.columns(), map.rows());
    std::ranges::transform(map.height.values, field.heights.values.begin(),
                           [](double z) { return static_cast<float>(z); });
    spdlog::info("{}: {} x {} points, pitch {:.6g} x {:.6g} um; {:.3g} % not measured and interpolated", file.string(),
                 map.columns(), map.rows(), map.pitch_x * um_per_mm, map.pitch_y * um_per_mm,
                 100.0 * static_cast<double>(gaps) / static_cast<double>(points));
    return field;
}

} // namespace vkfv::specimen
