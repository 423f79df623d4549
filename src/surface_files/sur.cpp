#include "surface_files/sur.hpp"

#include "core/parsing/byte_reader.hpp"
#include "core/parsing/length_unit.hpp"
#include "surface_files/lengths.hpp"

#include <zlib.h>

#include <algorithm>
#include <array>
#include <limits>
#include <vector>

namespace vkfv::surface {
namespace {

constexpr std::string_view sur_magic = "DIGITAL SURF", packed_magic = "DSCOMPRESSED";

// Offsets of the header's fields, in bytes.
constexpr std::size_t object_count_at = 14, version_at = 16, type_at = 18, object_name_at = 20, operator_name_at = 50,
                      special_points_at = 86, absolute_at = 88, bits_at = 98, z_min_at = 100, z_max_at = 104,
                      columns_at = 108, rows_at = 112, count_at = 116, dx_at = 120, dy_at = 124, dz_at = 128,
                      x_name_at = 132, y_name_at = 148, z_name_at = 164, dx_unit_at = 180, dy_unit_at = 196,
                      dz_unit_at = 212, x_unit_at = 228, y_unit_at = 244, z_unit_at = 260, x_ratio_at = 276,
                      y_ratio_at = 280, z_ratio_at = 284, inversion_at = 290, second_at = 306, comment_length_at = 334,
                      private_length_at = 336, x0_at = 466, y0_at = 470, z0_at = 474, header_size = 512;
constexpr std::size_t name_length = 30, axis_length = 16;
constexpr std::int16_t surface_type = 2;
constexpr std::int16_t profile_type = 1; // also that of surfaces exported by Gwyddion 2.62
constexpr double deflate_ratio = 1032;   // zlib's largest ratio: 258 bytes from two bits

double unit_at(const ByteReader& file, std::size_t offset) {
    std::string_view text = file.bytes(offset, axis_length, "unit");
    text = text.substr(0, text.find_first_of(std::string_view(" \0", 2)));
    const auto unit = mm_per_length_unit(text);
    if (!unit)
        file.fail(offset, "unit of length", text.empty() ? "nothing" : plain_line(text), length_unit_names,
                  "Export the surface with lengths on all three axes.");
    return *unit;
}

std::string unpacked(const ByteReader& file, std::size_t directory, std::uint64_t size) {
    const auto count = file.at<std::uint32_t>(directory, "number of packed parts");
    const auto entries = file.bytes(directory + 4, std::uint64_t{8} * count, "directory of packed parts");
    std::uint64_t raw = 0, packed = 0;
    for (std::size_t k = 0; k < count; ++k) {
        raw += element<std::uint32_t>(entries, 2 * k);
        packed += element<std::uint32_t>(entries, 2 * k + 1);
    }
    std::uint64_t at = directory + 4 + std::uint64_t{8} * count;
    (void)file.bytes(at, packed, "packed points");
    if (raw != size || static_cast<double>(raw) > deflate_ratio * static_cast<double>(packed))
        file.fail(directory, "packed points", fmt::format("{} bytes in {}", raw, packed),
                  fmt::format("{} bytes, as many as the header's points take up", size));
    std::string points(size, '\0');
    std::size_t filled = 0;
    for (std::size_t k = 0; k < count; ++k) {
        const auto part = element<std::uint32_t>(entries, 2 * k);
        const auto packed_part = element<std::uint32_t>(entries, 2 * k + 1);
        uLongf length = part;
        const auto stream = file.bytes(at, packed_part, "packed points");
        if (uncompress(reinterpret_cast<Bytef*>(points.data() + filled), &length,
                       reinterpret_cast<const Bytef*>(stream.data()), packed_part) != Z_OK ||
            length != part)
            file.fail(at, "packed points", "no whole zlib stream", fmt::format("one of {} bytes", part));
        filled += part;
        at += packed_part;
    }
    return points;
}

template <class Stored>
void read_sur_heights(std::string_view points, std::int64_t not_measured, double step, double z0,
                      Grid<double>& heights) {
    std::size_t index = 0;
    for (int row = heights.rows - 1; row >= 0; --row)
        for (int column = 0; column < heights.columns; ++column, ++index) {
            const Stored value = element<Stored>(points, index);
            heights(column, row) = value == not_measured ? std::numeric_limits<double>::quiet_NaN() : value * step + z0;
        }
}

// Applies the header's inversion as Gwyddion 2.62 and SurfaceTopography do: 1, 2 and 3 negate the heights, 2 also
// exchanges left and right, and 3 also reverses the order of the lines.
void invert(std::int16_t inversion, Grid<double>& heights) {
    constexpr std::int16_t about_y = 2, about_x = 3;
    if (inversion < 1 || inversion > about_x)
        return;
    for (double& height : heights.values)
        height = -height;
    const auto row_at = [&](int row) {
        return heights.values.begin() + static_cast<std::ptrdiff_t>(row) * heights.columns;
    };
    if (inversion == about_y)
        for (int row = 0; row < heights.rows; ++row)
            std::reverse(row_at(row), row_at(row + 1));
    if (inversion == about_x)
        for (int row = 0; row < heights.rows / 2; ++row)
            std::swap_ranges(row_at(row), row_at(row + 1), row_at(heights.rows - 1 - row));
}

// The exponent of the step 2^exponent mm in which the largest height takes up 30 bits, also after rounding. RunError if
// the format cannot hold the heights, pitches or positions.
int exponent_of_steps(const HeightMap& map) {
    constexpr int height_bits = 30, smallest_exponent = -120, largest_exponent = 90;
    double largest = 0;
    for (const double height : map.height.values)
        if (std::isfinite(height))
            largest = std::max(largest, std::abs(height));
    int exponent = largest < std::ldexp(1.0, smallest_exponent)
                       ? -height_bits // all heights are 0 or negligible
                       : std::max(std::ilogb(largest) + 1 - height_bits, smallest_exponent);
    if (std::nearbyint(std::ldexp(largest, -exponent)) >= std::ldexp(1.0, height_bits))
        ++exponent;
    if (exponent > largest_exponent)
        throw RunError(fmt::format("heights of {} mm cannot be written as SUR. Choose another format.", largest));
    for (const double length : {map.pitch_x, map.pitch_y, map.x0, map.y0})
        if (!(std::abs(length) < static_cast<double>(std::numeric_limits<float>::max())))
            throw RunError(fmt::format("a length of {} mm cannot be written as SUR. Choose another format.", length));
    for (const double pitch : {map.pitch_x, map.pitch_y})
        if (!(static_cast<float>(pitch) > 0))
            throw RunError(fmt::format("a pitch of {} mm cannot be written as SUR. Choose another format.", pitch));
    return exponent;
}

} // namespace

bool looks_like_sur(std::string_view bytes) {
    return bytes.starts_with(sur_magic) || bytes.starts_with(packed_magic);
}

SurfaceFile parse_sur(std::string_view bytes, const std::filesystem::path& path) {
    const ByteReader file(bytes, path);
    (void)file.bytes(0, header_size, "header");
    const auto columns = file.at<std::int32_t>(columns_at, "points a line");
    const auto rows = file.at<std::int32_t>(rows_at, "lines");
    file.check_size(static_cast<std::uint64_t>(std::max(columns, 0)), static_cast<std::uint64_t>(std::max(rows, 0)),
                    columns_at);
    const auto type = file.at<std::int16_t>(type_at, "type");
    if (type != surface_type && !(type == profile_type && rows > 1))
        file.fail(type_at, "type", fmt::format("{}", type), "2, a surface", "Export a single surface.");
    const auto bits = file.at<std::int16_t>(bits_at, "bits a point");
    if (bits != 16 && bits != 32)
        file.fail(bits_at, "bits a point", fmt::format("{}", bits), "16 or 32");
    const std::uint64_t size =
        static_cast<std::uint64_t>(columns) * static_cast<std::uint64_t>(rows) * static_cast<std::uint64_t>(bits / 8);

    SurfaceFile result;
    const auto length = [&](std::size_t offset, double unit, const char* what) {
        const double value = static_cast<double>(file.at<float>(offset, what)) * unit;
        if (!std::isfinite(value))
            file.fail(offset, what, fmt::format("{}", value), "a finite length");
        return value;
    };
    const double x_unit = unit_at(file, dx_unit_at), y_unit = unit_at(file, dy_unit_at),
                 z_unit = unit_at(file, dz_unit_at);
    result.map.pitch_x = length(dx_at, x_unit, "spacing along x");
    result.map.pitch_y = length(dy_at, y_unit, "spacing along y");
    file.check_spacing(result.map.pitch_x, "spacing along x", dx_at);
    file.check_spacing(result.map.pitch_y, "spacing along y", dy_at);
    result.map.x0 = length(x0_at, x_unit, "x of the first point");
    result.map.y0 = length(y0_at, y_unit, "y of the first point");
    const double step = length(dz_at, z_unit, "step of z"), z0 = length(z0_at, z_unit, "height of 0");
    if (step == 0)
        file.fail(dz_at, "step of z", "0", "another number");

    const std::size_t comment_length = file.at<std::uint16_t>(comment_length_at, "length of the comment");
    const std::size_t data = header_size + comment_length + file.at<std::uint16_t>(private_length_at, "private zone");
    const auto comment = file.bytes(header_size, comment_length, "comment");
    std::string unpacked_points;
    std::string_view points;
    if (bytes.starts_with(packed_magic)) {
        file.check_packing(size / static_cast<std::uint64_t>(bits / 8) * sizeof(double), "packed points");
        unpacked_points = unpacked(file, data, size);
        points = unpacked_points;
    } else
        points = file.bytes(data, size, "points");
    // If all points are measured, no value marks a gap; this one never occurs.
    const std::int64_t not_measured = file.at<std::int16_t>(special_points_at, "special points") == 1
                                          ? std::int64_t{file.at<std::int32_t>(z_min_at, "lowest point")} - 2
                                          : std::numeric_limits<std::int64_t>::min();
    result.map.height = Grid<double>(columns, rows);
    (bits == 16 ? read_sur_heights<std::int16_t> : read_sur_heights<std::int32_t>)(points, not_measured, step, z0,
                                                                                   result.map.height);
    invert(file.at<std::int16_t>(inversion_at, "inversion"), result.map.height);

    if (const auto objects = file.at<std::int16_t>(object_count_at, "objects"); objects > 1)
        result.warnings.push_back(fmt::format("{}: the first of its {} surfaces is read", path.string(), objects));

    result.provenance = parse_provenance(comment);
    const auto known = [&](std::string& member, std::size_t offset) {
        if (member.empty())
            member = plain_line(file.bytes(offset, name_length, "name"));
    };
    known(result.provenance.creator, operator_name_at);
    known(result.provenance.model, object_name_at);
    const auto part = [&](std::size_t k) { return int{file.at<std::int16_t>(second_at + 2 * k, "date")}; };
    const DateTime date{part(5), part(4), part(3), part(2), part(1), part(0)};
    if (result.provenance.date.empty() && date.valid())
        result.provenance.date = known_date(date.text());
    return result;
}

std::string sur_bytes(const HeightMap& map, const Provenance& provenance) {
    const int exponent = exponent_of_steps(map);
    std::vector<std::int32_t> points;
    points.reserve(map.height.values.size());
    // The format marks a gap by a value below all heights, which is known after the last of them: until then by this
    // one.
    constexpr std::int32_t gap = std::numeric_limits<std::int32_t>::max();
    std::int32_t lowest = 0, highest = 0;
    bool first = true, gaps = false;
    for (int row = map.rows() - 1; row >= 0; --row)
        for (int column = 0; column < map.columns(); ++column) {
            const double height = map.height(column, row);
            if (!std::isfinite(height)) {
                points.push_back(gap);
                gaps = true;
                continue;
            }
            points.push_back(static_cast<std::int32_t>(std::nearbyint(std::ldexp(height, -exponent))));
            lowest = first ? points.back() : std::min(lowest, points.back());
            highest = first ? points.back() : std::max(highest, points.back());
            first = false;
        }
    std::ranges::replace(points, gap, lowest - 2);

    // The comment is cut and normalized again, since a cut may end in white space.
    constexpr std::size_t longest_comment = std::numeric_limits<std::int16_t>::max() - 1;
    const std::string comment =
        provenance_text(parse_provenance(provenance_text(provenance).substr(0, longest_comment)));
    std::string bytes(header_size, '\0');
    const auto put = [&](std::size_t offset, auto value) { std::memcpy(bytes.data() + offset, &value, sizeof value); };
    const auto put_text = [&](std::size_t offset, std::size_t length, std::string_view text) {
        text = text.substr(0, length);
        std::ranges::fill_n(bytes.begin() + static_cast<std::ptrdiff_t>(offset), static_cast<std::ptrdiff_t>(length),
                            ' ');
        std::ranges::copy(text, bytes.begin() + static_cast<std::ptrdiff_t>(offset));
    };
    std::ranges::copy(sur_magic, bytes.begin());
    put(object_count_at, std::int16_t{1});
    put(version_at, std::int16_t{1});
    put(type_at, surface_type);
    put_text(object_name_at, name_length, plain_line(provenance.model));
    put_text(operator_name_at, name_length, plain_line(provenance.creator));
    put(special_points_at, static_cast<std::int16_t>(gaps ? 1 : 0));
    put(absolute_at, std::int16_t{1});
    put(bits_at, std::int16_t{32});
    put(z_min_at, lowest);
    put(z_max_at, highest);
    put(columns_at, std::int32_t{map.columns()});
    put(rows_at, std::int32_t{map.rows()});
    put(count_at, static_cast<std::int32_t>(points.size()));
    put(dx_at, static_cast<float>(map.pitch_x));
    put(dy_at, static_cast<float>(map.pitch_y));
    put(dz_at, static_cast<float>(std::ldexp(1.0, exponent)));
    put_text(x_name_at, axis_length, "X");
    put_text(y_name_at, axis_length, "Y");
    put_text(z_name_at, axis_length, "Z");
    for (const std::size_t unit : {dx_unit_at, dy_unit_at, dz_unit_at, x_unit_at, y_unit_at, z_unit_at})
        put_text(unit, axis_length, "mm");
    for (const std::size_t ratio : {x_ratio_at, y_ratio_at, z_ratio_at})
        put(ratio, 1.0f);
    if (const DateTime date = date_time(provenance.date); !known_date(provenance.date).empty()) {
        std::size_t offset = second_at;
        for (const int part : {date.second, date.minute, date.hour, date.day, date.month, date.year}) {
            put(offset, static_cast<std::int16_t>(part));
            offset += sizeof(std::int16_t);
        }
    }
    put(comment_length_at, static_cast<std::int16_t>(comment.size()));
    put(x0_at, static_cast<float>(map.x0));
    put(y0_at, static_cast<float>(map.y0));
    bytes += comment;
    bytes.append(reinterpret_cast<const char*>(points.data()), points.size() * sizeof(std::int32_t));
    return bytes;
}

} // namespace vkfv::surface
