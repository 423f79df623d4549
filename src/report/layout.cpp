#include "report/layout.hpp"

#include "report/layout_canvas.hpp"
#include "report/layout_drawing.hpp"
#include "report/layout_style.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <optional>

namespace vkfv::report {

using glm::dvec2;

namespace {

// Sizes in pixels.
constexpr double title_size = 17;
constexpr double margin = 24;
constexpr double largest_height = 820;
constexpr double largest_width = 820;

// The largest of 1, 2 or 5 times a power of ten that does not exceed `most`.
double round_length(double most) {
    const double power = std::pow(10.0, std::floor(std::log10(most)));
    return power * (most >= 5 * power ? 5 : most >= 2 * power ? 2 : 1);
}

std::string title_of(const optics::Instrument& instrument, const std::string& name) {
    const auto& first_order = instrument.first_order;
    return fmt::format("{}: {:.3g}x, NA {:.3g}, {:.4g} nm, working distance {:.3g} mm", name,
                       std::abs(first_order.magnification), first_order.numerical_aperture,
                       1e3 / std::sqrt(instrument.constants.spectrum_centre), first_order.working_distance);
}

// The view of the whole instrument under the title, with room for the labels on the left and at the top.
View main_view(const Drawing& drawing) {
    const Box bounds = drawing.bounds();
    View view;
    view.scale = std::min(largest_height / bounds.size().y, largest_width / bounds.size().x);
    double left = 0;
    double over = 0;
    for (const Label& label : drawing.labels) {
        const bool at_top =
            label.place != Label::Place::beside && view.scale * (bounds.upper.y - label.part.upper.y) < label_room;
        over = at_top ? label_room : over;
        left = std::max(left, label.place == Label::Place::beside ? width_of(label.text) : 0.0);
    }
    const dvec2 corner(margin + left + 46, 2 * margin + title_size + over);
    view.origin = {corner.x - view.scale * bounds.lower.x, corner.y + view.scale * bounds.upper.y};
    return view;
}

// Draws shapes. window: rectangle outside of which none is drawn; the caller clips to it.
void draw_shapes(Canvas& canvas, const View& view, const std::vector<Shape>& shapes, const std::optional<Box>& window) {
    canvas.svg.open_group("fill=\"none\"");
    for (const Shape& shape : shapes) {
        std::vector<dvec2> points;
        Box box;
        for (const dvec2& point : shape.points) {
            points.push_back(view(point));
            box.add(points.back());
        }
        if (window && !box.grown(1).meets(*window)) {
            continue;
        }
        canvas.svg.path(points, shape.closed, shape.attributes);
        if (!window) {
            canvas.occupy(points);
        }
    }
    canvas.svg.close_group();
}

void draw_scale_bar(Canvas& canvas, const char* id, dvec2 at, double scale) {
    constexpr double longest = 140;
    const double length = round_length(longest / scale);
    const dvec2 end = at + dvec2(length * scale, 0);
    canvas.svg.line(at, end, fmt::format("id=\"{}\" stroke=\"{}\" stroke-width=\"3\"", id, ink));
    canvas.write_label({end.x + 8, end.y + 0.35 * label_size}, fmt::format("{:g} mm", length), "start");
}

// Draws the working distance to the left of `window`, from the front vertex down to the plane of best focus.
void draw_working_distance(Canvas& canvas, const View& view, const Box& window, const optics::Instrument& instrument) {
    const double front = view({0, instrument.front_vertex_height}).y;
    const double focus = view({0, 0}).y;
    const double x = window.lower.x - 8;
    for (const double height : {front, focus}) {
        canvas.svg.line({x - 5, height}, {window.middle().x, height},
                        fmt::format("stroke=\"{}\" stroke-width=\"0.5\" stroke-dasharray=\"3 3\"", grey));
    }
    canvas.svg.line({x, front}, {x, focus}, fmt::format("stroke=\"{}\" stroke-width=\"1\"", ink));
    canvas.write_label({x - 6, 0.5 * (front + focus) + 0.35 * label_size},
                       fmt::format("{:.3g} mm", instrument.first_order.working_distance), "end");
}

// Draws objective and specimen enlarged, in a free place or to the right of all that `content` encloses.
void draw_inset(Canvas& canvas, const Drawing& drawing, const View& main, const Box& content,
                const optics::Instrument& instrument) {
    const Box& region = drawing.objective;
    if (region.empty()) {
        return;
    }
    constexpr double tallest = 400;
    constexpr double widest = 260;
    constexpr double border = 14;
    std::vector<Label> labels;
    double text = 0;
    for (const Label& label : drawing.labels) {
        if (label.about_objective) {
            labels.push_back(label);
            text = std::max(text, width_of(label.text));
        }
    }
    const dvec2 shown = region.size() * dvec2(1.35, 1.2);
    View view;
    view.scale = std::min(tallest / shown.y, widest / shown.x);
    const dvec2 picture = view.scale * shown;
    constexpr double dimension = 90; // room for the working distance
    const dvec2 size(dimension + picture.x + text + 40 + border, picture.y + 3 * border + label_spacing);

    const dvec2 corner = canvas.free_place(size, content);
    const Box frame{corner, corner + size};
    const Box window{corner + dvec2(dimension, border), corner + dvec2(dimension, border) + picture};
    view.origin = window.middle() - view.scale * dvec2(region.middle().x, -region.middle().y);
    canvas.svg.open_group("id=\"inset\"");
    canvas.svg.rectangle(frame.lower, frame.size(),
                         fmt::format("fill=\"#ffffff\" stroke=\"{}\" stroke-width=\"0.8\"", grey));
    canvas.svg.clip_rectangle("inset-window", window.lower, window.size());
    canvas.svg.open_group("clip-path=\"url(#inset-window)\"");
    draw_shapes(canvas, view, drawing.shapes, window);
    canvas.svg.close_group();
    canvas.used.add(frame);
    draw_labels(canvas, view, labels, window, true);
    draw_working_distance(canvas, view, window, instrument);
    draw_scale_bar(canvas, "inset-scale-bar", {corner.x + border, frame.upper.y - border}, view.scale);
    canvas.svg.close_group();
    // A frame marks the part of the whole that the inset shows.
    const Box marked = main(region).grown(6);
    canvas.svg.rectangle(
        marked.lower, marked.size(),
        fmt::format("fill=\"none\" stroke=\"{}\" stroke-width=\"0.8\" stroke-dasharray=\"4 3\"", grey));
}

void draw_legend(Canvas& canvas, const Drawing& drawing, double bottom) {
    double x = margin;
    const double y = bottom + 2 * label_spacing;
    for (const BundleStyle& style : bundle_styles) {
        if (!drawing.has(style.bundle)) {
            continue;
        }
        const std::string meaning = style.meaning;
        canvas.svg.line({x, y}, {x + 26, y}, fmt::format("stroke=\"{}\" stroke-width=\"2.5\"", style.colour));
        canvas.write_label({x + 32, y + 0.35 * label_size}, meaning, "start");
        x += 60 + width_of(meaning);
    }
}

} // namespace

std::string layout_svg(const optics::Instrument& instrument, const std::string& name) {
    const Drawing drawing = draw_instrument(instrument);
    const std::string title = title_of(instrument, name);
    const View view = main_view(drawing);
    const Box content = view(drawing.bounds());
    Canvas canvas;
    canvas.used.add(content);
    canvas.svg.text({margin, margin + title_size}, title,
                    fmt::format("font-size=\"{}\" font-weight=\"bold\" fill=\"{}\"", title_size, ink));
    canvas.used.add(dvec2(margin + width_of(title, title_size), margin));
    canvas.svg.open_group("id=\"microscope\"");
    draw_shapes(canvas, view, drawing.shapes, std::nullopt);
    draw_labels(canvas, view, drawing.labels, content, false);
    canvas.svg.close_group();
    const double bottom = canvas.used.upper.y + 2 * label_spacing;
    draw_scale_bar(canvas, "scale-bar", {margin, bottom}, view.scale);
    draw_inset(canvas, drawing, view, content, instrument);
    draw_legend(canvas, drawing, std::max(bottom, canvas.used.upper.y));
    return canvas.svg.document(glm::ceil(canvas.used.upper + margin), title);
}

} // namespace vkfv::report
