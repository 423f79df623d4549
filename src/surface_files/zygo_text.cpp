#include "surface_files/instruments.hpp"

#include "core/mathematics/units.hpp"
#include "core/parsing/byte_reader.hpp"
#include "core/parsing/text_encoding.hpp"
#include "surface_files/image_scale.hpp"
#include "surface_files/lengths.hpp"
#include "surface_files/metropro_facts.hpp"

#include <algorithm>
#include <vector>

namespace vkfv::surface {
namespace {

constexpr std::string_view points_title = "Zygo XYZ Data File", phases_title = "Zygo ASCII Data File";
constexpr std::string_view separator = "#";
constexpr double nan = std::numeric_limits<double>::quiet_NaN();

// Numbers of lines, from 1, and of the fields of a line, from 0.
constexpr std::size_t phase_line = 4, comment_line = 5, serial_line = 6, optics_line = 8, resolution_line = 11,
                      least_header_lines = 12;
constexpr std::size_t phase_x = 0, phase_y = 1, phase_columns = 2, phase_rows = 3;
constexpr std::size_t scale_field = 1, wavelength_field = 2, obliquity_field = 4, pitch_field = 6, time_field = 7;
constexpr std::size_t inverted_field = 7;

std::string_view trimmed(std::string_view text) {
    const auto begin = text.find_first_not_of(" \t\r");
    return begin == std::string_view::npos ? std::string_view()
                                           : text.substr(begin, text.find_last_not_of(" \t\r") + 1 - begin);
}

// Iterates over the lines of a text.
class Lines {
  public:
    explicit Lines(std::string_view text) : rest_(text) {}

    std::optional<std::string_view> next() {
        if (rest_.empty())
            return std::nullopt;
        const std::string_view line = rest_.substr(0, rest_.find('\n'));
        rest_.remove_prefix(std::min(rest_.size(), line.size() + 1));
        ++number_;
        return trimmed(line);
    }
    int number() const { return number_; } // number of the line last returned by next()
    std::string_view rest() const { return rest_; }

  private:
    std::string_view rest_;
    int number_ = 0;
};

// The next word of a line, which is removed from the line; empty if there is none.
std::string_view word_of(std::string_view& line) {
    line = trimmed(line);
    const std::string_view word = line.substr(0, line.find_first_of(" \t"));
    line.remove_prefix(word.size());
    return word;
}

struct Header {
    std::vector<std::string_view> lines;
    const ByteReader* file;

    std::string_view line(std::size_t number) const { return lines[number - 1]; }

    std::string_view word(std::size_t number, std::size_t place) const {
        std::string_view rest = line(number), word = word_of(rest);
        for (std::size_t k = 0; k < place; ++k)
            word = word_of(rest);
        return word;
    }

    template <class Value>
    Value field(std::size_t number, std::size_t place, const char* what) const {
        const std::string_view word = this->word(number, place);
        const auto value = number_in<Value>(word);
        if (!value)
            throw InputError({.where = {.file = file->file(), .line = static_cast<int>(number)},
                              .key = what,
                              .found = word.empty() ? "nothing" : plain_line(word.substr(0, 40)),
                              .expected = "a number",
                              .remedy = "Export or copy the file anew."});
        return *value;
    }

