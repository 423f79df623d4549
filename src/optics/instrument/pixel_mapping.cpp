#include "optics/instrument/pixel_mapping.hpp"

#include "core/mathematics/units.hpp"
#include "core/threads/parallel_list.hpp"
#include "optics/aim/best_focus.hpp"
#include "optics/aim/detector_view.hpp"
#include "optics/instrument/image_quality.hpp"

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <limits>
#include <span>
#include <vector>

namespace vkfv::optics {

namespace {

constexpr int most_degree = 7; // third- and fifth-order distortion, and one order more
constexpr int nodes_a_side = 9;
constexpr int wavelengths = 9;

// Chebyshev's points of [-1, 1], both ends included, between which interpolating polynomials do not oscillate.
double node_at(int k) {
    return -std::cos(pi * k / (nodes_a_side - 1));
}

// The focus of the light that reaches the middle of a pixel; NaN if none does.
PencilFocus pencil_of(const Imaging& imaging, double magnification, std::span<const SpectralNode> spectrum,
                      glm::dvec2 nominal) {
    // All azimuths of a symmetric train are equivalent, and on the x axis half of the rays are enough.
    const double radius = glm::length(nominal);
    const glm::dvec2 along = imaging.symmetric && radius > 0 ? nominal / radius : glm::dvec2(1, 0);
    const glm::dvec2 seen = imaging.symmetric ? glm::dvec2(radius, 0) : nominal;
    const DetectorView view{.imaging = imaging,
                            .index = imaging.train.front().index_before,
                            .magnification = magnification,
                            .plane = 0,
                            .detector = magnification * seen,
                            .guess = seen};
    const auto chief = view.trace(view.index * imaging.chief_cosines(seen), 0);
    if (!chief) {
        return {.height = NAN, .centroid = glm::dvec2(NAN)};
    }
    glm::dvec2 middle = chief->object_point;
    if (imaging.symmetric) {
        middle.y = 0; // removes rounding
    }
    auto pencil = focus_of_pencil(imaging, magnification, outline_at(imaging, middle), view.detector, spectrum);
    const glm::dvec2 own = pencil.centroid;
    if (imaging.symmetric) {
        pencil.centroid = own.x * along; // own.y is rounding
    }
    return pencil;
}

struct Node {
    glm::dvec2 nominal;
    glm::dvec2 aside; // place - nominal
    double focus;
};

std::vector<Node> traced_nodes(const Imaging& imaging, double magnification, std::span<const SpectralNode> spectrum,
                               glm::dvec2 half_field) {
    // For a symmetric train, a quarter of the field determines the others.
    const int first = imaging.symmetric ? nodes_a_side / 2 : 0;
    const int side = nodes_a_side - first;
    const auto pencils = parallel_list(side * side, [&](int k) {
        const glm::dvec2 nominal = half_field * glm::dvec2(node_at(first + k % side), node_at(first + k / side));
        return pencil_of(imaging, magnification, spectrum, nominal);
    });
    std::vector<Node> nodes;
    for (int j = 0; j < nodes_a_side; ++j) {
        for (int i = 0; i < nodes_a_side; ++i) {
            const int traced_i = imaging.symmetric ? std::max(i, nodes_a_side - 1 - i) : i;
            const int traced_j = imaging.symmetric ? std::max(j, nodes_a_side - 1 - j) : j;
            const PencilFocus& pencil = pencils[static_cast<std::size_t>((traced_j - first) * side + traced_i - first)];
            const glm::dvec2 nominal = half_field * glm::dvec2(node_at(traced_i), node_at(traced_j));
            const glm::dvec2 turned(i < traced_i ? -1 : 1, j < traced_j ? -1 : 1);
            if (std::isfinite(pencil.height) && std::isfinite(pencil.centroid.x) && std::isfinite(pencil.centroid.y)) {
                nodes.push_back({.nominal = turned * nominal,
                                 .aside = turned * (pencil.centroid - nominal),
                                 .focus = pencil.height});
            }
        }
    }
    return nodes;
}

// Fits an affine map to the places over a regular grid of the field; `residual` is the largest deviation.
MappingDeviation deviation_of(const PixelMapping& mapping, glm::dvec2 half_field) {
    constexpr int half_points = 16;
    MappingDeviation deviation;
    std::vector<glm::dvec2> nominals;
    for (int j = -half_points; j <= half_points; ++j) {
        for (int i = -half_points; i <= half_points; ++i) {
            nominals.push_back(half_field * glm::dvec2(i, j) / static_cast<double>(half_points));
        }
    }
    // On a regular grid about the centre, the fits of the shift and of both rates are independent.
    glm::dmat2 rates(0);
    glm::dvec2 squares(0);
    glm::dvec2 shift(0);
    for (const glm::dvec2& nominal : nominals) {
        const glm::dvec2 aside = mapping.place(nominal) - nominal;
        shift += aside / static_cast<double>(nominals.size());
        rates += glm::outerProduct(aside, nominal);
        squares += nominal * nominal;
    }
    rates[0] /= squares.x;
    rates[1] /= squares.y;
    deviation.shift = shift;
    const glm::dvec2 along_row = glm::dvec2(1, 0) + rates[0];
    const glm::dvec2 along_column = glm::dvec2(0, 1) + rates[1];
    deviation.amplification = {1 / glm::length(along_row), 1 / glm::length(along_column)};
    const double row_angle = std::atan2(along_row.y, along_row.x);
    const double column_angle = std::atan2(-along_column.x, along_column.y);
    deviation.rotation = 0.5 * (row_angle + column_angle);
    deviation.perpendicularity = column_angle - row_angle;
    for (const glm::dvec2& nominal : nominals) {
        const glm::dvec2 rest = mapping.place(nominal) - nominal - shift - rates * nominal;
        deviation.residual = std::max(deviation.residual, glm::length(rest));
    }
    return deviation;
}

} // namespace

PixelMapping::PixelMapping(const InstrumentDescription& description, const Instrument& instrument) {
    const FirstOrder& first_order = instrument.first_order;
    const Imaging imaging = imaging_of(instrument);
    const Spectrum& spectrum = description.spectrum;
    const auto nodes_of_spectrum =
        at_most(wavelengths, spectral_nodes(spectrum.bins, spectrum.centre(), spectrum.half_width(), wavelengths));
    const ImageSize pixels = description.detector_pixels;
    const glm::dvec2 half_field = 0.5 * first_order.pixel_pitch * glm::dvec2(pixels.columns, pixels.rows);
    const glm::dvec2 seen_half_field = instrument.image_reach * half_field;
    image_.image_distortion =
        instrument.constants.image_distortion * first_order.magnification * first_order.magnification;
    image_.image_shear = instrument.constants.image_shear;
    scale_ = std::sqrt(2.0) * seen_half_field;
    const auto nodes = traced_nodes(imaging, first_order.magnification, nodes_of_spectrum, seen_half_field);

    // At most half as many terms as nodes, so that the nodes still reveal the polynomials' error.
    int degree = most_degree;
    while (degree >= 0 && 2 * PlanePolynomial::terms(degree) > nodes.size()) {
        --degree;
    }
    if (degree < 0) { // hardly any pixel receives light
        deviation_.error = std::numeric_limits<double>::quiet_NaN();
        return;
    }
    std::vector<glm::dvec2> points;
    std::vector<std::vector<double>> values(3);
    for (const Node& node : nodes) {
        points.push_back(scaled(node.nominal));
        values[0].push_back(node.aside.x);
        values[1].push_back(node.aside.y);
        values[2].push_back(node.focus - first_order.best_focus_offset);
    }
    auto fitted = fit_polynomials(degree, points, values);
    aside_x_ = fitted[0];
    aside_y_ = fitted[1];
    focus_ = fitted[2];
    deviation_ = deviation_of(*this, half_field);
    if (imaging.symmetric) { // zero by symmetry; the sums leave rounding
        deviation_.shift = glm::dvec2(0);
        if (image_.image_shear == 0) {
            deviation_.rotation = deviation_.perpendicularity = 0;
        }
    }
    for (const Node& node : nodes) {
        deviation_.error =
            std::max(deviation_.error, glm::length(place_by_lenses(node.nominal) - node.nominal - node.aside));
    }
}

glm::dvec2 PixelMapping::arrived(glm::dvec2 nominal, double image_scale) const {
    physics::f64::Exposure exposure{};
    exposure.magnification_change = image_scale - 1;
    return physics::f64::arrival_place(image_, exposure, nominal).place;
}

glm::dvec2 PixelMapping::place_by_lenses(glm::dvec2 arrived) const {
    const glm::dvec2 at = scaled(arrived);
    return arrived + glm::dvec2(aside_x_.value(at), aside_y_.value(at));
}

glm::dvec2 PixelMapping::place(glm::dvec2 nominal, double image_scale) const {
    return place_by_lenses(arrived(nominal, image_scale));
}

glm::dmat2 PixelMapping::rate(glm::dvec2 nominal, double image_scale) const {
    const glm::dvec2 there = arrived(nominal, image_scale);
    const glm::dvec2 at = scaled(there);
    const glm::dvec2 of_x = aside_x_.gradient(at) / scale_;
    const glm::dvec2 of_y = aside_y_.gradient(at) / scale_;
    const glm::dmat2 by_lenses(1 + of_x.x, of_y.x, of_x.y, 1 + of_y.y);
    // The derivative of recorded_place() (shaders/physics/image_distortion.glsl).
    const double radial = image_.image_distortion;
    const glm::dmat2 distortion =
        (1 + radial * glm::dot(there, there)) * glm::dmat2(1) + 2 * radial * glm::outerProduct(there, there);
    const glm::dmat2 shear(1, 0, image_.image_shear, 1);
    return by_lenses * glm::inverse(image_scale * shear * distortion);
}

double PixelMapping::focus(glm::dvec2 nominal, double image_scale) const {
    return focus_.value(scaled(arrived(nominal, image_scale)));
}

} // namespace vkfv::optics
