// A picture as SVG text: lengths in user units (pixels), x to the right, y down. The same calls give the same bytes.
#pragma once

#include <glm/glm.hpp>

#include <span>
#include <string>
#include <string_view>

namespace vkfv::report {

// An SVG document under construction. Attributes are written as they are given; text is escaped.
class Svg {
  public:
    void open_group(std::string_view attributes);
    void close_group() { body_ += "</g>\n"; }
    void line(glm::dvec2 from, glm::dvec2 to, std::string_view attributes = {});
    void path(std::span<const glm::dvec2> points, bool closed, std::string_view attributes = {});
    void rectangle(glm::dvec2 corner, glm::dvec2 size, std::string_view attributes = {});
    void text(glm::dvec2 at, std::string_view content, std::string_view attributes = {});
    // Adds a PNG's bytes as an image, stretched over the rectangle without smoothing.
    void image(glm::dvec2 corner, glm::dvec2 size, const std::string& png);
    // Defines a clipping rectangle for groups with clip-path="url(#id)".
    void clip_rectangle(std::string_view id, glm::dvec2 corner, glm::dvec2 size);

    // Adds the contents of another picture over the present ones.
    void append(const Svg& other);

    // The document, on a white background.
    std::string document(glm::dvec2 size, std::string_view title) const;

  private:
    std::string body_;
};

} // namespace vkfv::report
