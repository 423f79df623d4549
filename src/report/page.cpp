#include "report/page.hpp"

#include "report/markup.hpp"
#include "report/page_files.hpp"
#include "report/png.hpp"

#include <fmt/format.h>

#include <algorithm>

namespace vkfv::report {

namespace {

// Embedded libraries, with the texts that their licences require.
struct Library {
    std::string_view script;
    std::string_view name;
    std::string_view licence;
};
constexpr Library libraries[] = {{"d3.min.js", "D3, with d3-sankey", "d3.licence"},
                                 {"three.min.js", "three.js, with OrbitControls", "three.licence"}};

std::string licences_of(const std::vector<std::string>& scripts) {
    std::string text;
    for (const Library& library : libraries) {
        if (std::ranges::find(scripts, library.script) != scripts.end()) {
            text += fmt::format("<details><summary>Licence of {}</summary><pre tabindex=\"0\">{}</pre></details>\n",
                                escaped(library.name), escaped(page_file(library.licence)));
        }
    }
    return text.empty() ? text : fmt::format("<footer>\n{}</footer>\n", text);
}

} // namespace

void Page::section(std::string_view id, std::string_view title) {
    body_ += fmt::format("{0}<section id=\"{1}\" aria-labelledby=\"{1}-title\">\n<h2 id=\"{1}-title\">{2}</h2>\n",
                         sections_.empty() ? "" : "</section>\n", id, escaped(title));
    sections_.push_back({std::string(id), std::string(title)});
}

void Page::heading(std::string_view text) {
    body_ += fmt::format("<h3>{}</h3>\n", escaped(text));
}

void Page::paragraph(std::string_view text) {
    body_ += fmt::format("<p>{}</p>\n", escaped(text));
}

void Page::table(std::string_view caption, const std::vector<std::vector<std::string>>& rows) {
    // The table can be scrolled by the keyboard where the page is too narrow for it.
    body_ += fmt::format("<div class=\"wide\" tabindex=\"0\" role=\"region\" aria-label=\"{0}\">\n<table>\n"
                         "<caption>{0}</caption>\n",
                         escaped(caption));
    for (std::size_t row = 0; row < rows.size(); ++row) {
        body_ += "<tr>";
        for (std::size_t column = 0; column < rows[row].size(); ++column) {
            const bool names = row == 0 || column == 0;
            const bool nothing = row == 0 && rows[row][column].empty();
            const char* scope = row == 0 ? " scope=\"col\"" : " scope=\"row\"";
            body_ += nothing ? "<td></td>"
                             : fmt::format("<{0}{1}>{2}</{0}>", names ? "th" : "td", names ? scope : "",
                                           escaped(rows[row][column]));
        }
        body_ += "</tr>\n";
    }
    body_ += "</table>\n</div>\n";
}

void Page::picture(std::string_view svg, std::string_view what_it_shows) {
    // The picture is an image of its own, so that its identifiers do not clash with those of other pictures. It can be
    // scrolled where the page is too narrow for its texts.
    body_ +=
        fmt::format("<p class=\"wide\" tabindex=\"0\" role=\"region\" aria-label=\"Drawing\"><img class=\"drawing\" "
                    "alt=\"{}\" src=\"data:image/svg+xml;base64,{}\"/></p>\n",
                    escaped(what_it_shows), base64(std::string(svg)));
}

void Page::folded(std::string_view title, std::string_view lines) {
    body_ += fmt::format("<details><summary>{}</summary><pre tabindex=\"0\">{}</pre></details>\n", escaped(title),
                         escaped(lines));
}

void Page::part(std::string_view file) {
    body_ += page_file(file);
}

void Page::data(std::string_view id, std::string_view text) {
    data_ += fmt::format("<script type=\"text/plain\" id=\"{}\">{}</script>\n", id, text);
}

void Page::script(std::string_view file) {
    scripts_.emplace_back(file);
}

std::string Page::document(std::string_view title, std::string_view summary) const {
    std::string links;
    for (const Section& section : sections_) {
        links += fmt::format("<li><a href=\"#{}\">{}</a></li>\n", section.id, escaped(section.title));
    }
    std::string text =
        fmt::format("<!DOCTYPE html>\n<html lang=\"en\">\n<head>\n<meta charset=\"utf-8\"/>\n"
                    "<meta name=\"viewport\" content=\"width=device-width, initial-scale=1\"/>\n"
                    "<meta name=\"color-scheme\" content=\"light dark\"/>\n<title>{0}</title>\n"
                    "<style>/*<![CDATA[*/\n{1}/*]]>*/</style>\n</head>\n<body>\n<header>\n<h1>{0}</h1>\n{3}"
                    "<nav aria-label=\"Sections\">\n<ul>\n{2}</ul>\n</nav>\n</header>\n<main>\n",
                    escaped(title), page_file("page.css"), links,
                    summary.empty() ? "" : fmt::format("<p id=\"summary\">{}</p>\n", escaped(summary)));
    text += body_;
    text += fmt::format("{}</main>\n{}", sections_.empty() ? "" : "</section>\n", licences_of(scripts_));
    text += data_;
    for (const std::string& script : scripts_) {
        text += "<script>/*<![CDATA[*/\n";
        text += page_file(script);
        text += "\n/*]]>*/</script>\n";
    }
    return text + "</body>\n</html>\n";
}

} // namespace vkfv::report
