#include "surface_files/instruments.hpp"

#include "core/parsing/byte_reader.hpp"
#include "surface/metres.hpp"
#include "surface_files/metropro_facts.hpp"

#include <algorithm>
#include <array>

namespace vkfv::surface {
namespace {

// Offsets of the header's fields, in bytes.
constexpr std::string_view metropro_magic = "\x88\x1b\x03";
constexpr char first_format = 0x6f, last_format = 0x71; // the fourth byte: format 1, 2 or 3
constexpr std::size_t format_at = 4, header_size_at = 6, intensity_bytes_at = 60, columns_at = 68, rows_at = 70,
                      time_at = 76, comment_at = 80, comment_length = 82, scale_at = 164, wavelength_at = 168,
                      obliquity_at = 176, pitch_at = 184, resolution_at = 218, inverted_at = 232, serial_at = 242,
                      least_header = 570;

template <class Value>
Value swapped(Value value) {
    auto bytes = std::bit_cast<std::array<char, sizeof(Value)>>(value);
    std::ranges::reverse(bytes);
    return std::bit_cast<Value>(bytes);
}

template <class Value>
Value big_endian(const ByteReader& file, std::uint64_t offset, const char* what) {
    return swapped(file.at<Value>(offset, what));
}

} // namespace

bool looks_like_metropro(std::string_view bytes) {
    return bytes.size() > metropro_magic.size() && bytes.starts_with(metropro_magic) &&
           bytes[metropro_magic.size()] >= first_format && bytes[metropro_magic.size()] <= last_format;
}

SurfaceFile parse_metropro(std::string_view bytes, const std::filesystem::path& path) {
    const ByteReader file(bytes, path);
    (void)file.bytes(0, least_header, "header");
    if (const auto format = big_endian<std::int16_t>(file, format_at, "format"); format < 1 || format > 3)
        file.fail(format_at, "format", fmt::format("{}", format), "1, 2 or 3");
    const auto header = big_endian<std::uint32_t>(file, header_size_at, "length of the header");
    if (header < least_header)
        file.fail(header_size_at, "length of the header", fmt::format("{}", header), "at least 570");
    const auto columns = big_endian<std::uint16_t>(file, columns_at, "columns"),
               rows = big_endian<std::uint16_t>(file, rows_at, "rows");
    file.check_size(columns, rows, columns_at);
    const auto points =
        file.bytes(std::uint64_t{header} + big_endian<std::uint32_t>(file, intensity_bytes_at, "intensities"),
                   std::uint64_t{columns} * rows * sizeof(std::int32_t), "phases");

    SurfaceFile result;
    const auto length = [&](std::size_t offset, const char* what) {
        return static_cast<double>(big_endian<float>(file, offset, what));
    };
    const double pitch = mm_from_metres(length(pitch_at, "lateral resolution"));
    if (!(pitch > 0))
        file.fail(pitch_at, "lateral resolution", fmt::format("{}", pitch), "a positive length",
                  "Calibrate the lateral scale in MetroPro and save the data anew.");
    file.check_spacing(pitch, "lateral resolution", pitch_at);
    result.map.pitch_x = result.map.pitch_y = pitch;
    const auto resolution = big_endian<std::uint16_t>(file, resolution_at, "phase resolution");
    if (resolution >= metropro::resolutions.size())
        file.fail(resolution_at, "phase resolution", fmt::format("{}", resolution), "0, 1 or 2");
    const double sign = big_endian<std::int16_t>(file, inverted_at, "inversion") != 0 ? -1 : 1;
    const double step = sign * length(scale_at, "scale") * length(obliquity_at, "obliquity") *
                        length(wavelength_at, "wavelength") / metropro::resolutions[resolution]; // metres
    if (!std::isfinite(step) || step == 0)
        file.fail(scale_at, "scale, wavelength, obliquity", fmt::format("{}", step), "a step of heights");
    result.map.height = Grid<double>(columns, rows);
    std::size_t index = 0;
    for (int row = result.map.rows() - 1; row >= 0; --row)
        for (int column = 0; column < result.map.columns(); ++column, ++index) {
            const std::int32_t phase = swapped(element<std::int32_t>(points, index));
            result.map.height(column, row) = phase >= metropro::first_not_measured
                                                 ? std::numeric_limits<double>::quiet_NaN()
                                                 : height_from_metres(step * phase);
        }
    const auto comment = file.bytes(comment_at, comment_length, "comment");
    result.provenance = {.creator = "MetroPro",
                         .manufacturer = "Zygo",
                         .date = metropro::date_after_1970(big_endian<std::int32_t>(file, time_at, "time")),
                         .comment = plain_line(comment.substr(0, comment.find('\0')))};
    if (const auto serial = big_endian<std::uint16_t>(file, serial_at, "serial number"); serial > 0)
        result.provenance.serial = fmt::format("{}", serial);
    return result;
}

} // namespace vkfv::surface
