// Where a surface comes from: what the metadata of a surface file say beside the heights.
#pragma once

#include <string>
#include <string_view>

namespace vkfv::surface {

// Empty means not known.
struct Provenance {
    std::string creator{};                                    // program or person
    std::string manufacturer{}, model{}, serial{}, version{}; // of the instrument
    std::string date{};    // of the measurement, xsd:dateTime ("2026-01-31T12:00:00Z")
    std::string comment{}; // lines

    bool operator==(const Provenance&) const = default;
};

// Lines "key=value" of what is known, the comment last; for formats that have one text for all of it.
std::string provenance_text(const Provenance& provenance);
// Reads such lines wherever they start in `text`. In a text without them all is comment.
Provenance parse_provenance(std::string_view text);

// What every format can hold: other characters than printable ASCII become "?", white space one blank, none at the
// ends.
std::string plain_line(std::string_view text);
// The same of several lines.
std::string plain_lines(std::string_view text);

// Parts of an xsd:dateTime without its zone and fractions of a second.
struct DateTime {
    int year = 1970, month = 1, day = 1, hour = 0, minute = 0, second = 0;

    bool operator==(const DateTime&) const = default;
    bool valid() const;       // years from 1 to 9999
    std::string text() const; // as xsd:dateTime, in UTC
};
// What formats that cannot leave the date out get for one that is unknown or damaged: 1970-01-01T00:00:00.
DateTime date_time(std::string_view text);
// The date in the environment variable SOURCE_DATE_EPOCH, seconds since 1970 in UTC, which makes results the same
// whenever they are made; empty without one, and for one that is no such number.
std::string source_date();
// The same as a text, which is empty for that date.
std::string known_date(std::string_view text);

} // namespace vkfv::surface
