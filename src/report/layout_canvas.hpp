// A page that remembers what is drawn on it, so that pictures and labels do not overlap. Lengths in px.
#pragma once

#include "report/layout_drawing.hpp"
#include "report/layout_geometry.hpp"
#include "report/svg.hpp"

#include <string>
#include <vector>

namespace vkfv::report {

struct Canvas {
    Svg svg;
    Box used;                  // box of all that was drawn
    std::vector<Box> occupied; // boxes of lines and texts, one by one

    void occupy(const std::vector<glm::dvec2>& points); // marks the place of a line
    void write_label(glm::dvec2 at, const std::string& text, const char* anchor);
    void draw_leader(const std::vector<glm::dvec2>& points);
    // The upper left corner of the leftmost free rectangle of this size within the frame's height, at its top or
    // bottom.
    glm::dvec2 free_place(glm::dvec2 size, const Box& frame) const;
};

// Draws the labels of a picture that `frame` encloses: on the nearer side of it, or all to its right.
void draw_labels(Canvas& canvas, const View& view, const std::vector<Label>& labels, const Box& frame, bool all_right);

} // namespace vkfv::report
