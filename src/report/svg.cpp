#include "report/svg.hpp"

#include "report/markup.hpp"
#include "report/png.hpp"

#include <fmt/format.h>

#include <cmath>

namespace vkfv::report {

namespace {

// A hundredth of a pixel is finer than any screen or printer shows.
std::string number(double value) {
    return fmt::format("{:g}", std::round(value * 100) / 100 + 0.0); // + 0: no minus zero
}

std::string spaced(std::string_view attributes) {
    return attributes.empty() ? "" : fmt::format(" {}", attributes);
}

} // namespace

void Svg::open_group(std::string_view attributes) {
    body_ += fmt::format("<g{}>\n", spaced(attributes));
}

void Svg::line(glm::dvec2 from, glm::dvec2 to, std::string_view attributes) {
    body_ += fmt::format("<line x1=\"{}\" y1=\"{}\" x2=\"{}\" y2=\"{}\"{}/>\n", number(from.x), number(from.y),
                         number(to.x), number(to.y), spaced(attributes));
}

void Svg::path(std::span<const glm::dvec2> points, bool closed, std::string_view attributes) {
    std::string data;
    for (const glm::dvec2& point : points) {
        data += fmt::format("{}{} {}", data.empty() ? 'M' : 'L', number(point.x), number(point.y));
    }
    body_ += fmt::format("<path d=\"{}{}\"{}/>\n", data, closed ? "Z" : "", spaced(attributes));
}

void Svg::rectangle(glm::dvec2 corner, glm::dvec2 size, std::string_view attributes) {
    body_ += fmt::format("<rect x=\"{}\" y=\"{}\" width=\"{}\" height=\"{}\"{}/>\n", number(corner.x), number(corner.y),
                         number(size.x), number(size.y), spaced(attributes));
}

void Svg::text(glm::dvec2 at, std::string_view content, std::string_view attributes) {
    body_ += fmt::format("<text x=\"{}\" y=\"{}\"{}>{}</text>\n", number(at.x), number(at.y), spaced(attributes),
                         escaped(content));
}

void Svg::image(glm::dvec2 corner, glm::dvec2 size, const std::string& png) {
    body_ += fmt::format("<image x=\"{}\" y=\"{}\" width=\"{}\" height=\"{}\" preserveAspectRatio=\"none\" "
                         "style=\"image-rendering:pixelated\" href=\"data:image/png;base64,{}\"/>\n",
                         number(corner.x), number(corner.y), number(size.x), number(size.y), base64(png));
}

void Svg::clip_rectangle(std::string_view id, glm::dvec2 corner, glm::dvec2 size) {
    body_ += fmt::format("<clipPath id=\"{}\">\n", id);
    rectangle(corner, size);
    body_ += "</clipPath>\n";
}

void Svg::append(const Svg& other) {
    body_ += other.body_;
}

std::string Svg::document(glm::dvec2 size, std::string_view title) const {
    return fmt::format("<svg xmlns=\"http://www.w3.org/2000/svg\" width=\"{0}\" height=\"{1}\" "
                       "viewBox=\"0 0 {0} {1}\" font-family=\"Helvetica, Arial, 'DejaVu Sans', sans-serif\">\n"
                       "<title>{2}</title>\n"
                       "<rect width=\"{0}\" height=\"{1}\" fill=\"#ffffff\"/>\n{3}</svg>\n",
                       number(size.x), number(size.y), escaped(title), body_);
}

} // namespace vkfv::report
