#include "surface_files/sdf.hpp"

#include "core/parsing/byte_reader.hpp"
#include "surface/metres.hpp"

#include <algorithm>
#include <array>
#include <limits>
#include <map>
#include <type_traits>

namespace vkfv::surface {
namespace {

constexpr std::string_view binary_magic = "bISO-1.0", text_magic = "aISO-1.0";
// Version 2.0 of ISO 25178-71:2026 counts points and profiles in 32 bits; facts: the Python package sdfio, whose
// samples MountainsMap 11 wrote. Before ISO 25178-71 the same header had the magic words of BCR's report EUR 15178 and
// of NPL's softgauges.
constexpr std::string_view wide_magic = "bISO-2.0";
constexpr std::array binary_magics = {binary_magic, wide_magic, std::string_view("bBCR-1.0")};
constexpr std::array text_magics = {text_magic, std::string_view("aISO-2.0"), std::string_view("aBCR-1.0"),
                                    std::string_view("aBCR-0.0"), std::string_view("aNPL-1.0")};
constexpr std::size_t manufacturer_at = 8, manufacturer_length = 10, creation_at = 18, date_length = 12,
                      columns_at = 42, rows_at = 44, x_scale_at = 46, y_scale_at = 54, z_scale_at = 62,
                      compression_at = 78, type_at = 79, check_at = 80, header_size = 81;
constexpr std::size_t wide_rows_at = 46,
                      wider_by = 4; // in version 2.0, where all fields behind are farther off by this
constexpr int double_type = 7;
constexpr std::string_view x0_key = "x0_mm=", y0_key = "y0_mm=";

// Converts "DDMMYYYYHHMM" to xsd:dateTime; empty if the digits are no date.
std::string date_from(std::string_view digits) {
    if (digits.size() < date_length)
        return {};
    const auto part = [&](std::size_t begin, std::size_t length) {
        return number_in<int>(digits.substr(begin, length)).value_or(-1);
    };
    const DateTime date{part(4, 4), part(2, 2), part(0, 2), part(8, 2), part(10, 2), 0};
    return date.valid() ? known_date(date.text()) : std::string();
}

std::string date_digits(const std::string& text) {
    const DateTime date = date_time(text);
    return fmt::format("{:02}{:02}{:04}{:02}{:02}", date.day, date.month, date.year, date.hour, date.minute);
}

void check_type(const ByteReader& file, int compression, int type, int check, std::optional<std::uint64_t> offset) {
    if (compression != 0 || check != 0)
        file.fail(offset, "compression, checksum", fmt::format("{}, {}", compression, check), "0, 0",
                  "Export the file without compression and checksum.");
    if (type < 0 || type > double_type)
        file.fail(offset, "data type", fmt::format("{}", type),
                  "0 to 7 (uint8, uint16, uint32, float32, int8, int16, int32 or float64)");
}

void check_scale(const ByteReader& file, double scale, std::optional<std::uint64_t> offset) {
    if (!std::isfinite(scale) || scale == 0)
        file.fail(offset, "Zscale", fmt::format("{}", scale), "a finite number that is not 0");
}

// True for a type with a value that marks points that were not measured. Types of one byte had none before version 2.0.
template <class Stored>
constexpr bool has_mark(bool wide) {
    return sizeof(Stored) > 1 || (wide && std::is_signed_v<Stored>);
}

template <class Stored>
void read_sdf_heights(std::string_view points, double scale, bool wide, Grid<double>& heights) {
    std::size_t index = 0;
    for (int row = heights.rows - 1; row >= 0; --row)
        for (int column = 0; column < heights.columns; ++column, ++index) {
            using Limits = std::numeric_limits<Stored>;
            const Stored value = element<Stored>(points, index);
            // The mark is the lowest value of a signed type, also of a floating one, and the largest of an unsigned
            // one.
            const bool gap = has_mark<Stored>(wide) && value == (Limits::is_signed ? Limits::lowest() : Limits::max());
            heights(column, row) =
                gap ? std::numeric_limits<double>::quiet_NaN() : height_from_metres(static_cast<double>(value) * scale);
        }
}

SurfaceFile parse_binary(const ByteReader& file) {
    const bool wide = file.bytes(0, wide_magic.size(), "header") == wide_magic;
    const std::size_t shift = wide ? wider_by : 0;
    (void)file.bytes(0, header_size + shift, "header");
    const std::uint64_t columns = wide ? file.at<std::uint32_t>(columns_at, "points")
                                       : file.at<std::uint16_t>(columns_at, "points"),
                        rows = wide ? file.at<std::uint32_t>(wide_rows_at, "profiles")
                                    : file.at<std::uint16_t>(rows_at, "profiles");
    file.check_size(columns, rows, columns_at);
    const double x_scale = mm_from_metres(file.at<double>(x_scale_at + shift, "Xscale"));
    const double y_scale = mm_from_metres(file.at<double>(y_scale_at + shift, "Yscale"));
    const double z_scale = file.at<double>(z_scale_at + shift, "Zscale");
    file.check_spacing(x_scale, "Xscale", x_scale_at + shift);
    file.check_spacing(y_scale, "Yscale", y_scale_at + shift);
    check_scale(file, z_scale, z_scale_at + shift);
    const int type = file.at<std::uint8_t>(type_at + shift, "data type");
    check_type(file, file.at<std::uint8_t>(compression_at + shift, "compression"), type,
               file.at<std::uint8_t>(check_at + shift, "checksum"), compression_at + shift);
    struct StoredType {
        std::uint64_t bytes;
        void (*read)(std::string_view, double, bool, Grid<double>&);
    };
    constexpr std::array<StoredType, double_type + 1> types = {{{1, read_sdf_heights<std::uint8_t>},
                                                                {2, read_sdf_heights<std::uint16_t>},
                                                                {4, read_sdf_heights<std::uint32_t>},
                                                                {4, read_sdf_heights<float>},
                                                                {1, read_sdf_heights<std::int8_t>},
                                                                {2, read_sdf_heights<std::int16_t>},
                                                                {4, read_sdf_heights<std::int32_t>},
                                                                {8, read_sdf_heights<double>}}};
    const StoredType& stored = types[static_cast<std::size_t>(type)];
    const auto points = file.bytes(header_size + shift, columns * rows * stored.bytes, "points");

    SurfaceFile result;
    result.map.pitch_x = x_scale;
    result.map.pitch_y = y_scale;
    result.map.height = Grid<double>(static_cast<int>(columns), static_cast<int>(rows));
    stored.read(points, z_scale, wide, result.map.height);
    // MountainsMap ends the name with a NUL, behind which anything stands, instead of filling it with blanks.
    const auto manufacturer = file.bytes(manufacturer_at, manufacturer_length, "manufacturer");
    result.provenance.manufacturer = plain_line(manufacturer.substr(0, manufacturer.find('\0')));
    result.provenance.date = date_from(file.bytes(creation_at, date_length, "date"));
    return result;
}

SurfaceFile parse_text(const ByteReader& file, std::string_view text) {
    std::size_t at = std::min(text.find('\n'), text.size());
    std::map<std::string, std::string> fields;
    std::string_view line;
    do {
        if (at >= text.size())
            file.fail(at, "header", "the end of the file", "a line with *");
        ++at;
        line = text.substr(at, text.substr(at).find('\n'));
        at += line.size();
        if (const auto equals = line.find('='); equals != std::string_view::npos)
            fields[plain_line(line.substr(0, equals))] = plain_line(line.substr(equals + 1));
    } while (!line.starts_with('*'));
    const auto number = [&]<class Value>(const char* key, Value) {
        const auto value = number_in<Value>(fields[key]);
        if (!value)
            file.fail({}, key, fields[key].empty() ? "nothing" : fields[key], "a number");
        return *value;
    };
    const auto columns = number("NumPoints", std::uint64_t{}), rows = number("NumProfiles", std::uint64_t{});
    file.check_size(columns, rows);
    const double x_scale = mm_from_metres(number("Xscale", 0.0)), y_scale = mm_from_metres(number("Yscale", 0.0));
    const double z_scale = number("Zscale", 0.0);
    file.check_spacing(x_scale, "Xscale");
    file.check_spacing(y_scale, "Yscale");
    check_scale(file, z_scale, {});
    check_type(file, number("Compression", 0), number("DataType", 0), number("CheckType", 0), {});
    // Each point takes at least a digit and a blank.
    if (2 * columns * rows > text.size() - at + 1)
        file.fail(at, "heights", fmt::format("{} bytes", text.size() - at),
                  fmt::format("{} x {} heights", columns, rows));

    SurfaceFile result;
    result.map.pitch_x = x_scale;
    result.map.pitch_y = y_scale;
    result.map.height = Grid<double>(static_cast<int>(columns), static_cast<int>(rows));
    constexpr std::string_view blanks = " \t\r\n";
    for (int row = result.map.rows() - 1; row >= 0; --row)
        for (int column = 0; column < result.map.columns(); ++column) {
            const auto begin = text.find_first_not_of(blanks, at);
            if (begin == std::string_view::npos || text[begin] == '*')
                file.fail(std::min(begin, text.size()), "heights",
                          fmt::format("the end of profile {}", result.map.rows() - 1 - row),
                          fmt::format("{} x {} heights", columns, rows));
            at = std::min(text.find_first_of(blanks, begin), text.size());
            const auto value = number_in<double>(text.substr(begin, at - begin));
            result.map.height(column, row) =
                value ? height_from_metres(*value * z_scale) : std::numeric_limits<double>::quiet_NaN();
        }

    // The third section is free text between stars; in files of vkfv it begins with the position.
    std::string_view trailer = text.substr(at);
    const auto star = trailer.find('*');
    trailer = star == std::string_view::npos ? std::string_view() : trailer.substr(star + 1);
    trailer = trailer.substr(0, trailer.rfind('*'));
    const auto take_line = [&](std::string_view key) {
        const auto begin = trailer.find(key);
        if (begin == std::string_view::npos)
            return 0.0;
        const auto rest = trailer.substr(begin + key.size());
        const auto line = rest.substr(0, rest.find('\n'));
        trailer = rest.substr(line.size());
        return number_in<double>(line).value_or(0.0);
    };
    result.map.x0 = take_line(x0_key);
    result.map.y0 = take_line(y0_key);
    result.provenance = parse_provenance(trailer);
    if (result.provenance.manufacturer.empty())
        result.provenance.manufacturer = fields["ManufacID"];
    if (result.provenance.date.empty())
        result.provenance.date = date_from(fields["CreateDate"]);
    return result;
}

bool is_binary(std::string_view bytes) {
    return std::ranges::any_of(binary_magics, [&](std::string_view magic) { return bytes.starts_with(magic); });
}

void check_fits(const HeightMap& map) {
    if (map.columns() > std::numeric_limits<std::uint16_t>::max() ||
        map.rows() > std::numeric_limits<std::uint16_t>::max())
        throw RunError(fmt::format("{} x {} points cannot be written as SDF, which holds at most 65535 an axis. Choose "
                                   "another format.",
                                   map.columns(), map.rows()));
}

} // namespace

bool looks_like_sdf(std::string_view bytes) {
    return is_binary(bytes) ||
           std::ranges::any_of(text_magics, [&](std::string_view magic) { return bytes.starts_with(magic); });
}

SurfaceFile parse_sdf(std::string_view bytes, const std::filesystem::path& path) {
    const ByteReader file(bytes, path);
    return is_binary(bytes) ? parse_binary(file) : parse_text(file, bytes);
}

std::string sdf_bytes(const HeightMap& map, const Provenance& provenance) {
    check_fits(map);
    std::string bytes(binary_magic);
    std::string manufacturer = plain_line(provenance.manufacturer);
    manufacturer.resize(manufacturer_length, ' ');
    const std::string date = date_digits(provenance.date);
    bytes += manufacturer + date + date;
    append(bytes, static_cast<std::uint16_t>(map.columns()));
    append(bytes, static_cast<std::uint16_t>(map.rows()));
    append(bytes, metres_from_mm(map.pitch_x));
    append(bytes, metres_from_mm(map.pitch_y));
    append(bytes, 1.0); // value of Zscale
    append(bytes, 0.0); // value of Zresolution: not known
    append(bytes, std::uint8_t{0});
    append(bytes, std::uint8_t{double_type});
    append(bytes, std::uint8_t{0});
    bytes.reserve(bytes.size() + map.height.values.size() * sizeof(double));
    for (int row = map.rows() - 1; row >= 0; --row)
        for (int column = 0; column < map.columns(); ++column) {
            const double height = map.height(column, row);
            append(bytes, std::isfinite(height) ? metres_from_mm(height) : std::numeric_limits<double>::quiet_NaN());
        }
    return bytes;
}

std::string sdf_text(const HeightMap& map, const Provenance& provenance) {
    check_fits(map);
    const auto without_stars = [](std::string line) { // a star would end the section
        std::ranges::replace(line, '*', '?');
        return line;
    };
    const std::string date = date_digits(provenance.date);
    std::string text =
        fmt::format("{}\nManufacID = {:.10}\nCreateDate = {}\nModDate = {}\nNumPoints = {}\nNumProfiles = "
                    "{}\nXscale = {}\nYscale = {}\nZscale = 1\nZresolution = 0\nCompression = 0\n"
                    "DataType = {}\nCheckType = 0\n*\n",
                    text_magic, without_stars(plain_line(provenance.manufacturer)), date, date, map.columns(),
                    map.rows(), metres_from_mm(map.pitch_x), metres_from_mm(map.pitch_y), double_type);
    for (int row = map.rows() - 1; row >= 0; --row)
        for (int column = 0; column < map.columns(); ++column) {
            const double height = map.height(column, row);
            if (std::isfinite(height))
                fmt::format_to(std::back_inserter(text), "{}", metres_from_mm(height));
            else
                text += "NaN";
            text += column + 1 < map.columns() ? ' ' : '\n';
        }
    return text + fmt::format("*\n{}{}\n{}{}\n{}*\n", x0_key, map.x0, y0_key, map.y0,
                              without_stars(provenance_text(provenance)));
}

} // namespace vkfv::surface
