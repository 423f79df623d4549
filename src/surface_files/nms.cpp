#include "surface_files/instruments.hpp"

#include "core/mathematics/units.hpp"
#include "core/parsing/byte_reader.hpp"
#include "surface_files/lengths.hpp"

namespace vkfv::surface {
namespace {

// Offsets of the header's fields, in bytes. The codes of the lowest and the highest point correspond to the header's
// two heights.
constexpr std::string_view program = "OM_MS_";
constexpr std::size_t lowest_code_at = 8, highest_code_at = 12, lowest_at = 16, highest_at = 24, program_at = 32,
                      date_at = 1076, date_length = 16, data_offset_at = 1352, point_bytes_at = 1356, columns_at = 1368,
                      rows_at = 1372, pitch_x_at = 1376, pitch_y_at = 1384;

} // namespace

bool looks_like_nms(std::string_view bytes) {
    return bytes.size() > program_at && bytes.substr(program_at).starts_with(program);
}

SurfaceFile parse_nms(std::string_view bytes, const std::filesystem::path& path) {
    const ByteReader file(bytes, path);
    const auto columns = file.at<std::uint32_t>(columns_at, "columns"), rows = file.at<std::uint32_t>(rows_at, "rows");
    file.check_size(columns, rows, columns_at);
    if (const auto point_bytes = file.at<std::uint32_t>(point_bytes_at, "bytes a point");
        point_bytes != sizeof(std::uint16_t))
        file.fail(point_bytes_at, "bytes a point", fmt::format("{}", point_bytes), "2");
    const auto points = file.bytes(file.at<std::uint32_t>(data_offset_at, "offset of the points"),
                                   std::uint64_t{columns} * rows * sizeof(std::uint16_t), "points");
    const double lowest = file.at<double>(lowest_at, "lowest height") * mm_per_um,
                 highest = file.at<double>(highest_at, "highest height") * mm_per_um;
    if (!std::isfinite(lowest) || !std::isfinite(highest) || !std::isfinite(highest - lowest) || highest < lowest)
        file.fail(lowest_at, "heights", fmt::format("from {} to {}", lowest, highest), "a range of heights");
    const auto lowest_code = static_cast<double>(file.at<std::uint32_t>(lowest_code_at, "lowest code")),
               highest_code = static_cast<double>(file.at<std::uint32_t>(highest_code_at, "highest code"));
    if (highest_code <= lowest_code)
        file.fail(lowest_code_at, "codes", fmt::format("from {} to {}", lowest_code, highest_code), "a range of codes");

    SurfaceFile result;
    result.map.pitch_x = file.at<double>(pitch_x_at, "pitch along x") * mm_per_nm;
    result.map.pitch_y = file.at<double>(pitch_y_at, "pitch along y") * mm_per_nm;
    file.check_spacing(result.map.pitch_x, "pitch along x", pitch_x_at);
    file.check_spacing(result.map.pitch_y, "pitch along y", pitch_y_at);
    const double step = (highest - lowest) / (highest_code - lowest_code);
    result.map.height = Grid<double>(static_cast<int>(columns), static_cast<int>(rows));
    std::size_t index = 0;
    for (int row = result.map.rows() - 1; row >= 0; --row)
        for (int column = 0; column < result.map.columns(); ++column, ++index)
            result.map.height(column, row) =
                lowest + step * (static_cast<double>(element<std::uint16_t>(points, index)) - lowest_code);
    result.provenance.manufacturer = "NanoFocus";
    // The file's date has the form "2022-02-09T13:25", without seconds.
    result.provenance.date = known_date(plain_line(file.bytes(date_at, date_length, "date")) + ":00");
    return result;
}

} // namespace vkfv::surface
