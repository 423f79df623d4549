#include "optics/plane_polynomial.hpp"

#include <cmath>
#include <stdexcept>
#include <utility>

namespace vkfv::optics {

double PlanePolynomial::value(glm::dvec2 at) const {
    double sum = 0;
    std::size_t end = coefficients_.size();
    for (int j = degree_; j >= 0; --j) {
        const auto count = static_cast<std::size_t>(degree_ - j + 1);
        const double* const row = &coefficients_[end - count];
        end -= count;
        double along = 0;
        for (std::size_t i = count; i-- > 0;) {
            along = along * at.x + row[i];
        }
        sum = sum * at.y + along;
    }
    return sum;
}

glm::dvec2 PlanePolynomial::gradient(glm::dvec2 at) const {
    glm::dvec2 slope(0);
    double sum = 0;
    std::size_t end = coefficients_.size();
    for (int j = degree_; j >= 0; --j) {
        const auto count = static_cast<std::size_t>(degree_ - j + 1);
        const double* const row = &coefficients_[end - count];
        end -= count;
        double along = 0;
        double rate = 0;
        for (std::size_t i = count; i-- > 0;) {
            rate = rate * at.x + along;
            along = along * at.x + row[i];
        }
        slope.x = slope.x * at.y + rate;
        slope.y = slope.y * at.y + sum;
        sum = sum * at.y + along;
    }
    return slope;
}

namespace {

using Column = std::vector<double>;

std::vector<Column> monomials(int degree, const std::vector<glm::dvec2>& points) {
    std::vector<Column> columns;
    Column power_of_y(points.size(), 1.0);
    for (int j = 0; j <= degree; ++j) {
        Column power = power_of_y;
        for (int i = 0; i <= degree - j; ++i) {
            columns.push_back(power);
            for (std::size_t k = 0; k < points.size(); ++k) {
                power[k] *= points[k].x;
            }
        }
        for (std::size_t k = 0; k < points.size(); ++k) {
            power_of_y[k] *= points[k].y;
        }
    }
    return columns;
}

double product(const Column& a, const Column& b, std::size_t first) {
    double sum = 0;
    for (std::size_t k = first; k < a.size(); ++k) {
        sum += a[k] * b[k];
    }
    return sum;
}

void reflect(Column& column, const Column& mirror, double scale, std::size_t first) {
    const double along = scale * product(mirror, column, first);
    for (std::size_t k = first; k < column.size(); ++k) {
        column[k] -= along * mirror[k];
    }
}

} // namespace

std::vector<PlanePolynomial> fit_polynomials(int degree, const std::vector<glm::dvec2>& points,
                                             std::vector<std::vector<double>> values) {
    std::vector<Column> columns = monomials(degree, points);
    const std::size_t terms = columns.size();
    if (points.size() < terms) {
        throw std::invalid_argument("fit_polynomials: fewer points than terms");
    }
    std::vector<double> diagonal(terms);
    for (std::size_t n = 0; n < terms; ++n) {
        Column mirror = columns[n];
        const double length = std::copysign(std::sqrt(product(mirror, mirror, n)), -mirror[n]);
        diagonal[n] = length;
        mirror[n] -= length;
        const double square = product(mirror, mirror, n);
        const double scale = square > 0 ? 2 / square : 0;
        for (std::size_t m = n + 1; m < terms; ++m) {
            reflect(columns[m], mirror, scale, n);
        }
        for (Column& value : values) {
            reflect(value, mirror, scale, n);
        }
    }
    std::vector<PlanePolynomial> fitted;
    for (const Column& value : values) {
        PlanePolynomial polynomial(degree);
        const auto coefficients = polynomial.coefficients();
        for (std::size_t n = terms; n-- > 0;) {
            double rest = value[n];
            for (std::size_t m = n + 1; m < terms; ++m) {
                rest -= columns[m][n] * coefficients[m];
            }
            coefficients[n] = diagonal[n] != 0 ? rest / diagonal[n] : 0;
        }
        fitted.push_back(std::move(polynomial));
    }
    return fitted;
}

} // namespace vkfv::optics
