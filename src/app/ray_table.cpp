#include "app/ray_table.hpp"

#include "core/error.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>
#include <fstream>
#include <iterator>

namespace vkfv::app {

namespace {

constexpr std::array<std::string_view, 6> columns = {"x_mm", "y_mm", "z_mm", "l", "m", "n"};
constexpr std::string_view header = "x_mm,y_mm,z_mm,l,m,n";
constexpr double unit_length_tolerance = 1e-6; // directions written with seven digits pass

std::string_view trimmed(std::string_view text) {
    const auto first = text.find_first_not_of(" \t");
    return first == std::string_view::npos ? std::string_view()
                                           : text.substr(first, text.find_last_not_of(" \t") - first + 1);
}

class Row {
  public:
    Row(const std::filesystem::path& file, int line, std::string_view text)
        : file_(file), line_(line), text_(text) {}

    [[noreturn]] void fail(std::size_t column, std::string_view key, std::string_view found,
                           std::string expected, std::string remedy) const {
        SourceLocation where;
        where.file = file_;
        where.line = line_;
        where.column = static_cast<int>(column) + 1;
        throw InputError({.where = where,
                          .key = std::string(key),
                          .found = fmt::format("\"{:.60}\"", found),
                          .expected = std::move(expected),
                          .remedy = std::move(remedy)});
    }

    std::array<double, columns.size()> numbers() const {
        std::array<double, columns.size()> values{};
        std::size_t begin = 0;
        for (std::size_t i = 0; i < columns.size(); ++i) {
            const bool last = i + 1 == columns.size();
            const std::size_t comma = text_.find(',', begin);
            if (last != (comma == std::string_view::npos)) {
                fail(last ? comma : text_.size(), columns[i], text_, "six numbers: " + std::string(header),
                     last ? "Remove what follows the sixth number." : "Add the missing numbers.");
            }
            const std::string_view field = text_.substr(begin, last ? std::string_view::npos : comma - begin);
            std::string_view digits = trimmed(field);
            if (digits.starts_with('+')) {
                digits.remove_prefix(1);
            }
            const auto [end, code] = std::from_chars(digits.data(), digits.data() + digits.size(), values[i]);
            if (code != std::errc() || end != digits.data() + digits.size() || !std::isfinite(values[i])) {
                fail(begin, columns[i], trimmed(field), "a finite number", "Correct this field.");
            }
            begin = comma + 1;
        }
        return values;
    }

  private:
    const std::filesystem::path& file_;
    int line_;
    std::string_view text_;
};

} // namespace

std::vector<trace::RayInput> read_ray_table(const std::filesystem::path& file) {
    std::ifstream stream(file);
    if (!stream || std::filesystem::is_directory(file)) {
        SourceLocation where;
        where.file = file;
        throw InputError({.where = where,
                          .key = "--trace-rays",
                          .found = "no readable file",
                          .expected = "a CSV file with the columns " + std::string(header),
                          .remedy = "Check the path and its permissions."});
    }
    std::vector<trace::RayInput> rays;
    std::string line;
    for (int number = 1; std::getline(stream, line); ++number) {
        if (line.ends_with('\r')) {
            line.pop_back();
        }
        const Row row(file, number, line);
        if (number == 1) {
            std::string compact;
            std::copy_if(line.begin(), line.end(), std::back_inserter(compact),
                         [](char character) { return character != ' ' && character != '\t'; });
            if (compact != header) {
                row.fail(0, "header", line, "the columns " + std::string(header),
                         "Name these columns, in this order, in the first line.");
            }
            continue;
        }
        if (trimmed(line).empty()) {
            continue;
        }
        const auto [x, y, z, l, m, n] = row.numbers();
        const double length = std::hypot(l, m, n);
        if (std::abs(length - 1) > unit_length_tolerance) {
            row.fail(0, "l,m,n", fmt::format("length {}", length), "direction cosines: a vector of length 1",
                     "Normalise the direction.");
        }
        rays.push_back({x, y, z, l / length, m / length, n / length});
    }
    if (rays.empty()) {
        Row(file, 1, "")
            .fail(0, "rays", "", "at least one ray below the header", "Add a line with six numbers.");
    }
    return rays;
}

std::string ray_table_text(std::span<const trace::TracedRay> rays) {
    std::string text = "x_mm,y_mm,l,m,n,opl_mm,status\n";
    for (const auto& ray : rays) {
        fmt::format_to(std::back_inserter(text), "{:.17g},{:.17g},{:.17g},{:.17g},{:.17g},{:.17g},{}\n",
                       ray.x, ray.y, ray.l, ray.m, ray.n, ray.path_length, ray.status);
    }
    return text;
}

} // namespace vkfv::app
