#include "measurement/instrument/wave_report.hpp"

#include "core/mathematics/units.hpp"
#include "optics/waves/airy_pattern.hpp"
#include "optics/waves/zernike.hpp"
#include "report/chart.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace vkfv::measurement {

namespace {

constexpr glm::dvec2 panel{420, 310};
constexpr double margin = 24, head = 56;

// A sheet of panels: a row for each point of the field, a column for each kind of panel.
class Sheet {
  public:
    Sheet(const std::string& title, int columns) : title_(title), columns_(columns) {
        svg_.text({margin, 34}, title, "font-size=\"19\" fill=\"#111111\"");
    }
    glm::dvec2 next() {
        const glm::dvec2 corner =
            glm::dvec2(margin, head) + (panel + glm::dvec2(margin)) * glm::dvec2(place_ % columns_, place_ / columns_);
        ++place_;
        return corner;
    }
    report::Svg& svg() { return svg_; }
    std::string document() const {
        const int rows = (place_ + columns_ - 1) / columns_;
        return svg_.document(glm::dvec2(margin, head) + (panel + glm::dvec2(margin)) * glm::dvec2(columns_, rows),
                             title_);
    }

  private:
    std::string title_;
    int columns_;
    int place_ = 0;
    report::Svg svg_;
};

double step_of(const std::vector<double>& values) {
    return (values.back() - values.front()) / static_cast<double>(values.size() - 1);
}

report::Map through_focus(const WaveFigures& figures, const std::vector<double>& columns, double column_scale) {
    report::Map map;
    map.of_place = false;
    map.unit = "";
    map.x0 = columns.front() * column_scale;
    map.y0 = figures.axes.heights.front() * um_per_mm;
    map.pitch = {step_of(columns) * column_scale, step_of(figures.axes.heights) * um_per_mm};
    map.y_label = "z / um";
    return map;
}

std::string heading(const WavePoint& point, const char* what) {
    return fmt::format("{}: {}", point.name, what);
}

// The row of height z = 0.
int focus_row(const WaveFigures& figures) {
    return static_cast<int>(figures.axes.heights.size() / 2);
}

void draw_transfer_curves(Sheet& sheet, const WaveFigures& figures, const WavePoint& point) {
    std::vector<report::Curve> curves(3);
    curves[0].name = "radial";
    curves[1].name = "tangential";
    curves[2].name = "without aberration";
    const double cutoff = 2 * point.aperture / (point.wavelength_um * mm_per_um);
    for (std::size_t i = 0; i < figures.axes.frequencies.size(); ++i) {
        const double frequency = figures.axes.frequencies[i];
        const auto column = static_cast<int>(i);
        curves[0].points.emplace_back(frequency, std::abs(point.radial_transfer(column, focus_row(figures))));
        curves[1].points.emplace_back(frequency, std::abs(point.tangential_transfer(column, focus_row(figures))));
        curves[2].points.emplace_back(frequency, optics::circular_pupil_transfer(frequency, cutoff));
    }
    report::draw_chart(sheet.svg(), sheet.next(), panel, "contrast at z = 0",
                       report::axis_over(curves, 0, "frequency / (1/mm)"), {0, 1, "", false}, curves);
}

void draw_contrast_curves(Sheet& sheet, const WaveFigures& figures, const WavePoint& point) {
    std::vector<report::Curve> curves;
    for (const int quarter : {1, 2, 3}) {
        const auto column = static_cast<int>(figures.axes.frequencies.size() - 1) * quarter / 4;
        const double period = um_per_mm / figures.axes.frequencies[static_cast<std::size_t>(column)];
        report::Curve radial{.name = fmt::format("{:.3g} um", period), .points = {}, .spreads = {}};
        for (std::size_t row = 0; row < figures.axes.heights.size(); ++row) {
            radial.points.emplace_back(figures.axes.heights[row] * um_per_mm,
                                       std::abs(point.radial_transfer(column, static_cast<int>(row))));
        }
        curves.push_back(std::move(radial));
    }
    report::draw_chart(sheet.svg(), sheet.next(), panel, "contrast of radial waves",
                       report::axis_over(curves, 0, "z / um"), {0, 1, "", false}, curves);
}

void draw_encircled(Sheet& sheet, const WavePoint& point) {
    std::vector<report::Curve> curves(2);
    curves[0].name = "traced";
    curves[1].name = "without aberration";
    const double scale = 2 * pi * point.aperture / (point.wavelength_um * mm_per_um);
    for (const glm::dvec2& part : point.encircled) {
        curves[0].points.emplace_back(part.x * um_per_mm, part.y);
        // The share by Rayleigh's formula for an ideal lens (Born and Wolf, section 8.5.2).
        const double v = scale * part.x;
        curves[1].points.emplace_back(part.x * um_per_mm, 1 - std::pow(std::cyl_bessel_j(0.0, v), 2) -
                                                              std::pow(std::cyl_bessel_j(1.0, v), 2));
    }
    report::draw_chart(sheet.svg(), sheet.next(), panel, "light within a radius, z = 0",
                       report::axis_over(curves, 0, "radius / um"), {0, 1, "", false}, curves);
}

// The root makes dark rings visible.
Grid<double> rooted(Grid<double> values) {
    for (double& value : values.values) {
        value = std::sqrt(std::max(0.0, value));
    }
    return values;
}

template <class Write>
void for_each_transfer(const WaveFigures& figures, Write write) {
    for (const WavePoint& point : figures.points) {
        for (const auto& [direction, transfer] :
             {std::pair{"radial", &point.radial_transfer}, std::pair{"tangential", &point.tangential_transfer}}) {
            for (int row = 0; row < transfer->rows; ++row) {
                for (int column = 0; column < transfer->columns; ++column) {
                    write(point, direction, row, column, (*transfer)(column, row));
                }
            }
        }
    }
}

} // namespace

