#include "specimen/files.hpp"

#include "core/parsing/text_encoding.hpp"
#include "surface_files/lengths.hpp"
#include "surface_files/table_header.hpp"
#include "surface_files/table_text.hpp"

#include <fmt/format.h>

#include <cmath>

namespace vkfv::specimen {

FilePoints parse_points(std::string_view bytes, const std::filesystem::path& file) {
    const auto refuse = [&](std::string found, std::string expected, std::string remedy) {
        refuse_file(file, "points", std::move(found), std::move(expected), std::move(remedy));
    };
    const std::string text = as_utf8(bytes);
    const auto table = surface::parse_table_text(text, file, "lines of x, y and z");
    // Colours, normals and intensities may follow the coordinates; a line of more numbers belongs to a matrix of
    // heights.
    constexpr std::size_t least_columns = 3, most_columns = 12;
    if (table.columns < least_columns || table.columns > most_columns) {
        refuse(fmt::format("lines of {} numbers", table.columns),
               fmt::format("x, y and z in the first {} of at most {} columns", least_columns, most_columns),
               "Export the points with their coordinates; for a matrix of heights choose kind = \"surface\".");
    }
    const auto header = surface::table_header(table.header, table.columns, table.separator);
    FilePoints result{.points = {},
                      .not_measured = 0,
                      .units = header.column_units,
                      .column_names = header.column_names.value_or("")};
    result.points.reserve(table.rows);
    for (std::size_t row = 0; row < table.rows; ++row) {
        const double* values = &table.values[row * table.columns];
        const glm::dvec3 point(values[0], values[1], values[2]);
        const bool marked = !(std::abs(point.z) < surface::not_measured_from) ||
                            (header.not_measured && surface::is_mark(point.z, *header.not_measured));
        if (!marked && std::isfinite(point.x) && std::isfinite(point.y) && std::isfinite(point.z)) {
            result.points.push_back(point);
        } else {
            ++result.not_measured;
        }
    }
    if (result.points.empty()) {
        refuse(fmt::format("{} lines, each with a gap", table.rows), "at least three measured points",
               "Export the points anew, or name another file.");
    }
    return result;
}

FilePoints read_points(const std::filesystem::path& file, const SourceLocation& mention) {
    return parse_points(specimen_bytes(file, mention), file);
}

} // namespace vkfv::specimen
