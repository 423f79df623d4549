#include "surface_files/instruments.hpp"

#include "core/mathematics/units.hpp"
#include "core/parsing/byte_reader.hpp"
#include "surface_files/lengths.hpp"

#include <algorithm>
#include <array>

namespace vkfv::surface {
namespace {

// Offsets of the header's fields, in bytes; the header begins with a date as C's ctime() writes it.
constexpr std::size_t date_length = 128, comment_at = 132, comment_length = 256, pitch_x_at = 404, pitch_y_at = 408,
                      type_at = 428, layers_at = 489, rows_at = 500, columns_at = 504, data_at = 508;
constexpr std::uint32_t image_type = 0, topography_type = 3;
constexpr float not_measured = 1000001;
constexpr std::array<std::string_view, 7> days = {"Mon", "Tue", "Wed", "Thu", "Fri", "Sat", "Sun"};
constexpr std::array<std::string_view, 12> months = {"Jan", "Feb", "Mar", "Apr", "May", "Jun",
                                                     "Jul", "Aug", "Sep", "Oct", "Nov", "Dec"};

// Parses a date such as "Mon Apr 19 11:40:13 2021"; none if the text is no date.
std::optional<DateTime> date_in(std::string_view bytes) {
    constexpr std::size_t length = 24;
    if (bytes.size() < length || std::ranges::find(days, bytes.substr(0, 3)) == days.end())
        return std::nullopt;
    const auto part = [&](std::size_t begin, std::size_t size) {
        return number_in<int>(bytes.substr(begin, size)).value_or(-1);
    };
    const auto month = static_cast<int>(std::ranges::find(months, bytes.substr(4, 3)) - months.begin()) + 1;
    const DateTime date{part(20, 4), month, part(8, 2), part(11, 2), part(14, 2), part(17, 2)};
    return date.valid() ? std::optional(date) : std::nullopt;
}

} // namespace

bool looks_like_plu(std::string_view bytes) {
    return bytes.size() > data_at && date_in(bytes) &&
           bytes.substr(0, date_length).find('\0') != std::string_view::npos;
}

SurfaceFile parse_plu(std::string_view bytes, const std::filesystem::path& path) {
    const ByteReader file(bytes, path);
    const auto type = file.at<std::uint32_t>(type_at, "type");
    if (type != topography_type && type != image_type)
        file.fail(type_at, "type", fmt::format("{}", type), "3, a topography", "Export a topography.");
    const auto rows = file.at<std::uint32_t>(rows_at, "rows"), columns = file.at<std::uint32_t>(columns_at, "columns");
    file.check_size(columns, rows, rows_at);
    const auto points = file.bytes(data_at, std::uint64_t{columns} * rows * sizeof(float), "points");
    SurfaceFile result;
    result.map.pitch_x = static_cast<double>(file.at<float>(pitch_x_at, "pitch along x")) * mm_per_um;
    result.map.pitch_y = static_cast<double>(file.at<float>(pitch_y_at, "pitch along y")) * mm_per_um;
    file.check_spacing(result.map.pitch_x, "pitch along x", pitch_x_at);
    file.check_spacing(result.map.pitch_y, "pitch along y", pitch_y_at);
    result.map.height = Grid<double>(static_cast<int>(columns), static_cast<int>(rows));
    std::size_t index = 0;
    for (int row = result.map.rows() - 1; row >= 0; --row)
        for (int column = 0; column < result.map.columns(); ++column, ++index) {
            const float um = element<float>(points, index);
            result.map.height(column, row) = um == not_measured ? std::numeric_limits<double>::quiet_NaN()
                                                                : height_from(static_cast<double>(um), mm_per_um);
        }
    if (const int layers = file.at<std::uint8_t>(layers_at, "layers"); layers > 1)
        result.warnings.push_back(fmt::format("{}: the first of its {} layers is read", path.string(), layers));
    result.provenance.manufacturer = "Sensofar";
    if (const auto date = date_in(bytes))
        result.provenance.date = known_date(date->text());
    const auto comment = file.bytes(comment_at, comment_length, "comment");
    result.provenance.comment = plain_line(comment.substr(0, comment.find('\0')));
    return result;
}

} // namespace vkfv::surface
