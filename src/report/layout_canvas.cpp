#include "report/layout_canvas.hpp"

#include "report/layout_style.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace vkfv::report {

using glm::dvec2;

namespace {

// Positions as close as possible to the wished ones (ascending), each at least `spacing` after the one before: isotonic
// regression by pooling adjacent violators.
std::vector<double> spread(const std::vector<double>& wished, const std::vector<double>& spacing) {
    struct Pool {
        double sum;
        std::size_t count;
        double mean() const { return sum / static_cast<double>(count); }
    };
    std::vector<Pool> pools;
    double offset = 0;
    std::vector<double> offsets;
    for (std::size_t i = 0; i < wished.size(); ++i) {
        offset += i > 0 ? spacing[i] : 0;
        offsets.push_back(offset);
        pools.push_back({wished[i] - offset, 1});
        while (pools.size() > 1 && pools[pools.size() - 2].mean() > pools.back().mean()) {
            pools[pools.size() - 2].sum += pools.back().sum;
            pools[pools.size() - 2].count += pools.back().count;
            pools.pop_back();
        }
    }
    std::vector<double> result;
    for (const Pool& pool : pools) {
        for (std::size_t k = 0; k < pool.count; ++k) {
            result.push_back(pool.mean() + offsets[result.size()]);
        }
    }
    return result;
}

struct Row {
    const Label* label;
    Box box; // box of the labelled part
};

void label_beside(Canvas& canvas, std::vector<Row> rows, double edge, double side) {
    std::ranges::stable_sort(rows, {}, [](const Row& row) { return row.box.middle().y; });
    std::vector<double> wished;
    for (const Row& row : rows) {
        wished.push_back(row.box.middle().y);
    }
    const auto heights = spread(wished, std::vector<double>(rows.size(), label_spacing));
    for (std::size_t i = 0; i < rows.size(); ++i) {
        const Box& box = rows[i].box;
        canvas.draw_leader({{side < 0 ? box.lower.x : box.upper.x, box.middle().y},
                            {edge + side * 10, heights[i]},
                            {edge + side * 22, heights[i]}});
        canvas.write_label({edge + side * 26, heights[i] + 0.35 * label_size}, rows[i].label->text,
                           side < 0 ? "end" : "start");
    }
}

void label_over(Canvas& canvas, std::vector<Row> rows) {
    std::ranges::stable_sort(rows, {}, [](const Row& row) { return row.box.middle().x; });
    std::vector<double> wished, spacing;
    double top = std::numeric_limits<double>::infinity();
    for (std::size_t i = 0; i < rows.size(); ++i) {
        wished.push_back(rows[i].box.middle().x);
        spacing.push_back(
            i == 0 ? 0 : 0.5 * (width_of(rows[i - 1].label->text) + width_of(rows[i].label->text)) + label_size);
        top = std::min(top, rows[i].box.lower.y);
    }
    const double height = top - label_room;
    const auto places = spread(wished, spacing);
    for (std::size_t i = 0; i < rows.size(); ++i) {
        canvas.draw_leader({{wished[i], rows[i].box.lower.y}, {places[i], height + 14}, {places[i], height + 5}});
        canvas.write_label({places[i], height}, rows[i].label->text, "middle");
    }
}

void label_behind(Canvas& canvas, const Row& row) {
    const dvec2 normal(row.label->normal.x, -row.label->normal.y); // px: y down
    const bool level = std::abs(normal.x) > 0.4;
    const dvec2 place = row.box.middle() + normal * 22.0 + dvec2(0, 0.35 * label_size);
    canvas.write_label(place, row.label->text, !level ? "middle" : normal.x < 0 ? "end" : "start");
}

// Draws a bracket from end to end of a part, under a level one or to the right of an upright one, with its label.
void draw_bracket(Canvas& canvas, const Row& row) {
    constexpr double gap = 14;
    constexpr double tooth = 5;
    const Box& box = row.box;
    if (box.size().x > box.size().y) {
        const double y = box.upper.y + gap;
        canvas.draw_leader({{box.lower.x, y - tooth}, {box.lower.x, y}, {box.upper.x, y}, {box.upper.x, y - tooth}});
        canvas.write_label({box.middle().x, y + label_spacing}, row.label->text, "middle");
    } else {
        const double x = box.upper.x + gap;
        canvas.draw_leader({{x - tooth, box.lower.y}, {x, box.lower.y}, {x, box.upper.y}, {x - tooth, box.upper.y}});
        canvas.write_label({x + tooth, box.middle().y + 0.35 * label_size}, row.label->text, "start");
    }
}

// Labels each horizontal arm separately.
void label_arms(Canvas& canvas, std::vector<Row> rows) {
    constexpr double same_arm = 40;
    std::ranges::stable_sort(rows, {}, [](const Row& row) { return row.box.middle().y; });
    for (auto first = rows.begin(); first != rows.end();) {
        auto last = first + 1;
        while (last != rows.end() && last->box.middle().y - (last - 1)->box.middle().y < same_arm) {
            ++last;
        }
        label_over(canvas, {first, last});
        first = last;
    }
}

} // namespace

