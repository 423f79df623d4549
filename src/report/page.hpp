// A page of HTML, also well-formed XML, that contains all it shows: texts, pictures, data, scripts and their licences.
// Equal calls give equal bytes.
#pragma once

#include <string>
#include <string_view>
#include <vector>

namespace vkfv::report {

// A page under construction. All texts are escaped.
class Page {
  public:
    // Begins a section, which ends at the next one. id: one word, for links to it.
    void section(std::string_view id, std::string_view title);
    // Adds a heading within a section.
    void heading(std::string_view text);
    void paragraph(std::string_view text);
    // Adds a table. The first row is the head; the first cell of each other row names it. Captions distinguish tables.
    void table(std::string_view caption, const std::vector<std::vector<std::string>>& rows);
    // Adds an SVG document, in its own size or the page's width.
    void picture(std::string_view svg, std::string_view what_it_shows);
    // Adds lines of text unchanged, folded away under a title.
    void folded(std::string_view title, std::string_view lines);
    // Adds a file of src/report/page unchanged.
    void part(std::string_view file);
    // Adds data for the scripts, found by its id: only characters that need no escape, as in JSON (report::page_json())
    // and base64.
    void data(std::string_view id, std::string_view text);
    // Adds a script, a file of src/report/page or of a library. Scripts run in this order, after all data.
    void script(std::string_view file);

    // The whole page. summary: one line below the title, to which scripts add the date of the file; empty: none.
    std::string document(std::string_view title, std::string_view summary = {}) const;

  private:
    struct Section {
        std::string id;
        std::string title;
    };
    std::vector<Section> sections_;
    std::string body_;
    std::string data_;
    std::vector<std::string> scripts_;
};

} // namespace vkfv::report
