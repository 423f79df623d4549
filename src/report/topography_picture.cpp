#include "report/topography_picture.hpp"

#include "core/mathematics/units.hpp"
#include "report/chart.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <future>
#include <limits>
#include <utility>
#include <vector>

namespace vkfv::report {
namespace {

using glm::dvec2;

constexpr dvec2 panel{420, 360};
constexpr double margin = 24;
constexpr double head = 56;

Map map_of(const std::string& title, const surface::HeightMap& heights, double low, double high, Palette palette) {
    Map map{.title = title, .unit = "um", .values = heights.height};
    for (double& value : map.values.values)
        value *= um_per_mm;
    map.x0 = heights.x0 * um_per_mm;
    map.y0 = heights.y0 * um_per_mm;
    map.pitch = dvec2(heights.pitch_x, heights.pitch_y) * um_per_mm;
    map.low = low;
    map.high = high;
    map.palette = palette;
    return map;
}

// The image as a map. The brightness scale runs from black to the value that only the brightest thousandth exceeds.
template <class Value>
Map map_of_image(const std::string& title, const Grid<Value>& image, const surface::HeightMap& place,
                 const std::string& unit) {
    Map map{.title = title, .unit = unit, .values = Grid<double>(image.columns, image.rows)};
    std::copy(image.values.begin(), image.values.end(), map.values.values.begin());
    map.x0 = place.x0 * um_per_mm;
    map.y0 = place.y0 * um_per_mm;
    map.pitch = dvec2(place.pitch_x, place.pitch_y) * um_per_mm;
    map.low = 0;
    map.high = range_of(map.values, 2e-3).second;
    map.palette = Palette::grey;
    return map;
}

Curve profile(const std::string& name, const surface::HeightMap& map, int row) {
    Curve curve{.name = name, .points = {}, .spreads = {}};
    for (int column = 0; column < map.columns(); ++column)
        curve.points.emplace_back(map.x(column) * um_per_mm, map.height(column, row) * um_per_mm);
    return curve;
}

} // namespace

std::string topography_picture(const TopographyPicture& picture) {
    Svg svg;
    int place = 0;
    const auto next = [&] {
        const dvec2 corner = dvec2(margin, head) + (panel + dvec2(margin)) * dvec2(place % 3, place / 3);
        ++place;
        return corner;
    };
    svg.text({margin, 34}, picture.title, "font-size=\"19\" fill=\"#111111\"");

    const auto range_of_heights = [](const surface::HeightMap& heights, double outside) {
        return range_of(map_of("", heights, 0, 1, Palette::height).values, outside);
    };
    auto true_range = std::async(std::launch::async, [&] {
        return picture.truth
                   ? range_of_heights(*picture.truth, 2e-3)
                   : std::pair{std::numeric_limits<double>::infinity(), -std::numeric_limits<double>::infinity()};
    });
    const auto [low_measured, high_measured] = range_of_heights(picture.measured, 2e-3);
    const auto [low_true, high_true] = true_range.get();
    const double low = std::min(low_measured, low_true), high = std::max(high_measured, high_true);

    // Each map is drawn by a thread of its own; they are put together in order.
    std::vector<std::future<Svg>> maps;
    const auto draw = [&](const std::function<Map()>& make) {
        maps.push_back(std::async(std::launch::async, [corner = next(), make] {
            Svg part;
            draw_map(part, corner, panel, make());
            return part;
        }));
    };
    draw([&] { return map_of("Measured height", picture.measured, low, high, Palette::height); });
    if (picture.truth)
        draw([&] { return map_of("True height", *picture.truth, low, high, Palette::height); });
    if (picture.deviation)
        draw([&] {
            const auto [least, most] = range_of_heights(*picture.deviation, 1e-2);
            const double end = std::max(std::abs(least), std::abs(most));
            return map_of("Deviation, measured less true", *picture.deviation, -end, end, Palette::signed_deviation);
        });
    if (picture.all_in_focus) {
        draw([&] { return map_of_image("All in focus", *picture.all_in_focus, picture.measured, picture.image_unit); });
        // The overlay has the colours of the heights and the brightness of the image.
        draw([&] {
            Map overlay = map_of("Heights over the image", picture.measured, low, high, Palette::height);
            const Map image = map_of_image("", *picture.all_in_focus, picture.measured, picture.image_unit);
            overlay.brightness = image.values;
            for (double& value : overlay.brightness->values)
                value = std::clamp(value / image.high, 0.0, 1.0);
            return overlay;
        });
    }
    for (auto& map : maps)
        svg.append(map.get());
    const int row = picture.measured.rows() / 2;
    std::vector<Curve> curves{profile("measured", picture.measured, row)};
    if (picture.truth)
        curves.push_back(profile("true", *picture.truth, row));
    draw_chart(svg, next(), panel, fmt::format("Profile at y = {:.4g} um", picture.measured.y(row) * um_per_mm),
               axis_over(curves, 0, "x / um"), axis_over(curves, 1, "height / um"), curves);
    for (const Chart& chart : picture.charts)
        draw_chart(svg, next(), panel, chart.title, axis_over(chart.curves, 0, chart.x_label, chart.x_decades),
                   axis_over(chart.curves, 1, chart.y_label), chart.curves);
    const dvec2 page = dvec2(margin, head) + (panel + dvec2(margin)) * dvec2(std::min(place, 3), (place + 2) / 3);
    return svg.document(page, picture.title);
}

std::string image_picture(const std::string& title, const Grid<double>& image, double x0, double y0, double pitch,
                          const PixelQuantity& quantity) {
    const surface::HeightMap place{.height = {}, .x0 = x0, .y0 = y0, .pitch_x = pitch, .pitch_y = pitch};
    const Map map = map_of_image("Image", image, place, quantity.unit);
    double sum = 0, square = 0;
    for (const double value : image.values) {
        sum += value;
        square += value * value;
    }
    const auto count = static_cast<double>(image.values.size());
    const double mean = sum / count, deviation = std::sqrt(std::max(0.0, square / count - mean * mean));
    constexpr int intervals = 100;
    auto drawn = std::async(std::launch::async, [&] {
        Svg part;
        draw_map(part, {margin, head}, panel, map);
        return part;
    });
    const double top = range_of(map.values, 2e-4).second;
    std::vector<double> counts(intervals, 0.0);
    for (const double value : image.values) {
        const auto interval = static_cast<int>(std::floor(value / top * intervals));
        if (interval >= 0 && interval < intervals)
            counts[static_cast<std::size_t>(interval)] += 1;
    }
    Svg svg;
    svg.text({margin, 34}, title, "font-size=\"19\" fill=\"#111111\"");
    svg.append(drawn.get());
    draw_histogram(svg, {margin + panel.x + margin, head}, panel,
                   fmt::format("Mean {:.4g} {}, contrast {:.4f}", mean, quantity.unit, deviation / mean),
                   {0, top, quantity.label, false}, counts);
    return svg.document(dvec2(3 * margin, head + margin) + dvec2(2 * panel.x, panel.y), title);
}

} // namespace vkfv::report
