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
    Box used;                  // all that was drawn
    std::vector<Box> occupied; // by lines and text, one by one

    void occupy(const std::vector<glm::dvec2>& points); // a line's
    void write_label(glm::dvec2 at, const std::string& text, const char* anchor);
    void draw_leader(const std::vector<glm::dvec2>& points);
    // The upper left corner of the free rectangle of this size in the frame's height that is furthest left, at the top
    // or the bottom.
    glm::dvec2 free_place(glm::dvec2 size, const Box& frame) const;
};

// The labels of a picture that `frame` encloses: on the side of it that is nearer, or all to its right.
void draw_labels(Canvas& canvas, const View& view, const std::vector<Label>& labels, const Box& frame, bool all_right);

} // namespace vkfv::report