void Canvas::occupy(const std::vector<dvec2>& points) {
    constexpr double piece = 8;
    for (std::size_t i = 0; i + 1 < points.size(); ++i) {
        const int pieces = static_cast<int>(std::ceil(glm::length(points[i + 1] - points[i]) / piece)) + 1;
        for (int k = 0; k < pieces; ++k) {
            Box box;
            box.add(glm::mix(points[i], points[i + 1], static_cast<double>(k) / pieces));
            box.add(glm::mix(points[i], points[i + 1], static_cast<double>(k + 1) / pieces));
            occupied.push_back(box.grown(1));
        }
    }
}

void Canvas::write_label(dvec2 at, const std::string& text, const char* anchor) {
    svg.text(at, text,
             fmt::format("class=\"label\" font-size=\"{}\" text-anchor=\"{}\" fill=\"{}\"", label_size, anchor, ink));
    const double width = width_of(text);
    const double left = anchor == std::string("end")      ? at.x - width
                        : anchor == std::string("middle") ? at.x - 0.5 * width
                                                          : at.x;
    const Box box{{left, at.y - label_size}, {left + width, at.y + 4}};
    occupied.push_back(box);
    used.add(box);
}

void Canvas::draw_leader(const std::vector<dvec2>& points) {
    svg.path(points, false, fmt::format("class=\"leader\" fill=\"none\" stroke=\"{}\" stroke-width=\"0.7\"", grey));
    occupy(points);
}

dvec2 Canvas::free_place(dvec2 size, const Box& frame) const {
    dvec2 best(std::numeric_limits<double>::infinity());
    for (const double y : {frame.lower.y, frame.upper.y - size.y}) {
        for (double x = frame.lower.x; x < best.x; x += 4) {
            const Box box = Box{{x, y}, dvec2(x, y) + size}.grown(16);
            if (std::ranges::none_of(occupied, [&](const Box& other) { return box.meets(other); })) {
                best = {x, y};
            }
        }
    }
    return best;
}

void draw_labels(Canvas& canvas, const View& view, const std::vector<Label>& labels, const Box& frame, bool all_right) {
    std::vector<Row> left, right, over;
    for (const Label& label : labels) {
        const Row row{&label, view(label.part)};
        switch (label.place) {
        case Label::Place::beside:
            (all_right || row.box.middle().x > frame.middle().x ? right : left).push_back(row);
            break;
        case Label::Place::over:
            over.push_back(row);
            break;
        case Label::Place::behind:
            label_behind(canvas, row);
            break;
        case Label::Place::bracket:
            draw_bracket(canvas, row);
            break;
        }
    }
    label_beside(canvas, left, frame.lower.x, -1);
    label_beside(canvas, right, frame.upper.x, 1);
    label_arms(canvas, over);
}

} // namespace vkfv::report
