#include "report/contact_sheet.hpp"

#include "report/chart.hpp"
#include "report/png.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <numeric>

namespace vkfv::report {
namespace {

using glm::dvec2;

constexpr double side = 236; // side of an image, pixels
constexpr double gap = 10;
constexpr double note_height = 20;
constexpr dvec2 head{96, 100};

Grid<Rgb> shown(const Grid<float>& image, double brightest) {
    const double mean = std::accumulate(image.values.begin(), image.values.end(), 0.0) /
                        static_cast<double>(std::max<std::size_t>(1, image.values.size()));
    // Up to twice as many pixels as the picture has are kept; more are averaged.
    const int factor = std::max(1, static_cast<int>(image.columns / (2 * side)));
    Grid<Rgb> pixels(image.columns / factor, image.rows / factor);
    for (int row = 0; row < pixels.rows; ++row)
        for (int column = 0; column < pixels.columns; ++column) {
            double sum = 0;
            for (int j = 0; j < factor; ++j)
                for (int i = 0; i < factor; ++i)
                    sum += static_cast<double>(image(column * factor + i, row * factor + j));
            pixels(column, row) = colour_of(Palette::grey, sum / (factor * factor) / (mean * brightest));
        }
    return pixels;
}

} // namespace

std::string contact_sheet(const ContactSheet& sheet) {
    Svg svg;
    const auto columns = sheet.column_values.size(), rows = sheet.row_values.size();
    const dvec2 cell{side + gap, side + gap + note_height};
    const dvec2 page = head + cell * dvec2(columns, rows) + dvec2(gap);
    svg.text({gap + 10, 34}, sheet.title, "font-size=\"19\" fill=\"#111111\"");
    const std::string axis = "font-size=\"15\" fill=\"#111111\" text-anchor=\"middle\"";
    const std::string value = "font-size=\"14\" fill=\"#333333\" text-anchor=\"middle\"";
    svg.text({head.x + 0.5 * cell.x * static_cast<double>(columns), 66}, sheet.column_label, axis);
    const dvec2 left{28, head.y + 0.5 * cell.y * static_cast<double>(rows)};
    svg.open_group(fmt::format("transform=\"rotate(-90 {:.2f} {:.2f})\"", left.x, left.y));
    svg.text(left, sheet.row_label, axis);
    svg.close_group();
    for (std::size_t column = 0; column < columns; ++column)
        svg.text({head.x + cell.x * static_cast<double>(column) + 0.5 * side, head.y - 10}, sheet.column_values[column],
                 value);
    for (std::size_t row = 0; row < rows; ++row) {
        svg.text({head.x - 30, head.y + cell.y * static_cast<double>(row) + 0.5 * side}, sheet.row_values[row], value);
        for (std::size_t column = 0; column < columns; ++column) {
            const std::size_t k = row * columns + column;
            const dvec2 corner = head + cell * dvec2(column, row);
            svg.image(corner, dvec2(side), png_bytes(shown(sheet.images[k], sheet.brightest)));
            svg.text(corner + dvec2(0.5 * side, side + 15), sheet.notes[k],
                     "font-size=\"11\" fill=\"#444444\" text-anchor=\"middle\"");
        }
    }
    return svg.document(page, sheet.title);
}

} // namespace vkfv::report
