#include "surface_files/table_header.hpp"

#include "core/mathematics/units.hpp"
#include "core/parsing/byte_reader.hpp"
#include "core/parsing/length_unit.hpp"
#include "surface_files/lengths.hpp"
#include "surface_files/table_text.hpp"

#include <algorithm>
#include <array>
#include <cctype>

namespace vkfv::surface {
namespace {

bool is_one_of(std::string_view word, std::initializer_list<std::string_view> words) {
    return std::ranges::find(words, word) != words.end();
}

// A normalized key: "NODATA_value" and "No data  value" are equal.
std::string plain_key(std::string_view text) {
    std::string key;
    for (const char c : text) {
        const bool blank = c == ' ' || c == '\t' || c == '_' || c == '-' || c == '#';
        if (!blank)
            key += static_cast<char>(std::tolower(static_cast<unsigned char>(c)));
        else if (!key.empty() && key.back() != ' ')
            key += ' ';
    }
    while (key.ends_with(' '))
        key.pop_back();
    return key;
}

// The unit in a column name such as "x [mm]", "z (um)", "z <um>", "Z/nm", "z_um" or "height in um"; none without a unit
// of length. Behind a blank or an underscore, where other words stand too, only units of two letters and more count.
std::optional<double> unit_in_name(std::string_view name) {
    for (const std::string_view brackets : {"[]", "()", "<>", "{}"}) {
        const auto open = name.rfind(brackets[0]);
        const auto close = name.rfind(brackets[1]);
        if (open != std::string_view::npos && close != std::string_view::npos && open < close)
            return mm_per_length_unit(bare(name.substr(open + 1, close - open - 1)));
    }
    if (const auto slash = name.rfind('/'); slash != std::string_view::npos)
        return mm_per_length_unit(bare(name.substr(slash + 1)));
    const auto before = name.find_last_of(" _,");
    const std::string_view last = before == std::string_view::npos ? std::string_view() : bare(name.substr(before + 1));
    return last.size() > 1 && last != "in" ? mm_per_length_unit(last) : std::nullopt;
}

// A number with a point, or with a decimal comma.
std::optional<double> number_with_comma(std::string_view text) {
    std::string digits(text);
    if (std::ranges::count(digits, ',') == 1 && digits.find('.') == std::string::npos)
        std::ranges::replace(digits, ',', '.');
    return number_in<double>(digits);
}

// True if each comma of the line stands between digits, behind a blank: a decimal comma and no separator.
bool has_decimal_commas(std::string_view line) {
    const auto digit = [&](std::size_t at) { return at < line.size() && line[at] >= '0' && line[at] <= '9'; };
    const auto first = line.find(',');
    const auto blank = line.find_first_of(" \t");
    if (first == std::string_view::npos || blank == std::string_view::npos || blank > first)
        return false;
    for (auto at = first; at != std::string_view::npos; at = line.find(',', at + 1))
        if (at == 0 || !digit(at - 1) || !digit(at + 1))
            return false;
    return true;
}

// A key with its values, such as "XY Calibration","2000","nm", "cellsize 2.0" or "# Width: 10 um".
struct Statement {
    std::string key;
    std::vector<std::string_view> values;