std::string transfer_picture(const WaveFigures& figures, const std::string& title) {
    Sheet sheet(title, 3);
    for (const WavePoint& point : figures.points) {
        report::Map map = through_focus(figures, figures.axes.frequencies, 1);
        map.title = heading(point, "contrast of radial waves");
        map.x_label = "frequency / (1/mm)";
        map.values = Grid<double>(point.radial_transfer.columns, point.radial_transfer.rows);
        std::ranges::transform(point.radial_transfer.values, map.values.values.begin(),
                               [](const std::complex<double>& value) { return std::abs(value); });
        report::draw_map(sheet.svg(), sheet.next(), panel, map);
        draw_contrast_curves(sheet, figures, point);
        draw_transfer_curves(sheet, figures, point);
    }
    return sheet.document();
}

std::string spread_picture(const WaveFigures& figures, const std::string& title) {
    Sheet sheet(title, 3);
    const double step = step_of(figures.axes.places) * um_per_mm;
    for (const WavePoint& point : figures.points) {
        report::Map focus = through_focus(figures, figures.axes.places, um_per_mm);
        focus.title = heading(point, "root of the point spread, 1: ideal");
        focus.x_label = "radial distance / um";
        focus.values = rooted(point.spread_through_focus);
        report::draw_map(sheet.svg(), sheet.next(), panel, focus);
        report::Map plane;
        plane.title = fmt::format("the same at z = 0; Strehl ratio {:.3f}", point.strehl);
        plane.unit = "";
        plane.values = rooted(point.spread);
        plane.x0 = plane.y0 = figures.axes.places.front() * um_per_mm;
        plane.pitch = {step, step};
        plane.x_label = "radial distance / um";
        plane.y_label = "tangential distance / um";
        report::draw_map(sheet.svg(), sheet.next(), panel, plane);
        draw_encircled(sheet, point);
    }
    return sheet.document();
}

