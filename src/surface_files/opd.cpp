#include "surface_files/instruments.hpp"

#include "core/parsing/byte_reader.hpp"
#include "surface_files/lengths.hpp"

#include <algorithm>
#include <array>
#include <map>

namespace vkfv::surface {
namespace {

// The file begins with a directory of entries of 24 bytes: name (16), type (int16), length (uint32), flags (uint16);
// the contents of the blocks follow in the same order.
constexpr std::string_view opd_magic("\x01\0Directory", 11);
constexpr std::size_t directory_at = 2, block_length = 24, name_length = 16, length_at = 18;
constexpr std::int16_t bad_integer = 32766; // this and larger values are bad, as is the negative end
constexpr float bad_float = 1e38f;

struct Block {
    std::uint64_t offset, length;
};

class Blocks {
  public:
    explicit Blocks(const ByteReader& file) : file_(file) {
        const auto size = file.at<std::uint32_t>(directory_at + length_at, "Directory");
        (void)file.bytes(directory_at, size, "Directory");
        std::uint64_t offset = directory_at + std::uint64_t{size};
        for (std::size_t at = directory_at + block_length; at + block_length <= directory_at + size;
             at += block_length) {
            const auto name = file.bytes(at, name_length, "name of a block");
            const auto length = file.at<std::uint32_t>(at + length_at, "length of a block");
            if (length > 0)
                blocks_.try_emplace(plain_line(name.substr(0, name.find('\0'))), Block{offset, length});
            offset += length;
        }
    }
    const Block* find(const char* name) const {
        const auto block = blocks_.find(name);
        return block == blocks_.end() ? nullptr : &block->second;
    }
    template <class Value>
    std::optional<double> number(const char* name) const {
        const Block* block = find(name);
        if (!block || block->length != sizeof(Value))
            return std::nullopt;
        return static_cast<double>(file_.at<Value>(block->offset, name));
    }
    std::string text(const char* name) const {
        const Block* block = find(name);
        if (!block)
            return {};
        const auto bytes = file_.bytes(block->offset, block->length, name);
        return plain_line(bytes.substr(0, bytes.find('\0')));
    }

  private:
    const ByteReader& file_;
    std::map<std::string, Block> blocks_;
};

// Reads heights stored by columns from the lowest x, each from the lowest y.
void read_opd_heights(std::string_view points, std::size_t element_bytes, double step, Grid<double>& heights) {
    std::size_t index = 0;
    for (int column = 0; column < heights.columns; ++column)
        for (int row = 0; row < heights.rows; ++row, ++index) {
            double value = 0;
            bool measured = true;
            if (element_bytes == sizeof(std::uint8_t)) {
                value = element<std::uint8_t>(points, index); // byte values have no mark for gaps
            } else if (element_bytes == sizeof(std::int16_t)) {
                const auto stored = element<std::int16_t>(points, index);
                measured = stored < bad_integer && stored > std::numeric_limits<std::int16_t>::min();
                value = stored;
            } else {
                const auto stored = element<float>(points, index);
                measured = std::abs(stored) < bad_float;
                value = static_cast<double>(stored);
            }
            heights(column, row) = measured ? value * step : std::numeric_limits<double>::quiet_NaN();
        }
}

// Three whole numbers separated by `separator`; -1 for one that is missing or no number.
std::array<int, 3> numbers_between(std::string_view text, char separator) {
    std::array<int, 3> numbers{};
    for (int& number : numbers) {
        const std::size_t end = std::min(text.find(separator), text.size());
        number = number_in<int>(text.substr(0, end)).value_or(-1);
        text.remove_prefix(std::min(end + 1, text.size()));
    }
    return numbers;
}

// The date of the blocks "10/26/2009", month first, and "11:16:55"; Vision64 omits leading zeros.
std::string date_of_blocks(const Blocks& blocks) {
    const std::string day = blocks.text("Date"), time = blocks.text("Time");
    const auto [month, day_of_month, year] = numbers_between(day, '/');
    const auto [hour, minute, second] = numbers_between(time, ':');
    const DateTime date{year, month, day_of_month, hour, minute, second};
    return date.valid() ? known_date(date.text()) : std::string();
}

} // namespace

bool looks_like_opd(std::string_view bytes) {
    return bytes.starts_with(opd_magic);
}

SurfaceFile parse_opd(std::string_view bytes, const std::filesystem::path& path) {
    const ByteReader file(bytes, path);
    const Blocks blocks(file);
    const Block* data = nullptr;
    for (const char* name : {"RAW_DATA", "RAW DATA", "Raw", "SAMPLE_DATA", "OPD"})
        if (!data)
            data = blocks.find(name);
    if (!data)
        file.fail({}, "RAW_DATA", "no such block", "a file with heights");
    const auto columns = file.at<std::uint16_t>(data->offset, "points along x"),
               rows = file.at<std::uint16_t>(data->offset + 2, "points along y"),
               element_bytes = file.at<std::uint16_t>(data->offset + 4, "bytes a point");
    file.check_size(columns, rows, data->offset);
    if (element_bytes != sizeof(std::uint8_t) && element_bytes != sizeof(std::int16_t) &&
        element_bytes != sizeof(float))
        file.fail(data->offset + 4, "bytes a point", fmt::format("{}", element_bytes),
                  "1 (uint8), 2 (int16) or 4 (float32)");
    const auto points = file.bytes(data->offset + 6, std::uint64_t{columns} * rows * element_bytes, "points");

    SurfaceFile result;
    const auto pixel = blocks.number<float>("Pixel_size"), wavelength = blocks.number<float>("Wavelength");
    if (!pixel || !wavelength)
        file.fail({}, pixel ? "Wavelength" : "Pixel_size", "no such number", "a file with a scale");
    result.map.pitch_x = *pixel; // mm
    result.map.pitch_y = *pixel * blocks.number<float>("Aspect").value_or(1);
    file.check_spacing(result.map.pitch_x, "Pixel_size");
    file.check_spacing(result.map.pitch_y, "Aspect");
    // Values are in waves times Mult; the wavelength is in nm.
    const double step = *wavelength * mm_per_nm / blocks.number<std::int16_t>("Mult").value_or(1);
    if (!std::isfinite(step) || step == 0)
        file.fail({}, "Wavelength, Mult", fmt::format("{}", step), "a step of heights");
    result.map.height = Grid<double>(columns, rows);
    read_opd_heights(points, element_bytes, step, result.map.height);
    for (double& height : result.map.height.values)
        if (!std::isfinite(height))
            height = std::numeric_limits<double>::quiet_NaN();
    result.provenance = {.manufacturer = "Wyko",
                         .model = blocks.text("MachineID"),
                         .serial = blocks.text("SerialNum"),
                         .date = date_of_blocks(blocks),
                         .comment = blocks.text("Title")};
    return result;
}

} // namespace vkfv::surface