    std::optional<double> number() const { return values.empty() ? std::nullopt : number_with_comma(values[0]); }
    std::optional<double> unit() const { return values.empty() ? std::nullopt : mm_per_length_unit(bare(values[0])); }
    std::optional<double> length() const {
        if (values.empty())
            return std::nullopt;
        if (const auto value = number(); value && values.size() > 1) {
            const auto unit = mm_per_length_unit(values[1]);
            return unit ? std::optional(*value * *unit) : std::nullopt;
        }
        const auto blank = values[0].find(' ');
        if (blank == std::string_view::npos)
            return std::nullopt;
        const auto value = number_with_comma(values[0].substr(0, blank));
        const auto unit = mm_per_length_unit(bare(values[0].substr(blank)));
        return value && unit ? std::optional(*value * *unit) : std::nullopt;
    }
};

Statement statement_of(std::string_view line) {
    line = bare(line.substr(std::min(line.find_first_not_of("# \t"), line.size())));
    for (const char separator : {'\t', ';', ',', '=', ':'}) {
        if (separator == ',' && has_decimal_commas(line))
            continue;
        auto cells = cells_of(line, separator);
        if (cells.size() > 1)
            return {plain_key(cells[0]), {cells.begin() + 1, cells.end()}};
    }
    const auto blank = line.find_last_of(" \t");
    if (blank == std::string_view::npos)
        return {plain_key(line), {}};
    return {plain_key(line.substr(0, blank)), {bare(line.substr(blank))}};
}

void take(const Statement& statement, TableHeader& header) {
    const auto first = [](std::optional<double>& member, const std::optional<double>& value) {
        if (!member)
            member = value;
    };
    const std::string& key = statement.key;
    if (is_one_of(key, {"nodata",          "nodata value", "no data",      "no data value",  "missing",
                        "missing value",   "missing data", "bad value",    "bad data",       "bad",
                        "invalid value",   "invalid data", "invalid",      "fill value",     "fillvalue",
                        "void value",      "void",         "blank value",  "blanking value", "blank",
                        "undefined value", "undefined",    "not measured", "null value",     "null",
                        "nan value",       "nodatavalue",  "missingvalue"}))
        first(header.not_measured, statement.number());
    else if (is_one_of(key,
                       {"xy calibration", "xy pitch", "pixel size", "pixel pitch", "pitch", "lateral resolution"})) {
        first(header.pitch_x, statement.length());
        first(header.pitch_y, statement.length());
    } else if (is_one_of(key, {"x pitch", "pitch x", "dx", "x step", "x spacing", "x calibration"})) {
        first(header.pitch_x, statement.length());
        if (header.is_grid && key == "dx")
            first(header.cell_x, statement.number());
    } else if (is_one_of(key, {"y pitch", "pitch y", "dy", "y step", "y spacing", "y calibration"})) {
        first(header.pitch_y, statement.length());
        if (header.is_grid && key == "dy")
            first(header.cell_y, statement.number());
    } else if (is_one_of(key, {"cellsize", "cell size"})) {
        first(header.cell_x, statement.number());
        first(header.cell_y, statement.number());
    } else if (key == "ncols" || key == "nrows") {
        header.is_grid = true;
        first(key == "ncols" ? header.points_x : header.points_y, statement.number());
    } else if (is_one_of(key, {"x pixels", "x size", "x points", "xres", "columns"}))
        first(header.points_x, statement.number());
    else if (is_one_of(key, {"y pixels", "y size", "y points", "yres", "rows", "lines"}))
        first(header.points_y, statement.number());
    else if (is_one_of(key, {"width", "breite"}))
        first(header.width, statement.length());
    else if (is_one_of(key, {"height", "h\xC3\xB6he"}))
        first(header.height, statement.length());
    else if (key == "x length") {
        first(header.width, statement.length());
        first(header.x_length, statement.number());
    } else if (key == "y length") {
        first(header.height, statement.length());
        first(header.y_length, statement.number());
    } else if (key == "x unit")
        first(header.x_unit, statement.unit());
    else if (key == "y unit")
        first(header.y_unit, statement.unit());
    else if (key == "xllcorner")
        first(header.x_corner, statement.number());
    else if (key == "yllcorner")
        first(header.y_corner, statement.number());
    else if (key == "xllcenter")
        first(header.x_centre, statement.number());
    else if (key == "yllcenter")
        first(header.y_centre, statement.number());
    else if (is_one_of(key, {"unit", "units", "height unit", "z unit", "value unit", "value units", "einheit"}))
        first(header.unit, statement.unit());
    else if (key.starts_with("height conversion factor")) {
        // In "height conversion factor (-> m) = 1e-9" the number is the height of the value 1, in the unit behind the
        // arrow.
        const auto arrow = key.find('>'), close = key.rfind(')');
        if (arrow != std::string::npos && close != std::string::npos && arrow < close)
            if (const auto factor = statement.number(),
                unit = mm_per_length_unit(bare(std::string_view(key).substr(arrow + 1, close - arrow - 1)));
                factor && unit)
                first(header.unit, *factor * *unit);
    }
}

// Converts extents from the unit of their axis, or else of the heights.
void take_lengths(TableHeader& header) {
    const auto take_length = [&](std::optional<double>& extent, const std::optional<double>& length,
                                 const std::optional<double>& own) {
        const auto unit = own ? own : header.unit;
        if (!extent && length && unit)
            extent = *length * *unit;
    };
    take_length(header.width, header.x_length, header.x_unit);
    take_length(header.height, header.y_length, header.y_unit);
}

// Splits names such as "x (um) y (um) z (um)" behind each bracket.
std::vector<std::string_view> cells_with_brackets(std::string_view names) {
    std::vector<std::string_view> cells;
    for (auto end = names.find_first_of(")]"); end != std::string_view::npos; end = names.find_first_of(")]")) {
        cells.push_back(bare(names.substr(0, end + 1)));
        names.remove_prefix(end + 1);
    }
    return cells;
}

} // namespace

std::vector<std::string_view> cells_of(std::string_view line, char separator) {
    std::vector<std::string_view> cells;
    line = bare(line);
    for (bool more = !line.empty(); more;) {
        std::size_t end = 0;
        for (bool quoted = false; end < line.size(); ++end) {
            quoted = quoted != (line[end] == '"');
            if (!quoted && (line[end] == separator || (separator == ' ' && line[end] == '\t')))
                break;
        }
        std::string_view cell = bare(line.substr(0, end));
        if (cell.size() >= 2 && cell.front() == '"' && cell.back() == '"')
            cell = bare(cell.substr(1, cell.size() - 2));
        cells.push_back(cell);
        more = end < line.size();
        line.remove_prefix(std::min(end + 1, line.size()));
        if (separator == ' ')
            line = bare(line);
        // A separator at the line's end opens no further cell.
        more = more && !line.empty();
    }
    return cells;
}

TableHeader table_header(std::span<const std::string_view> lines, std::size_t columns, char separator) {
    TableHeader header;
    for (const std::string_view line : lines)
        take(statement_of(line), header);
    take_lengths(header);
    // The names of columns are on the last line that states a unit for some of them; a matrix has one name or none.
    const auto take_names = [&](std::string_view names, const std::vector<std::string_view>& cells, std::size_t count) {
        if (cells.size() != count)
            return false;
        // A line below the names may contain only the units.
        const bool alone =
            std::ranges::all_of(cells, [](std::string_view cell) { return mm_per_length_unit(cell).has_value(); });
        std::array<std::optional<double>, 3> units;
        std::array<bool, 3> unknown{};
        for (std::size_t k = 0; k < std::min(count, units.size()); ++k) {
            units[k] = alone ? mm_per_length_unit(cells[k]) : unit_in_name(cells[k]);
            unknown[k] = !units[k] && cells[k].ends_with(']');
        }
        if (std::ranges::none_of(units, [](const auto& unit) { return unit.has_value(); }))
            return false;
        header.column_units = units;
        header.unknown_units = unknown;
        header.column_names = std::string(names);
        return true;
    };
    for (auto line = lines.rbegin(); line != lines.rend() && !header.column_names; ++line) {
        const std::string_view names = bare(line->substr(std::min(line->find_first_not_of("# \t"), line->size())));
        if (const auto cells = cells_of(names, separator); header.cells_above.empty() && cells.size() == columns)
            header.cells_above.assign(cells.begin(), cells.end());
        constexpr std::size_t one = 1;
        const auto separated = [&](std::size_t count) {
            return std::ranges::any_of(std::array{separator, ';', '\t', ','}, [&](char between) {
                return take_names(names, cells_of(names, between), count);
            });
        };
        // A line such as "Height: 10 mm" states an extent, and is no name of heights in mm.
        if (separated(columns) || take_names(names, cells_with_brackets(names), columns) ||
            (!statement_of(names).length() && separated(one)))
            return header;
    }
    return header;
}

} // namespace vkfv::surface
