// The provenance of a surface: the metadata in a surface file besides the heights.
#pragma once

#include <string>
#include <string_view>

namespace vkfv::surface {

// The metadata of a surface; empty members are unknown.
struct Provenance {
    std::string creator{};                                    // program or person
    std::string manufacturer{}, model{}, serial{}, version{}; // names of the instrument
    std::string date{};    // date of the measurement, xsd:dateTime ("2026-01-31T12:00:00Z")
    std::string comment{}; // may have several lines

    bool operator==(const Provenance&) const = default;
};

// The known members as lines "key=value", the comment last; for formats with a single text for all of them.
std::string provenance_text(const Provenance& provenance);
// Parses such lines wherever they start in `text`. A text without them becomes the comment.
Provenance parse_provenance(std::string_view text);

// Reduces a text to one line that every format can hold: characters other than printable ASCII become "?", white space
// becomes one blank, blanks at the ends are removed.
std::string plain_line(std::string_view text);
// Applies plain_line() to each line of a text.
std::string plain_lines(std::string_view text);

// Parts of an xsd:dateTime without its zone and fractions of a second.
struct DateTime {
    int year = 1970, month = 1, day = 1, hour = 0, minute = 0, second = 0;

    bool operator==(const DateTime&) const = default;
    bool valid() const;       // also false for years outside 1 to 9999
    std::string text() const; // xsd:dateTime in UTC
};
// Parses a date for formats that cannot omit it; an unknown or damaged date becomes 1970-01-01T00:00:00.
DateTime date_time(std::string_view text);
// The date in the environment variable SOURCE_DATE_EPOCH, seconds since 1970 in UTC, which makes results reproducible
// at any time; empty if it is unset or no such number.
std::string source_date();
// The date as text; empty for 1970-01-01T00:00:00, which means unknown.
std::string known_date(std::string_view text);

} // namespace vkfv::surface
