// A page of HTML, well-formed as XML too, that carries all it shows inside itself. The same calls give the same bytes.
#pragma once

#include <string>
#include <string_view>
#include <vector>

namespace vkfv::report {

// Texts are escaped.
class Page {
  public:
    void heading(std::string_view text);
    void paragraph(std::string_view text);
    // The first row is the head; the first cell of each other row names it.
    void table(const std::vector<std::vector<std::string>>& rows);
    // An SVG document, in its own size or the page's width.
    void picture(std::string_view svg, std::string_view what_it_shows);
    // Lines of text as they stand, folded away under a title.
    void folded(std::string_view title, std::string_view lines);

    std::string document(std::string_view title) const;

  private:
    std::string body_;
};

} // namespace vkfv::report
