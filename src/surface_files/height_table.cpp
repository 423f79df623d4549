#include "surface_files/height_table.hpp"

#include "core/mathematics/units.hpp"
#include "core/parsing/byte_reader.hpp"
#include "surface_files/image_scale.hpp"
#include "surface_files/lengths.hpp"
#include "surface_files/table_text.hpp"

#include <algorithm>
#include <array>
#include <span>
#include <sstream>
#include <vector>

namespace vkfv::surface {
namespace {

constexpr std::string_view table_title = "# vkfv heights in um";
constexpr std::size_t title_lines = 5; // with the scale; provenance follows, whose text may look like either
constexpr double nan = std::numeric_limits<double>::quiet_NaN();

// What a header says of lengths, in mm.
struct Header {
    std::optional<double> unit, pitch_x, pitch_y, width, height, x0, y0;
};

// "10.0 um" or a number, which is of um in our own header.
std::optional<double> length_in(std::string_view text) {
    text = bare(text);
    const auto blank = text.find(' ');
    if (blank == std::string_view::npos)
        return std::nullopt;
    const auto value = number_in<double>(text.substr(0, blank));
    const auto unit = mm_per_unit(bare(text.substr(blank)));
    return value && unit ? std::optional(*value * *unit) : std::nullopt;
}

bool is_own(const std::vector<std::string_view>& header) {
    return !header.empty() && header.front().starts_with(table_title);
}

Header header_of(std::span<const std::string_view> lines) {
    Header header;
    const std::array<std::pair<std::string_view, std::optional<double>*>, 4> own = {{{"x0_mm=", &header.x0},
                                                                                     {"y0_mm=", &header.y0},
                                                                                     {"pitch_x_mm=", &header.pitch_x},
                                                                                     {"pitch_y_mm=", &header.pitch_y}}};
    const std::array<std::pair<std::string_view, std::optional<double>*>, 2> gwyddion = {
        {{"Width:", &header.width}, {"Height:", &header.height}}};
    for (std::string_view line : lines) {
        if (line.starts_with(table_title))
            header.unit = mm_per_um;
        if (!line.starts_with('#'))
            continue;
        line = bare(line.substr(1));
        for (const auto& [key, member] : own)
            if (line.starts_with(key))
                *member = number_in<double>(line.substr(key.size()));
        for (const auto& [key, member] : gwyddion)
            if (line.starts_with(key))
                *member = length_in(line.substr(key.size()));
        if (constexpr std::string_view key = "Value units:"; line.starts_with(key) && !header.unit)
            header.unit = mm_per_unit(bare(line.substr(key.size())));
    }
    return header;
}

// Coordinates on a line of equal distances.
struct Ruler {
    double first = 0, step = 0;
    std::uint64_t points = 0; // 0: there is none
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
    constexpr double same = 1e-3; // of a step: coordinates are rounded
    const double extent = places.back() - places.front();
    double step = extent;
    for (std::size_t k = 1; k < places.size(); ++k)
        if (const double apart = places[k] - places[k - 1]; apart > extent * 1e-7)
            step = std::min(step, apart);
    if (!(step > 0) || !std::isfinite(extent) || extent / step > static_cast<double>(largest_point_count))
        return {};
    // The smallest distance is rounded most; the whole extent holds a whole number of steps.
    const double count = std::round(extent / step);
    const Ruler ruler{places.front(), extent / count, static_cast<std::uint64_t>(count) + 1};
    for (const double place : places)
        if (const double steps = (place - ruler.first) / ruler.step; std::abs(steps - std::round(steps)) > 50 * same)
            return {};
    return ruler;
}

// Of three columns; nothing where the first two make up no grid of which at least one point in `emptiness` is there.
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

// A pitch of the header or of `scale`.
void set_pitch(const std::filesystem::path& path, const Header& header, const ImageScale& scale, HeightMap& map) {
    const auto pitch = [](const std::optional<double>& own, const std::optional<double>& extent, int points) {
        return own ? own : extent ? std::optional(*extent / points) : std::nullopt;
    };
    const auto x = pitch(header.pitch_x, header.width, map.columns()),
               y = pitch(header.pitch_y, header.height, map.rows());
    if (x && y && scale.pitch)
        refuse_second_scale(path, {.pitch = scale.pitch, .unit = {}});
    if (!(x && y) || !(*x > 0 && *y > 0))
        check_scale(path, {.pitch = scale.pitch, .unit = 1});
    map.pitch_x = x && y && *x > 0 && *y > 0 ? *x : *scale.pitch;
    map.pitch_y = x && y && *x > 0 && *y > 0 ? *y : *scale.pitch;
    map.x0 = header.x0.value_or(0);
    map.y0 = header.y0.value_or(0);
}

} // namespace

bool named_like_height_table(std::string_view name) {
    return std::ranges::any_of(std::array<std::string_view, 4>{".csv", ".txt", ".asc", ".xyz"},
                               [&](std::string_view ending) { return name.ends_with(ending); });
}

SurfaceFile parse_height_table(std::string_view bytes, const std::filesystem::path& path, const ImageScale& scale) {
    const ByteReader file(bytes, path);
    const TableText table = parse_table_text(bytes, path, "a table of heights");
    const bool own = is_own(table.header);
    const Header header = header_of(
        std::span(table.header).first(std::min(table.header.size(), own ? title_lines : table.header.size())));
    file.check_size(table.columns, table.rows);
    if (header.unit && scale.unit)
        refuse_second_scale(path, {.pitch = {}, .unit = scale.unit});
    const bool named = path.extension() == ".xyz" || path.extension() == ".XYZ";
    auto points = grid_of_points(table, named ? 64 : 2); // a matrix of three columns is as good as never half a grid
    if (named && !points)
        file.fail({}, "x, y", fmt::format("{} lines of {} numbers", table.rows, table.columns),
                  "x, y and z of points of a regular grid", "Export the surface on a grid.");
    const double unit = header.unit.value_or(scale.unit.value_or(0));
    if (points ? !(unit > 0) : !(unit > 0) && !scale.pitch && !header.pitch_x && !header.width)
        check_scale(path, {.pitch = points ? std::optional(1.0) : scale.pitch, .unit = scale.unit});
    if (!(unit > 0 && std::isfinite(unit)))
        check_scale(path, {.pitch = 1, .unit = scale.unit});
    SurfaceFile result;
    if (points) {
        result.map = std::move(*points);
        result.map.x0 = mm_from(result.map.x0, unit);
        result.map.y0 = mm_from(result.map.y0, unit);
        result.map.pitch_x = scale.pitch.value_or(result.map.pitch_x * unit);
        result.map.pitch_y = scale.pitch.value_or(result.map.pitch_y * unit);
        if (!std::isfinite(result.map.x0) || !std::isfinite(result.map.y0))
            file.fail({}, "x, y", "lengths that overflow", "finite ones");
    } else {
        result.map = matrix_of(table);
        set_pitch(path, header, scale, result.map);
    }
    file.check_spacing(result.map.pitch_x, "pitch along x");
    file.check_spacing(result.map.pitch_y, "pitch along y");
    for (double& height : result.map.height.values)
        height = height_from(height, unit);
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
