#include "report/page.hpp"

#include "report/markup.hpp"
#include "report/png.hpp"

#include <fmt/format.h>

namespace vkfv::report {

namespace {

constexpr const char* style =
    "body { font: 15px/1.45 Helvetica, Arial, 'DejaVu Sans', sans-serif; color: #111; max-width: 1100px; margin: 2em "
    "auto; "
    "padding: 0 1em }\n"
    "h1 { font-size: 24px } h2 { font-size: 18px; margin-top: 2em }\n"
    "table { border-collapse: collapse; font-variant-numeric: tabular-nums }\n"
    "th, td { padding: 2px 14px 2px 0; text-align: right; border-bottom: 1px solid #ddd }\n"
    "th:first-child, td:first-child { text-align: left } th { color: #555; font-weight: normal }\n"
    "img { max-width: 100%; height: auto } pre { font-size: 13px; overflow-x: auto }\n";

} // namespace

void Page::heading(std::string_view text) {
    body_ += fmt::format("<h2>{}</h2>\n", escaped(text));
}

void Page::paragraph(std::string_view text) {
    body_ += fmt::format("<p>{}</p>\n", escaped(text));
}

void Page::table(const std::vector<std::vector<std::string>>& rows) {
    body_ += "<table>\n";
    for (std::size_t row = 0; row < rows.size(); ++row) {
        const char* cell = row == 0 ? "th" : "td";
        body_ += "<tr>";
        for (const std::string& text : rows[row])
            body_ += fmt::format("<{0}>{1}</{0}>", cell, escaped(text));
        body_ += "</tr>\n";
    }
    body_ += "</table>\n";
}

void Page::picture(std::string_view svg, std::string_view what_it_shows) {
    // An image of its own: identifiers within it do not meet those of other pictures.
    body_ += fmt::format("<p><img alt=\"{}\" src=\"data:image/svg+xml;base64,{}\"/></p>\n", escaped(what_it_shows),
                         base64(std::string(svg)));
}

void Page::folded(std::string_view title, std::string_view lines) {
    body_ += fmt::format("<details><summary>{}</summary><pre>{}</pre></details>\n", escaped(title), escaped(lines));
}

std::string Page::document(std::string_view title) const {
    return fmt::format("<!DOCTYPE html>\n<html lang=\"en\">\n<head>\n<meta charset=\"utf-8\"/>\n<title>{0}</title>\n"
                       "<style>\n{1}</style>\n</head>\n<body>\n<h1>{0}</h1>\n{2}</body>\n</html>\n",
                       escaped(title), style, body_);
}

} // namespace vkfv::report