std::string wavefront_picture(const WaveFigures& figures, const std::string& title) {
    Sheet sheet(title, 2);
    double most = 1e-6;
    for (const WavePoint& point : figures.points) {
        for (const double value : point.wavefront.values) {
            most = std::isfinite(value) ? std::max(most, std::abs(value)) : most;
        }
    }
    for (const WavePoint& point : figures.points) {
        report::Map map;
        map.title = heading(point, fmt::format("wavefront, RMS {:.4f} waves", point.wavefront_rms).c_str());
        map.unit = "waves";
        map.values = point.wavefront;
        map.x0 = map.y0 = -point.pupil_radius;
        map.pitch = glm::dvec2(2 * point.pupil_radius / (point.wavefront.columns - 1));
        map.x_label = "p_x: direction cosine times n";
        map.y_label = "p_y";
        map.low = -most;
        map.high = most;
        map.palette = report::Palette::signed_deviation;
        map.scale_bar = false;
        map.not_a_number = {232, 232, 232};
        report::draw_map(sheet.svg(), sheet.next(), panel, map);
        std::vector<report::Curve> bars;
        report::Curve coefficients{.name = "", .points = {}, .spreads = {}, .line = true};
        for (std::size_t j = 3; j < point.zernike.size(); ++j) {
            // Each coefficient is a bar, drawn as a line with a gap behind it.
            const auto number = static_cast<double>(j + 1);
            coefficients.points.emplace_back(number, 0);
            coefficients.points.emplace_back(number, point.zernike[j]);
            coefficients.points.emplace_back(number, std::nan(""));
        }
        coefficients.points.emplace_back(3, std::nan(""));
        bars.push_back(std::move(coefficients));
        report::draw_chart(sheet.svg(), sheet.next(), panel, "Zernike coefficients in waves",
                           {3, static_cast<double>(point.zernike.size()) + 1, "Noll's number", false},
                           report::axis_over(bars, 1, ""), bars);
    }
    return sheet.document();
}

std::string transfer_table(const WaveFigures& figures) {
    std::string text = "point,direction,z_um,frequency_per_mm,contrast,real,imaginary\n";
    for_each_transfer(
        figures, [&](const WavePoint& point, const char* direction, int row, int column, std::complex<double> value) {
            text += fmt::format("{},{},{:.6g},{:.6g},{:.6f},{:.6f},{:.6f}\n", point.name, direction,
                                figures.axes.heights[static_cast<std::size_t>(row)] * um_per_mm,
                                figures.axes.frequencies[static_cast<std::size_t>(column)], std::abs(value),
                                value.real(), value.imag());
        });
    return text;
}

std::string spread_table(const WaveFigures& figures) {
    std::string text = "point,z_um,radial_um,over_ideal_peak\n";
    for (const WavePoint& point : figures.points) {
        for (int row = 0; row < point.spread_through_focus.rows; ++row) {
            for (int column = 0; column < point.spread_through_focus.columns; ++column) {
                text += fmt::format("{},{:.6g},{:.6g},{:.6g}\n", point.name,
                                    figures.axes.heights[static_cast<std::size_t>(row)] * um_per_mm,
                                    figures.axes.places[static_cast<std::size_t>(column)] * um_per_mm,
                                    point.spread_through_focus(column, row));
            }
        }
    }
    return text;
}

std::string encircled_table(const WaveFigures& figures) {
    std::string text = "point,radius_um,light\n";
    for (const WavePoint& point : figures.points) {
        for (const glm::dvec2& part : point.encircled) {
            text += fmt::format("{},{:.6g},{:.6f}\n", point.name, part.x * um_per_mm, part.y);
        }
    }
    return text;
}

std::string wavefront_table(const WaveFigures& figures) {
    std::string text = "point,p_x,p_y,wavefront_waves\n";
    for (const WavePoint& point : figures.points) {
        const double step = 2 * point.pupil_radius / (point.wavefront.columns - 1);
        for (int row = 0; row < point.wavefront.rows; ++row) {
            for (int column = 0; column < point.wavefront.columns; ++column) {
                if (const double value = point.wavefront(column, row); std::isfinite(value)) {
                    text += fmt::format("{},{:.6g},{:.6g},{:.6f}\n", point.name, step * column - point.pupil_radius,
                                        step * row - point.pupil_radius, value);
                }
            }
        }
    }
    return text;
}

std::string zernike_table(const WaveFigures& figures) {
    std::string text = "point,number,name,radial_order,azimuthal_order,coefficient_waves\n";
    for (const WavePoint& point : figures.points) {
        for (std::size_t j = 0; j < point.zernike.size(); ++j) {
            const int number = static_cast<int>(j) + 1;
            const auto order = optics::zernike_order(number);
            text += fmt::format("{},{},{},{},{},{:.6f}\n", point.name, number, optics::zernike_name(number),
                                order.radial, order.sine ? -order.azimuthal : order.azimuthal, point.zernike[j]);
        }
    }
    return text;
}

} // namespace vkfv::measurement
