#include "surface_files/provenance.hpp"

#include <fmt/format.h>

#include <array>
#include <charconv>
#include <chrono>
#include <cstdint>
#include <cstdio>
#include <cstdlib>
#include <utility>

namespace vkfv::surface {
namespace {

constexpr std::array lines_of = {
    std::pair{"creator", &Provenance::creator}, std::pair{"manufacturer", &Provenance::manufacturer},
    std::pair{"model", &Provenance::model},     std::pair{"serial", &Provenance::serial},
    std::pair{"version", &Provenance::version}, std::pair{"date", &Provenance::date}};

constexpr std::string_view comment_key = "comment=";

std::string trimmed(std::string_view text) {
    const auto begin = text.find_first_not_of(" \n");
    return begin == std::string_view::npos ? std::string()
                                           : std::string(text.substr(begin, text.find_last_not_of(" \n") + 1 - begin));
}

} // namespace

std::string provenance_text(const Provenance& provenance) {
    std::string text;
    for (const auto& [key, member] : lines_of)
        if (const std::string value =
                member == &Provenance::date ? known_date(provenance.date) : plain_line(provenance.*member);
            !value.empty())
            text += fmt::format("{}={}\n", key, value);
    if (const std::string comment = plain_lines(provenance.comment); !comment.empty())
        text += fmt::format("{}{}\n", comment_key, comment);
    return text;
}

Provenance parse_provenance(std::string_view text) {
    Provenance provenance;
    bool found = false;
    for (std::size_t begin = 0; begin < text.size();) {
        const std::string_view rest = text.substr(begin);
        if (rest.starts_with(comment_key)) {
            provenance.comment = plain_lines(rest.substr(comment_key.size()));
            found = true;
            break;
        }
        const std::string_view line = rest.substr(0, rest.find('\n'));
        for (const auto& [key, member] : lines_of)
            if (line.starts_with(key) && line.substr(std::string_view(key).size()).starts_with('=')) {
                provenance.*member = plain_line(line.substr(std::string_view(key).size() + 1));
                found = true;
            }
        begin += line.size() + 1;
    }
    if (!found)
        provenance.comment = plain_lines(text);
    provenance.date = known_date(provenance.date);
    return provenance;
}

std::string plain_line(std::string_view text) {
    std::string result;
    for (const char c : text) {
        const bool blank = c == ' ' || c == '\t' || c == '\n' || c == '\r' || c == '\0';
        if (blank && (result.empty() || result.back() == ' '))
            continue;
        result += blank ? ' ' : c > ' ' && c <= '~' ? c : '?';
    }
    return trimmed(result);
}

std::string plain_lines(std::string_view text) {
    std::string result;
    for (std::size_t begin = 0; begin < text.size();) {
        const std::string_view line = text.substr(begin, text.substr(begin).find('\n'));
        result += plain_line(line) + '\n';
        begin += line.size() + 1;
    }
    return trimmed(result);
}

bool DateTime::valid() const {
    const auto ymd = std::chrono::year(year) / month / day;
    return year >= 1 && year <= 9999 && month >= 1 && day >= 1 && ymd.ok() && hour >= 0 && hour < 24 && minute >= 0 &&
           minute < 60 && second >= 0 && second < 60;
}

std::string DateTime::text() const {
    return fmt::format("{:04}-{:02}-{:02}T{:02}:{:02}:{:02}Z", year, month, day, hour, minute, second);
}

DateTime date_time(std::string_view text) {
    DateTime result;
    const std::string copy(text);
    if (std::sscanf(copy.c_str(), "%4d-%2d-%2dT%2d:%2d:%2d", &result.year, &result.month, &result.day, &result.hour,
                    &result.minute, &result.second) != 6 ||
        !result.valid())
        return {};
    return result;
}

std::string source_date() {
    const char* variable = std::getenv("SOURCE_DATE_EPOCH");
    const std::string_view text = variable ? variable : "";
    std::int64_t seconds = -1;
    const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), seconds);
    constexpr std::int64_t last = 253402300799; // end of the year 9999
    if (error != std::errc() || end != text.data() + text.size() || seconds < 0 || seconds > last) {
        return {};
    }
    const std::chrono::sys_seconds time{std::chrono::seconds(seconds)};
    const auto day = std::chrono::floor<std::chrono::days>(time);
    const std::chrono::year_month_day date(day);
    const std::chrono::hh_mm_ss clock(time - day);
    return DateTime{static_cast<int>(date.year()),
                    static_cast<int>(static_cast<unsigned>(date.month())),
                    static_cast<int>(static_cast<unsigned>(date.day())),
                    static_cast<int>(clock.hours().count()),
                    static_cast<int>(clock.minutes().count()),
                    static_cast<int>(clock.seconds().count())}
        .text();
}

std::string known_date(std::string_view text) {
    const DateTime date = date_time(text);
    return date == DateTime{} ? std::string() : date.text();
}

} // namespace vkfv::surface
