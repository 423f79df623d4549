#include "report/chart.hpp"

#include "report/png.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <limits>

namespace vkfv::report {
namespace {

using glm::dvec2;

constexpr const char* title_style = "font-size=\"14\" fill=\"#111111\"";
constexpr const char* grid_style = "stroke=\"#dddddd\"";
constexpr const char* frame_style = "fill=\"none\" stroke=\"#666666\"";
constexpr double least_separation = 26; // between tick labels, pixels

// The red channel, which grey pixels have in common with the others.
Grid<std::uint8_t> reds(const Grid<Rgb>& pixels) {
    Grid<std::uint8_t> values(pixels.columns, pixels.rows);
    std::ranges::transform(pixels.values, values.values.begin(), &Rgb::red);
    return values;
}

std::string label_style(const char* anchor) {
    return fmt::format("font-size=\"11\" text-anchor=\"{}\" fill=\"#444444\"", anchor);
}

// The rectangle of the data within a panel: its lower left and upper right corner (y of the page goes down).
struct Frame {
    dvec2 low, high;
    Axis x, y;

    static double share(const Axis& axis, double value) {
        return axis.decades ? std::log(value / axis.from) / std::log(axis.to / axis.from)
                            : (value - axis.from) / (axis.to - axis.from);
    }
    dvec2 place(dvec2 value) const { return low + dvec2(share(x, value.x), share(y, value.y)) * (high - low); }
};

Axis widened(Axis axis) {
    if (axis.from == axis.to) {
        const double room = axis.from == 0 ? 1 : 0.1 * std::abs(axis.from);
        axis = axis.decades ? Axis{axis.from / 10, axis.to * 10, axis.label, true}
                            : Axis{axis.from - room, axis.to + room, axis.label, false};
    }
    return axis;
}

std::vector<double> marks(const Axis& axis, double pixels) {
    if (!axis.decades)
        return ticks(axis.from, axis.to, std::max(2, static_cast<int>(pixels / 55)));
    std::vector<double> result;
    const int first = static_cast<int>(std::ceil(std::log10(axis.from) - 1e-9));
    const int last = static_cast<int>(std::floor(std::log10(axis.to) + 1e-9));
    for (int decade = first; decade <= last; ++decade)
        result.push_back(std::pow(10, decade));
    return result;
}

std::string mark_text(const Axis& axis, double value) {
    return axis.decades && value >= 1 ? with_prefix(value) : fmt::format("{:.6g}", value + 0.0);
}

void draw_axes(Svg& svg, const Frame& frame, bool grid) {
    double last = -std::numeric_limits<double>::infinity();
    for (const double value : marks(frame.x, frame.high.x - frame.low.x)) {
        const double x = frame.place({value, frame.y.from}).x;
        svg.line({x, frame.low.y + (grid ? 0 : 4)}, {x, grid ? frame.high.y : frame.low.y}, grid_style);
        if (x - last >= least_separation) {
            svg.text({x, frame.low.y + 15}, mark_text(frame.x, value), label_style("middle"));
            last = x;
        }
    }
    for (const double value : marks(frame.y, frame.low.y - frame.high.y)) {
        const double y = frame.place({frame.x.from, value}).y;
        svg.line({frame.low.x - (grid ? 0 : 4), y}, {grid ? frame.high.x : frame.low.x, y}, grid_style);
        svg.text({frame.low.x - 6, y + 4}, mark_text(frame.y, value), label_style("end"));
    }
    svg.rectangle({frame.low.x, frame.high.y}, {frame.high.x - frame.low.x, frame.low.y - frame.high.y}, frame_style);
    svg.text({0.5 * (frame.low.x + frame.high.x), frame.low.y + 31}, frame.x.label, label_style("middle"));
    if (!frame.y.label.empty()) {
        const dvec2 at{frame.low.x - 44, 0.5 * (frame.low.y + frame.high.y)};
        svg.open_group(fmt::format("transform=\"rotate(-90 {:.2f} {:.2f})\"", at.x, at.y));
        svg.text(at, frame.y.label, label_style("middle"));
        svg.close_group();
    }
}

// The largest of 1, 2 and 5 times a power of ten that does not exceed the value.
double round_below(double value) {
    const double power = std::pow(10, std::floor(std::log10(value)));
    return power * (value >= 5 * power ? 5 : value >= 2 * power ? 2 : 1);
}

Frame chart_frame(dvec2 corner, dvec2 size, const Axis& x, const Axis& y) {
    return {{corner.x + 58, corner.y + size.y - 38}, {corner.x + size.x - 12, corner.y + 26}, widened(x), widened(y)};
}

// Draws a bar of a round length, at most a third of the width (um); `scale` in pixels per um.
void draw_scale_bar(Svg& svg, dvec2 right, double width, double scale) {
    const double length = round_below(0.3 * width);
    svg.rectangle({right.x - scale * length - 6, right.y - 22}, {scale * length + 12, 28},
                  "fill=\"#ffffff\" fill-opacity=\"0.75\"");
    svg.rectangle({right.x - scale * length, right.y - 4}, {scale * length, 4}, "fill=\"#111111\"");
    svg.text({right.x - 0.5 * scale * length, right.y - 9}, fmt::format("{:g} um", length),
             "font-size=\"11\" text-anchor=\"middle\" fill=\"#111111\"");
}

// Means over blocks that divide the values into `columns` by `rows`, at most their own numbers; NaN where no value of a
// block is finite.
Grid<double> averaged(const Grid<double>& values, int columns, int rows) {
    const auto edge = [](int block, int blocks, int points) {
        return static_cast<int>(std::int64_t{block} * points / blocks);
    };
    Grid<double> result(columns, rows);
    for (int row = 0; row < rows; ++row)
        for (int column = 0; column < columns; ++column) {
            double sum = 0, count = 0;
            for (int j = edge(row, rows, values.rows); j < edge(row + 1, rows, values.rows); ++j)
                for (int i = edge(column, columns, values.columns); i < edge(column + 1, columns, values.columns); ++i)
                    if (std::isfinite(values(i, j))) {
                        sum += values(i, j);
                        count += 1;
                    }
            result(column, row) = sum / count;
        }
    return result;
}

} // namespace

std::vector<double> ticks(double from, double to, int count) {
    if (!(to > from) || !std::isfinite(to - from))
        return {from};
    const double raw = (to - from) / count;
    const double power = std::pow(10, std::floor(std::log10(raw)));
    const double multiple = raw / power;
    const double step = power * (multiple <= 1 ? 1 : multiple <= 2 ? 2 : multiple <= 5 ? 5 : 10);
    // Larger multiples of a step are not distinct in double precision, so that the range counts as empty.
    constexpr double most_steps = 1e12;
    const double first = std::ceil(from / step - 1e-9), last = std::floor(to / step + 1e-9);
    if (!(step > 0) || !(std::abs(first) < most_steps && std::abs(last) < most_steps))
        return {from};
    std::vector<double> result;
    for (int k = 0; k <= static_cast<int>(last - first); ++k)
        result.push_back((first + k) * step);
    return result;
}

std::string with_prefix(double value) {
    const std::array<const char*, 5> prefixes = {"", " k", " M", " G", " T"};
    std::size_t thousands = 0;
    while (value >= 999.5 && thousands + 1 < prefixes.size()) {
        value /= 1000;
        ++thousands;
    }
    return fmt::format("{:.3g}{}", value, prefixes[thousands]);
}

Axis axis_over(std::span<const Curve> curves, int direction, std::string label, bool decades) {
    double low = std::numeric_limits<double>::infinity(), high = -low;
    for (const Curve& curve : curves)
        for (const dvec2& point : curve.points)
            if (const double value = point[direction]; std::isfinite(value) && (!decades || value > 0)) {
                low = std::min(low, value);
                high = std::max(high, value);
            }
    if (low > high)
        return {decades ? 1.0 : 0.0, decades ? 10.0 : 1.0, std::move(label), decades};
    if (decades) {
        const double first = std::floor(std::log10(low) + 0.05), last = std::ceil(std::log10(high) - 0.05);
        return {std::pow(10, first), std::pow(10, std::max(last, first + 1)), std::move(label), true};
    }
    const double room = direction == 1 ? 0.06 * (high - low) : 0;
    return {low - room, high + room, std::move(label), false};
}

dvec2 place_in_chart(dvec2 corner, dvec2 size, const Axis& x, const Axis& y, dvec2 value) {
    return chart_frame(corner, size, x, y).place(value);
}

void draw_chart(Svg& svg, dvec2 corner, dvec2 size, std::string_view title, const Axis& x, const Axis& y,
                std::span<const Curve> curves) {
    const Frame frame = chart_frame(corner, size, x, y);
    svg.text(corner + dvec2(0, 14), title, title_style);
    draw_axes(svg, frame, true);
    std::vector<std::size_t> named;
    for (std::size_t k = 0; k < curves.size(); ++k) {
        const Curve& curve = curves[k];
        const char* colour = line_colours[k % line_colours.size()];
        const std::string stroke = fmt::format("stroke=\"{}\" fill=\"none\" stroke-width=\"1.6\"", colour);
        std::vector<dvec2> run;
        const auto finish = [&] {
            if (curve.line && run.size() > 1)
                svg.path(run, false, stroke);
            run.clear();
        };
        for (std::size_t i = 0; i < curve.points.size(); ++i) {
            const dvec2 point = curve.points[i];
            if (!std::isfinite(point.x) || !std::isfinite(point.y) || (y.decades && point.y <= 0)) {
                finish();
                continue;
            }
            run.push_back(frame.place(point));
            if (curve.markers)
                svg.rectangle(run.back() - dvec2(3), {6, 6}, fmt::format("fill=\"{}\"", colour));
            if (!curve.spreads.empty()) {
                const double half = 0.5 * curve.spreads[i];
                svg.line(frame.place({point.x, point.y * std::max(1 - half, 0.1)}),
                         frame.place({point.x, point.y * (1 + half)}), stroke);
            }
        }
        finish();
        if (!curve.name.empty())
            named.push_back(k);
    }
    // The legend stands beside the title, from the right: over the curves it would hide them. A letter is about 6
    // pixels wide.
    double right = frame.high.x;
    for (std::size_t k = named.size(); k-- > 0;) {
        const std::string& name = curves[named[k]].name;
        svg.text({right, corner.y + 14}, name,
                 fmt::format("font-size=\"11\" text-anchor=\"end\" fill=\"{}\"",
                             line_colours[named[k] % line_colours.size()]));
        right -= 6 * static_cast<double>(name.size()) + 10;
    }
}

void draw_histogram(Svg& svg, dvec2 corner, dvec2 size, std::string_view title, const Axis& x,
                    std::span<const double> counts) {
    const double most = counts.empty() ? 1 : std::max(1.0, *std::max_element(counts.begin(), counts.end()));
    const Frame frame = chart_frame(corner, size, x, {0, 1.05 * most, "pixels", false});
    svg.text(corner + dvec2(0, 14), title, title_style);
    draw_axes(svg, frame, true);
    const double width = (frame.x.to - frame.x.from) / static_cast<double>(counts.size());
    for (std::size_t k = 0; k < counts.size(); ++k) {
        const dvec2 lower = frame.place({frame.x.from + width * static_cast<double>(k), 0});
        const dvec2 upper = frame.place({frame.x.from + width * static_cast<double>(k + 1), counts[k]});
        svg.rectangle({lower.x, upper.y}, {upper.x - lower.x, lower.y - upper.y},
                      fmt::format("fill=\"{}\"", line_colours[0]));
    }
}

void draw_map(Svg& svg, dvec2 corner, dvec2 size, const Map& map) {
    svg.text(corner + dvec2(0, 14), map.title, title_style);
    const double bar_room = map.colour_bar ? 74 : 8;
    const dvec2 room{size.x - 58 - bar_room, size.y - 26 - 38};
    const dvec2 extent = dvec2(map.values.columns, map.values.rows) * map.pitch;
    const dvec2 fitting = room / extent;
    const dvec2 scales = map.of_place ? dvec2(std::min(fitting.x, fitting.y)) : fitting; // pixels per unit
    const dvec2 low{corner.x + 58, corner.y + 26 + scales.y * extent.y};
    const dvec2 high{low.x + scales.x * extent.x, corner.y + 26};
    const dvec2 first = dvec2(map.x0, map.y0) - 0.5 * map.pitch;
    const Frame frame{low,
                      high,
                      {first.x, first.x + extent.x, map.x_label, false},
                      {first.y, first.y + extent.y, map.y_label, false}};

    // Twice the picture's pixels stay sharp on screens of high resolution.
    const auto blocks = [](int points, double length) {
        return std::clamp(static_cast<int>(std::ceil(2 * length)), 1, points);
    };
    const int columns = blocks(map.values.columns, high.x - low.x), rows = blocks(map.values.rows, low.y - high.y);
    const Grid<double> shown = averaged(map.values, columns, rows);
    Grid<Rgb> pixels(shown.columns, shown.rows);
    std::transform(shown.values.begin(), shown.values.end(), pixels.values.begin(), [&](double value) {
        return std::isfinite(value) ? colour_of(map.palette, (value - map.low) / (map.high - map.low))
                                    : map.not_a_number;
    });
    if (map.brightness) {
        const Grid<double> brightness = averaged(*map.brightness, columns, rows);
        for (std::size_t k = 0; k < pixels.values.size(); ++k)
            for (std::uint8_t* const channel : {&pixels.values[k].red, &pixels.values[k].green, &pixels.values[k].blue})
                *channel = static_cast<std::uint8_t>(std::lround(*channel * brightness.values[k]));
    }
    const bool is_grey = map.palette == Palette::grey && !map.brightness &&
                         std::ranges::all_of(shown.values, [](double value) { return std::isfinite(value); });
    svg.image({low.x, high.y}, {high.x - low.x, low.y - high.y},
              is_grey ? grey_png_bytes(reds(pixels)) : png_bytes(pixels));
    draw_axes(svg, frame, false);

    if (map.of_place && map.scale_bar)
        draw_scale_bar(svg, {high.x - 10, low.y - 10}, extent.x, scales.x);

    if (map.colour_bar) {
        constexpr int steps = 128;
        Grid<Rgb> bar(1, steps);
        for (int k = 0; k < steps; ++k)
            bar(0, k) = colour_of(map.palette, (k + 0.5) / steps);
        const dvec2 at{high.x + 12, high.y};
        svg.image(at, {12, low.y - high.y}, png_bytes(bar));
        svg.rectangle(at, {12, low.y - high.y}, frame_style);
        for (const double value : ticks(map.low, map.high, std::max(2, static_cast<int>((low.y - high.y) / 45)))) {
            const double y = low.y - (value - map.low) / (map.high - map.low) * (low.y - high.y);
            svg.line({at.x + 12, y}, {at.x + 16, y}, "stroke=\"#666666\"");
            svg.text({at.x + 19, y + 4}, fmt::format("{:.4g}", value + 0.0), label_style("start"));
        }
        svg.text({at.x, high.y - 5}, map.unit, label_style("start"));
    }
}

std::pair<double, double> range_of(const Grid<double>& values, double outside) {
    std::vector<double> finite;
    std::copy_if(values.values.begin(), values.values.end(), std::back_inserter(finite),
                 [](double value) { return std::isfinite(value); });
    if (finite.empty())
        return {0, 1};
    const auto quantile = [&](double share) {
        const auto at = static_cast<std::ptrdiff_t>(share * static_cast<double>(finite.size() - 1));
        std::nth_element(finite.begin(), finite.begin() + at, finite.end());
        return finite[static_cast<std::size_t>(at)];
    };
    const double low = quantile(0.5 * outside), high = quantile(1 - 0.5 * outside);
    return low < high ? std::pair{low, high} : std::pair{low - 0.5, low + 0.5};
}

} // namespace vkfv::report
