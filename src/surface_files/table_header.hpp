// The statements that the lines above a table of numbers make about it: units, pitches, the mark of points that were
// not measured.
#pragma once

#include <array>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace vkfv::surface {

// Lengths in mm; nothing where the header does not say it.
struct TableHeader {
    std::optional<double> unit;             // of heights
    std::optional<double> pitch_x, pitch_y; // between points
    std::optional<double> cells;            // the same, in the unit of the heights (ESRI's grids)
    std::optional<double> width, height;    // of the whole grid
    // SPIP states the extents of the whole grid as numbers, whose unit is that of their axis, else of the heights.
    std::optional<double> x_length, y_length;
    std::optional<double> x_unit, y_unit; // mm
    std::optional<double> x0, y0;         // of the point with the lowest x and y
    // The place of that point, or of the corner of its cell, in the unit of the heights, as ESRI's grids state it.
    std::optional<double> x_centre, y_centre, x_corner, y_corner;
    std::optional<double> not_measured;                  // the value that says so
    std::array<std::optional<double>, 3> column_units{}; // of the first three columns, from a line of their names
    std::optional<std::string> column_names{};           // that line
};

// A line's cells, as they stand between the separators and without quotes. separator: a blank means any number of
// blanks and tabs; a separator between quotes is part of the cell.
std::vector<std::string_view> cells_of(std::string_view line, char separator);

// columns, separator: of the lines of numbers behind the header.
TableHeader table_header(std::span<const std::string_view> lines, std::size_t columns, char separator);

} // namespace vkfv::surface
