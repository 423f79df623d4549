#include "surface_files/gsf.hpp"

#include "core/parsing/byte_reader.hpp"
#include "core/parsing/length_unit.hpp"
#include "surface_files/lengths.hpp"

#include <algorithm>
#include <map>
#include <sstream>

namespace vkfv::surface {
namespace {

constexpr std::string_view gsf_magic = "Gwyddion Simple Field 1.0\n";
constexpr std::size_t alignment = 4; // offset of the points is a multiple, reached by one to four NULs
constexpr std::string_view gsf_provenance_key = "VkfvProvenance"; // followed by the number of the provenance's lines
constexpr std::string_view gsf_title = "Height";

using Fields = std::map<std::string, std::string>;

Fields fields_of(std::string_view header) {
    Fields fields;
    for (std::size_t at = gsf_magic.size(); at < header.size();) {
        const std::string_view line = header.substr(at, header.substr(at).find('\n'));
        if (const auto equals = line.find('='); equals != std::string_view::npos) {
            std::string_view value = line.substr(equals + 1);
            value.remove_prefix(std::min(value.find_first_not_of(' '), value.size()));
            fields[plain_line(line.substr(0, equals))] = value; // unchanged, as units are not only ASCII
        }
        at += line.size() + 1;
    }
    return fields;
}

Provenance provenance_of(const Fields& fields) {
    std::string text;
    for (int k = 1;; ++k) {
        const auto line = fields.find(fmt::format("{}{}", gsf_provenance_key, k));
        if (line == fields.end())
            break;
        text += line->second + '\n';
    }
    Provenance provenance = parse_provenance(text);
    if (const auto title = fields.find("Title"); text.empty() && title != fields.end() && title->second != gsf_title)
        provenance.comment = plain_line(title->second);
    return provenance;
}

} // namespace

bool looks_like_gsf(std::string_view bytes) {
    return bytes.starts_with(gsf_magic);
}

SurfaceFile parse_gsf(std::string_view bytes, const std::filesystem::path& path) {
    const ByteReader file(bytes, path);
    const auto end = bytes.find('\0');
    if (end == std::string_view::npos)
        file.fail({}, "header", "no end", "a NUL behind it");
    const Fields fields = fields_of(bytes.substr(0, end));
    const auto number = [&]<class Value>(const char* key, std::optional<Value> fallback) {
        const auto field = fields.find(key);
        if (field == fields.end() && fallback)
            return *fallback;
        const auto value = field == fields.end() ? std::nullopt : number_in<Value>(field->second);
        if (!value)
            file.fail({}, key, field == fields.end() ? "nothing" : plain_line(field->second), "a number");
        return *value;
    };
    const auto unit = [&](const char* key) {
        const auto field = fields.find(key);
        const auto mm = field == fields.end() ? std::nullopt : mm_per_length_unit(field->second);
        if (!mm)
            file.fail({}, key, field == fields.end() ? "nothing" : plain_line(field->second), length_unit_names,
                      "Export the surface with lengths on all three axes.");
        return *mm;
    };
    const auto columns = number("XRes", std::optional<std::uint64_t>()),
               rows = number("YRes", std::optional<std::uint64_t>());
    file.check_size(columns, rows);
    const std::size_t data = (end / alignment + 1) * alignment;
    const auto points = file.bytes(data, columns * rows * sizeof(float), "points");
    const double unit_xy = unit("XYUnits"), unit_z = unit("ZUnits");
    SurfaceFile result;
    const auto pitch = [&](const char* key, int count) {
        const double extent = number(key, std::optional(1.0));
        const double mm = unit_xy == mm_per_metre ? pitch_from_extent(extent, count) : extent * unit_xy / count;
        file.check_spacing(mm, key);
        return mm;
    };
    const int width = static_cast<int>(columns), height = static_cast<int>(rows);
    result.map.pitch_x = pitch("XReal", width);
    result.map.pitch_y = pitch("YReal", height);
    result.map.x0 = mm_from(number("XOffset", std::optional(0.0)), unit_xy);
    result.map.y0 = mm_from(number("YOffset", std::optional(0.0)), unit_xy);
    if (!std::isfinite(result.map.x0) || !std::isfinite(result.map.y0))
        file.fail({}, "XOffset, YOffset", "lengths that overflow", "finite ones");
    result.map.height = Grid<double>(width, height);
    std::size_t index = 0;
    for (int row = height - 1; row >= 0; --row)
        for (int column = 0; column < width; ++column, ++index)
            result.map.height(column, row) = height_from(static_cast<double>(element<float>(points, index)), unit_z);
    result.provenance = provenance_of(fields);
    return result;
}

std::string gsf_bytes(const HeightMap& map, const Provenance& provenance) {
    const double width = extent_from_pitch(map.pitch_x, map.columns()),
                 height = extent_from_pitch(map.pitch_y, map.rows());
    if (!std::isfinite(width) || !std::isfinite(height) || !(width > 0) || !(height > 0))
        throw RunError(fmt::format("{} x {} m cannot be written as GSF. Choose another format.", width, height));
    std::string bytes(gsf_magic);
    bytes += fmt::format("XRes = {}\nYRes = {}\nXReal = {}\nYReal = {}\nXOffset = {}\nYOffset = {}\nXYUnits = m\n"
                         "ZUnits = m\nTitle = {}\n",
                         map.columns(), map.rows(), width, height, metres_from_mm(map.x0), metres_from_mm(map.y0),
                         gsf_title);
    std::istringstream lines(provenance_text(provenance));
    int number = 0;
    for (std::string line; std::getline(lines, line);)
        bytes += fmt::format("{}{} = {}\n", gsf_provenance_key, ++number, line);
    bytes.resize((bytes.size() / alignment + 1) * alignment, '\0');
    for (int row = map.rows() - 1; row >= 0; --row)
        for (int column = 0; column < map.columns(); ++column) {
            const double mm = map.height(column, row);
            // Adding zero avoids -0, to which small heights would be rounded.
            append(bytes, std::isfinite(mm) ? static_cast<float>(metres_from_mm(mm)) + 0.0f
                                            : std::numeric_limits<float>::quiet_NaN());
        }
    return bytes;
}

} // namespace vkfv::surface
