#include "surface_files/height_table.hpp"

#include "core/mathematics/units.hpp"
#include "core/parsing/byte_reader.hpp"
#include "core/parsing/text_encoding.hpp"
#include "surface_files/image_scale.hpp"
#include "surface_files/lengths.hpp"
#include "surface_files/table_header.hpp"
#include "surface_files/table_text.hpp"

#include <algorithm>
#include <array>
#include <cctype>
#include <cmath>
#include <span>
#include <sstream>
#include <vector>

namespace vkfv::surface {
namespace {

constexpr std::string_view table_title = "# vkfv heights in um";
constexpr std::size_t title_lines = 5; // with the scale; provenance follows, whose text may look like a scale too
constexpr double nan = std::numeric_limits<double>::quiet_NaN();

bool is_own(const std::vector<std::string_view>& header) {
    return !header.empty() && header.front().starts_with(table_title);
}

// Reads the header that height_table() writes. Lines of provenance follow it, whose text may look like any other
// header.
TableHeader own_header(std::span<const std::string_view> lines) {
    TableHeader header;
    header.unit = mm_per_um;
    const std::array<std::pair<std::string_view, std::optional<double>*>, 4> keys = {
        {{"x0_mm=", &header.x0},
         {"y0_mm=", &header.y0},
         {"pitch_x_mm=", &header.pitch_x},
         {"pitch_y_mm=", &header.pitch_y}}};
    for (std::string_view line : lines.first(std::min(lines.size(), title_lines))) {
        line = bare(line.substr(std::min<std::size_t>(1, line.size())));
        for (const auto& [key, member] : keys)
            if (line.starts_with(key))
                *member = number_in<double>(line.substr(key.size()));
    }
    return header;
}

// Warns if an option contradicts the file, with both values.
void warn_of_contradiction(const std::filesystem::path& path, const char* option, const std::optional<double>& given,
                           double stated, const std::string& where, SurfaceFile& result) {
    if (given && contradicts(*given, stated))
        result.warnings.push_back(fmt::format("{}: its {} of {:.6g} um is used, not the {:.6g} um of the option",
                                              where.empty() ? path.string() : path.string() + ": " + where, option,
                                              stated * um_per_mm, *given * um_per_mm));
}

// A series of equidistant coordinates.
struct Ruler {
    double first = 0, step = 0;
    std::uint64_t points = 0; // 0: the coordinates are not equidistant
    std::uint64_t index(double value) const {
        return step > 0 ? static_cast<std::uint64_t>(std::llround((value - first) / step)) : 0;
    }
};

Ruler ruler_of(const TableText& table, std::size_t column) {
    std::vector<double> places;
    for (std::size_t row = 0; row < table.rows; ++row)
        places.push_back(table.values[row * table.columns + column]);
    if (!std::ranges::all_of(places, [](double place) { return std::isfinite(place); }))
        return {};
    std::ranges::sort(places);
    constexpr double same = 1e-3; // in steps, as coordinates are rounded
    const double extent = places.back() - places.front();
    double step = extent;
    for (std::size_t k = 1; k < places.size(); ++k)
        if (const double apart = places[k] - places[k - 1]; apart > extent * 1e-7)
            step = std::min(step, apart);
    if (!(step > 0) || !std::isfinite(extent) || extent / step > static_cast<double>(largest_point_count))
        return {};
    // The step follows from the whole extent, because the smallest distance has the largest rounding error.
    const double count = std::round(extent / step);
    const Ruler ruler{places.front(), extent / count, static_cast<std::uint64_t>(count) + 1};
    for (const double place : places)
        if (const double steps = (place - ruler.first) / ruler.step; std::abs(steps - std::round(steps)) > 50 * same)
            return {};
    return ruler;
}

// The grid of three columns x, y, z; none if the first two form no grid, or if fewer than one in `emptiness` of its
// points exist.
std::optional<HeightMap> grid_of_points(const TableText& table, std::uint64_t emptiness) {
    if (table.columns != 3 || table.rows < 4)
        return std::nullopt;
    const Ruler x = ruler_of(table, 0), y = ruler_of(table, 1);
    if (x.points < 2 || y.points < 2 || x.points > emptiness * table.rows / y.points)
        return std::nullopt;
    HeightMap map{.height = Grid<double>(static_cast<int>(x.points), static_cast<int>(y.points), nan),
                  .x0 = x.first,
                  .y0 = y.first,
                  .pitch_x = x.step,
                  .pitch_y = y.step};
    std::vector<bool> taken(map.height.values.size());
    for (std::size_t row = 0; row < table.rows; ++row) {
        const double* point = &table.values[3 * row];
        const std::uint64_t place = y.index(point[1]) * x.points + x.index(point[0]);
        if (taken[place])
            return std::nullopt;
        taken[place] = true;
        map.height.values[place] = point[2];
    }
    return map;
}

HeightMap matrix_of(const TableText& table) {
    HeightMap map;
    map.height = Grid<double>(static_cast<int>(table.columns), static_cast<int>(table.rows));
    for (std::size_t line = 0; line < table.rows; ++line)
        for (std::size_t column = 0; column < table.columns; ++column)
            map.height(static_cast<int>(column), static_cast<int>(table.rows - 1 - line)) =
                table.values[line * table.columns + column];
    return map;
}

// A line or a column of a table, as its numbers in sequence.
struct Sequence {
    std::size_t first = 0, step = 1, count = 0; // in the table's values
};

// The ratio of the longest to the shortest step of a sequence that rises, or falls, from number to number; infinite for
// another.
double unevenness(const TableText& table, const Sequence& sequence) {
    double shortest = std::numeric_limits<double>::infinity(), longest = -shortest;
    for (std::size_t k = 1; k < sequence.count; ++k) {
        const double* number = &table.values[sequence.first + k * sequence.step];
        const double step = *number - *(number - sequence.step);
        if (!std::isfinite(step))
            return std::numeric_limits<double>::infinity();
        shortest = std::min(shortest, step);
        longest = std::max(longest, step);
    }
    return shortest > 0  ? longest / shortest
           : longest < 0 ? shortest / longest
                         : std::numeric_limits<double>::infinity();
}

// How many columns the table has without those at its end that are empty in every line.
std::size_t filled_columns(const TableText& table) {
    std::size_t filled = 0;
    for (std::size_t k = 0; k < table.values.size(); ++k)
        if (!std::isnan(table.values[k]))
            filled = std::max(filled, k % table.columns + 1);
    return filled;
}

// True for the name of a column of positions, with or without a unit behind it: "X_(microns)", "Lateral um".
bool names_positions(std::string_view name) {
    constexpr std::array<std::string_view, 7> words = {"x",      "position", "distance", "lateral",
                                                       "length", "pos",      "abscissa"};
    std::string word;
    for (const char c : name) {
        const auto letter = static_cast<unsigned char>(c);
        if (std::isalnum(letter) == 0)
            break;
        word += static_cast<char>(std::tolower(letter));
    }
    return std::ranges::find(words, word) != words.end();
}

// True if the header says how many points the map has along both axes.
bool states_points(const TableHeader& header, const TableText& table) {
    const auto is = [](const std::optional<double>& count, std::size_t points) {
        return count && *count == static_cast<double>(points);
    };
    return (is(header.points_x, table.columns) && is(header.points_y, table.rows)) ||
           (is(header.points_x, table.rows) && is(header.points_y, table.columns));
}

// True for a profile: a position and a height in each line, or heights alone; also in two or three long lines, or one;
// or, by the name of their column, positions before several columns of heights. The first column of a height map, or
// its first line, rarely ascends evenly, as positions do; a header that states the map's size settles it.
bool is_profile(const TableText& table, const TableHeader& header) {
    constexpr std::size_t least_points = 4, most_values = 3;
    const std::size_t columns = filled_columns(table);
    if (columns == 0 || (columns > 1 && table.rows > 1 && states_points(header, table)))
        return false;
    const Sequence first_column{.first = 0, .step = table.columns, .count = table.rows};
    if (columns > 1 && table.rows >= least_points && !header.cells_above.empty() &&
        names_positions(header.cells_above.front()) && !names_positions(header.cells_above.back()) &&
        std::isfinite(unevenness(table, first_column)))
        return true;
    const bool lies = table.rows <= most_values && columns > table.rows; // a point a column, not a line
    const std::size_t points = lies ? columns : table.rows, values = lies ? table.rows : columns;
    if (values > most_values || points < least_points)
        return false;
    if (values == 1)
        return true;
    const double ratio = unevenness(table, lies ? Sequence{.first = 0, .step = 1, .count = columns} : first_column);
    if (values == 2)
        return std::isfinite(ratio);
    constexpr double regular = 1.5; // ratio of steps between rounded positions
    const bool sized = (header.width && header.height) || (header.x_length && header.y_length);
    return !sized && ratio < regular;
}

// Warns of a first column, or line, that ascends evenly while the last does not: of positions beside a map, which may
// begin below a corner of any value.
void warn_of_positions(const std::filesystem::path& path, const TableText& table, SurfaceFile& result) {
    constexpr std::size_t least_points = 8;
    constexpr double even = 1.01; // ratio of steps between positions with three digits or more
    const auto warn = [&](const char* what, const Sequence& first, std::size_t last) {
        if (first.count >= least_points && unevenness(table, first) < even &&
            !std::isfinite(unevenness(table, {.first = last, .step = first.step, .count = first.count})))
            result.warnings.push_back(
                fmt::format("{}: its first {} ascends evenly, as positions do. If it is no part of "
                            "the heights, export them alone",
                            path.string(), what));
    };
    const std::size_t columns = table.columns, rows = table.rows;
    warn("column", {.first = columns, .step = columns, .count = rows - 1}, 2 * columns - 1);
    warn("line", {.first = 1, .step = 1, .count = columns - 1}, (rows - 1) * columns + 1);
}

void set_pitch(const std::filesystem::path& path, const TableHeader& header, const ImageScale& scale,
               SurfaceFile& result) {
    HeightMap& map = result.map;
    const auto pitch = [](const std::optional<double>& own, const std::optional<double>& extent, int points) {
        return own ? own : extent ? std::optional(*extent / points) : std::nullopt;
    };
    const auto x = pitch(header.pitch_x, header.width, map.columns()),
               y = pitch(header.pitch_y, header.height, map.rows());
    const bool stated = x && y && *x > 0 && *y > 0;
    if (!stated)
        check_scale(path, {.pitch = scale.pitch, .unit = 1});
    else
        warn_of_contradiction(path, "pitch", scale.pitch, *x, "", result);
    map.pitch_x = stated ? *x : *scale.pitch;
    map.pitch_y = stated ? *y : *scale.pitch;
    map.x0 = header.x0.value_or(0);
    map.y0 = header.y0.value_or(0);
}

// Converts an ESRI grid, which has one unit along all axes.
void take_cells(double unit, TableHeader& header) {
    if (!header.cell_x || !header.cell_y)
        return;
    const double cell_x = *header.cell_x * unit, cell_y = *header.cell_y * unit;
    const auto position = [&](const std::optional<double>& centre, const std::optional<double>& corner, double cell) {
        return centre   ? std::optional(*centre * unit)
               : corner ? std::optional(*corner * unit + 0.5 * cell)
                        : std::nullopt;
    };
    header.pitch_x = header.pitch_x.value_or(cell_x);
    header.pitch_y = header.pitch_y.value_or(cell_y);
    header.x0 = position(header.x_centre, header.x_corner, cell_x);
    header.y0 = position(header.y_centre, header.y_corner, cell_y);
}

} // namespace

bool named_like_height_table(std::string_view name) {
    return std::ranges::any_of(std::array<std::string_view, 4>{".csv", ".txt", ".asc", ".xyz"},
                               [&](std::string_view ending) { return name.ends_with(ending); });
}

SurfaceFile parse_height_table(std::string_view bytes, const std::filesystem::path& path, const ImageScale& scale) {
    const std::string text = as_utf8(bytes);
    const ByteReader file(text, path);
    TableText table = parse_table_text(text, path, "a table of heights");
    const bool own = is_own(table.header);
    TableHeader header = own ? own_header(table.header) : table_header(table.header, table.columns, table.separator);
    file.check_size(table.columns, table.rows);
    if (own && scale.unit)
        refuse_second_scale(path, {.pitch = {}, .unit = scale.unit});
    if (own && scale.pitch && header.pitch_x)
        refuse_second_scale(path, {.pitch = scale.pitch, .unit = {}});
    const bool named = path.extension() == ".xyz" || path.extension() == ".XYZ";
    auto points = grid_of_points(table, named ? 64 : 2); // a matrix of three columns hardly ever forms half a grid
    if (named && !points)
        file.fail({}, "x, y", fmt::format("{} lines of {} numbers", table.rows, table.columns),
                  "x, y and z of points of a regular grid", "Export the surface on a grid.");
    if (!own && !points && is_profile(table, header))
        file.fail(
            {}, "", fmt::format("a profile: {} lines of {} numbers", table.rows, table.columns), "a map of heights",
            "Profiles are not evaluated; export the whole surface. If it is a map of so few columns, exchange its "
            "lines and columns.");
    // Points have their heights in the third column, and a matrix has one name for all of its columns.
    const auto& columns = header.column_units;
    const std::optional<double> in_names = points ? columns[2] : columns[0];
    if (!header.unit)
        header.unit = in_names;
    const double unit = header.unit.value_or(scale.unit.value_or(0));
    take_cells(unit, header);
    if (points ? !(unit > 0) : !(unit > 0) && !scale.pitch && !header.pitch_x && !header.width)
        check_scale(path, {.pitch = points ? std::optional(1.0) : scale.pitch, .unit = scale.unit});
    if (!(unit > 0 && std::isfinite(unit)))
        check_scale(path, {.pitch = 1, .unit = scale.unit});
    if (points && (header.unknown_units[0] || header.unknown_units[1]) && !scale.pitch)
        file.fail({}, "x, y", header.column_names.value_or(""), "positions in a unit of length, or --pitch_um",
                  "Give the distance of the points by --pitch_um.");
    SurfaceFile result;
    if (header.unit)
        warn_of_contradiction(path, "unit", scale.unit, unit, header.column_names.value_or(""), result);
    if (points) {
        const double along_x = columns[0].value_or(unit), along_y = columns[1].value_or(unit);
        result.map = std::move(*points);
        HeightMap& map = result.map;
        map.x0 = mm_from(map.x0, along_x);
        map.y0 = mm_from(map.y0, along_y);
        if (columns[0] && columns[1])
            warn_of_contradiction(path, "pitch", scale.pitch, map.pitch_x * along_x, *header.column_names, result);
        map.pitch_x = columns[0] ? map.pitch_x * along_x : scale.pitch.value_or(map.pitch_x * along_x);
        map.pitch_y = columns[1] ? map.pitch_y * along_y : scale.pitch.value_or(map.pitch_y * along_y);
        if (!std::isfinite(map.x0) || !std::isfinite(map.y0))
            file.fail({}, "x, y", "lengths that overflow", "finite ones");
    } else {
        result.map = matrix_of(table);
        if (!own)
            warn_of_positions(path, table, result);
        set_pitch(path, header, scale, result);
    }
    file.check_spacing(result.map.pitch_x, "pitch along x");
    file.check_spacing(result.map.pitch_y, "pitch along y");
    for (double& height : result.map.height.values)
        height = header.not_measured && is_mark(height, *header.not_measured) ? nan : measured_height(height, unit);
    std::string provenance;
    for (std::size_t k = title_lines; own && k < table.header.size(); ++k)
        if (const std::string_view line = table.header[k]; line.starts_with('#'))
            provenance += std::string(bare(line.substr(1))) + '\n';
    result.provenance = parse_provenance(provenance);
    return result;
}

std::string height_table(const HeightMap& map, const Provenance& provenance) {
    std::string text = fmt::format("{}; the first line has the highest y; NaN: not measured\n# x0_mm={}\n# y0_mm={}\n# "
                                   "pitch_x_mm={}\n# pitch_y_mm={}\n",
                                   table_title, map.x0, map.y0, map.pitch_x, map.pitch_y);
    std::istringstream lines(provenance_text(provenance));
    for (std::string line; std::getline(lines, line);)
        text += fmt::format("# {}\n", line);
    for (int row = map.rows() - 1; row >= 0; --row)
        for (int column = 0; column < map.columns(); ++column) {
            const double height = map.height(column, row);
            if (std::isfinite(height))
                fmt::format_to(std::back_inserter(text), "{}", height / mm_per_um);
            else
                text += "NaN";
            text += column + 1 < map.columns() ? ',' : '\n';
        }
    return text;
}

} // namespace vkfv::surface