    std::string text(std::size_t number) const {
        std::string_view text = line(number);
        if (text.size() >= 2 && text.front() == '"' && text.back() == '"')
            text = text.substr(1, text.size() - 2);
        return plain_line(text);
    }
};

Header header_of(Lines& lines, const ByteReader& file) {
    constexpr std::size_t most_lines = 64;
    Header header{.lines = {}, .file = &file};
    while (const auto line = lines.next()) {
        if (*line == separator) {
            if (header.lines.size() < least_header_lines)
                break;
            return header;
        }
        header.lines.push_back(*line);
        if (header.lines.size() > most_lines)
            break;
    }
    file.fail({}, "header", fmt::format("{} lines before \"#\"", header.lines.size()),
              "12 lines or more, which end with \"#\"");
}

[[noreturn]] void fail_at(const ByteReader& file, int line, std::string found, std::string expected) {
    throw InputError({.where = {.file = file.file(), .line = line},
                      .key = "data",
                      .found = std::move(found),
                      .expected = std::move(expected),
                      .remedy = "Export or copy the file anew."});
}

// Skips the intensities, which precede the phases and end with "#".
void skip_intensities(Lines& lines) {
    auto line = lines.next();
    while (line && *line != separator)
        line = lines.next();
}

// Reads whole numbers up to the next "#", row by row from the highest y.
void read_phases(Lines& lines, const ByteReader& file, double step, HeightMap& map) {
    std::size_t count = 0;
    const std::size_t points = map.height.values.size();
    const auto columns = static_cast<std::size_t>(map.columns());
    for (auto line = lines.next(); line && *line != separator; line = lines.next())
        for (std::string_view word = word_of(*line); !word.empty(); word = word_of(*line)) {
            const auto phase = number_in<std::int64_t>(word);
            if (!phase)
                fail_at(file, lines.number(), plain_line(word.substr(0, 40)), "a whole number");
            if (count == points)
                fail_at(file, lines.number(), fmt::format("more than {} phases", points), "as many as line 4 says");
            map.height(static_cast<int>(count % columns), map.rows() - 1 - static_cast<int>(count / columns)) =
                *phase >= metropro::first_not_measured ? nan : height_from_metres(step * static_cast<double>(*phase));
            ++count;
        }
    if (count < points)
        fail_at(file, lines.number(), fmt::format("{} phases", count), fmt::format("{}, as line 4 says", points));
}

// Reads lines of x, y and a height, or "No Data" in its place.
void read_points(Lines& lines, const Header& header, double unit, HeightMap& map) {
    const ByteReader& file = *header.file;
    const auto x0 = header.field<std::int64_t>(phase_line, phase_x, "origin of the phases");
    const auto y0 = header.field<std::int64_t>(phase_line, phase_y, "origin of the phases");
    for (auto line = lines.next(); line && *line != separator; line = lines.next()) {
        if (line->empty())
            continue;
        const auto x = number_in<std::int64_t>(word_of(*line)), y = number_in<std::int64_t>(word_of(*line));
        const std::string_view rest = trimmed(*line);
        const auto height = number_in<double>(rest);
        if (!x || !y || (!height && rest.find_first_of("0123456789") != std::string_view::npos) || rest.empty())
            fail_at(file, lines.number(), plain_line(rest.substr(0, 40)),
                    "the numbers of a pixel and its height, or No Data");
        if (*x < x0 || *x - x0 >= map.columns() || *y < y0 || *y - y0 >= map.rows())
            fail_at(file, lines.number(), fmt::format("pixel {}, {}", *x, *y), "one that line 4 names");
        map.height(static_cast<int>(*x - x0), map.rows() - 1 - static_cast<int>(*y - y0)) =
            height ? measured_height(*height, unit) : nan;
    }
}

} // namespace

bool looks_like_zygo_text(std::string_view bytes) {
    return bytes.starts_with(points_title) || bytes.starts_with(phases_title);
}

SurfaceFile parse_zygo_text(std::string_view bytes, const std::filesystem::path& path, const ImageScale& scale) {
    const std::string text = as_utf8(bytes);
    const ByteReader file(text, path);
    const bool phases = text.starts_with(phases_title);
    Lines lines(text);
    const Header header = header_of(lines, file);
    const auto columns = header.field<std::uint32_t>(phase_line, phase_columns, "columns"),
               rows = header.field<std::uint32_t>(phase_line, phase_rows, "rows");
    file.check_size(columns, rows);
    // The stated size is bounded by the file's length: a phase takes at least two bytes. Lines of points may be left
    // out, so there more points a byte are allowed.
    const std::uint64_t points = std::uint64_t{columns} * rows;
    constexpr std::uint64_t bytes_a_phase = 2, most_points_a_byte = 64;
    if (phases ? points > lines.rest().size() / bytes_a_phase + 1 : points > most_points_a_byte * lines.rest().size())
        file.fail({}, "size", fmt::format("{} x {} points in {} bytes", columns, rows, text.size()),
                  "as many as the file holds");

    SurfaceFile result;
    HeightMap& map = result.map;
    const double stated_pitch = mm_from_metres(header.field<double>(optics_line, pitch_field, "lateral resolution"));
    const bool stated = stated_pitch > 0;
    if (phases) {
        refuse_second_scale(path, {.pitch = stated ? scale.pitch : std::nullopt, .unit = scale.unit});
    } else if (stated && scale.pitch && contradicts(*scale.pitch, stated_pitch)) {
        result.warnings.push_back(fmt::format("{}: its pitch of {:.6g} um is used, not the {:.6g} um of the option",
                                              path.string(), stated_pitch * um_per_mm, *scale.pitch * um_per_mm));
    }
    if (!stated)
        check_scale(path, {.pitch = scale.pitch, .unit = 1});
    map.pitch_x = map.pitch_y = stated ? stated_pitch : *scale.pitch;
    file.check_spacing(map.pitch_x, "lateral resolution");
    map.height = Grid<double>(static_cast<int>(columns), static_cast<int>(rows), nan);

    if (phases) {
        const auto resolution = header.field<std::uint32_t>(resolution_line, 0, "phase resolution");
        if (resolution >= metropro::resolutions.size())
            file.fail({}, "phase resolution", fmt::format("{}", resolution), "0, 1 or 2");
        const double sign = header.field<int>(resolution_line, inverted_field, "inversion") != 0 ? -1 : 1;
        const double step = sign * header.field<double>(optics_line, scale_field, "scale") *
                            header.field<double>(optics_line, obliquity_field, "obliquity") *
                            header.field<double>(optics_line, wavelength_field, "wavelength") /
                            metropro::resolutions[resolution]; // metres
        if (!std::isfinite(step) || step == 0)
            file.fail({}, "scale, wavelength, obliquity", fmt::format("{}", step), "a step of heights");
        skip_intensities(lines);
        read_phases(lines, file, step, map);
    } else {
        if (!scale.unit)
            result.warnings.push_back(
                fmt::format("{}: it does not say the unit of its heights. They are taken as um, "
                            "as MetroPro writes them. --unit_um tells another, which Mx may have written",
                            path.string()));
        else
            check_scale(path, {.pitch = 1, .unit = scale.unit});
        read_points(lines, header, scale.unit.value_or(mm_per_um), map);
    }
    result.provenance = {.creator = "MetroPro",
                         .manufacturer = "Zygo",
                         .serial = header.text(serial_line),
                         .comment = header.text(comment_line)};
    if (const auto seconds = number_in<std::int32_t>(header.word(optics_line, time_field)))
        result.provenance.date = metropro::date_after_1970(*seconds);
    return result;
}

} // namespace vkfv::surface
