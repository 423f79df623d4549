// A page of HTML, well-formed as XML too, that carries all it shows inside itself: texts, pictures, data, scripts and
// their licences. The same calls give the same bytes.
#pragma once

#include <string>
#include <string_view>
#include <vector>

namespace vkfv::report {

// Texts are escaped.
class Page {
  public:
    // What follows, up to the next. id: one word, of the link to it.
    void section(std::string_view id, std::string_view title);
    // Within a section.
    void heading(std::string_view text);
    void paragraph(std::string_view text);
    // The first row is the head; the first cell of each other row names it. Tables are told apart by their captions.
    void table(std::string_view caption, const std::vector<std::vector<std::string>>& rows);
    // An SVG document, in its own size or the page's width.
    void picture(std::string_view svg, std::string_view what_it_shows);
    // Lines of text as they stand, folded away under a title.
    void folded(std::string_view title, std::string_view lines);
    // A file of src/report/page, as it stands.
    void part(std::string_view file);
    // For the scripts, found by its id: letters that need no escape, as JSON (report::json_text()) and base64 have.
    void data(std::string_view id, std::string_view text);
    // Run in this order, after all data: a file of src/report/page or of a library.
    void script(std::string_view file);

    std::string document(std::string_view title) const;

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
