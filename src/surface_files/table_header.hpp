// Parses the lines above a table of numbers: units, pitches, the mark of points that were not measured.
#pragma once

#include <array>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace vkfv::surface {

// The statements of a header, lengths in mm; members are none where it states nothing.
struct TableHeader {
    std::optional<double> unit;             // unit of heights, mm
    std::optional<double> pitch_x, pitch_y; // between points
    bool is_grid = false;                   // an ESRI grid, which states its columns and rows
    std::optional<double> cell_x, cell_y;   // pitch in the unit of the heights (ESRI grids)
    std::optional<double> width, height;    // extent of the whole grid
    // Extents of the whole grid without a unit (SPIP): the unit is that of their axis, else of the heights.
    std::optional<double> x_length, y_length;
    std::optional<double> x_unit, y_unit; // mm
    std::optional<double> x0, y0;         // position of the point with the lowest x and y
    // The position of that point, or of the corner of its cell, in the unit of the heights (ESRI grids).
    std::optional<double> x_centre, y_centre, x_corner, y_corner;
    std::optional<double> not_measured;                  // value that marks a gap
    std::array<std::optional<double>, 3> column_units{}; // for the first three columns, from the line of their names
    std::array<bool, 3> unknown_units{}; // true for names with a unit in square brackets that is no length: "x [px]"
    std::optional<std::string> column_names{}; // the line of the columns' names
    std::optional<double> points_x, points_y;  // how many points lie along x and y
    std::vector<std::string> cells_above{};    // the lowest line of the header with as many cells as the table's lines
};

// The cells of a line, without separators and quotes. separator: a blank stands for any number of blanks and tabs; a
// separator between quotes is part of the cell.
std::vector<std::string_view> cells_of(std::string_view line, char separator);

// Parses the header's lines. columns, separator: those of the lines of numbers that follow.
TableHeader table_header(std::span<const std::string_view> lines, std::size_t columns, char separator);

} // namespace vkfv::surface
