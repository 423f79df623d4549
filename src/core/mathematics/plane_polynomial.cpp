#include "core/mathematics/plane_polynomial.hpp"

#include <algorithm>
#include <cmath>
#include <stdexcept>
#include <utility>

namespace vkfv {

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

bool has(Parity parity, int power_of_y) {
    switch (parity) {
    case Parity::any:
        return true;
    case Parity::even:
        return power_of_y % 2 == 0;
    case Parity::odd:
        return power_of_y % 2 != 0;
    case Parity::none:
        break;
    }
    return power_of_y == 0;
}

// The indices of a parity's terms among all coefficients.
std::vector<std::size_t> terms_of(int degree, Parity parity) {
    std::vector<std::size_t> terms;
    std::size_t place = 0;
    for (int j = 0; j <= degree; ++j) {
        for (int i = 0; i <= degree - j; ++i, ++place) {
            if (has(parity, j)) {
                terms.push_back(place);
            }
        }
    }
    return terms;
}

// The matrix of monomials at the points, with the values as further columns, stored by rows: a reflection of all
// columns then runs along rows, which vectorizes. Each column's sums keep the order of its points.
class Columns {
  public:
    Columns(int degree, Parity parity, const std::vector<glm::dvec2>& points,
            const std::vector<std::vector<double>>& values, const std::vector<double>& weights)
        : rows_(points.size()), count_(terms_of(degree, parity).size() + values.size()), numbers_(rows_ * count_) {
        for (std::size_t k = 0; k < rows_; ++k) {
            double* number = row(k);
            double power_of_y = 1;
            for (int j = 0; j <= degree; ++j) {
                double power = power_of_y;
                for (int i = 0; i <= degree - j; ++i) {
                    if (has(parity, j)) {
                        *number++ = power;
                    }
                    power *= points[k].x;
                }
                power_of_y *= points[k].y;
            }
            for (const auto& value : values) {
                *number++ = value[k];
            }
            if (!weights.empty()) {
                std::ranges::for_each(row(k), number, [&](double& each) { each *= std::sqrt(weights[k]); });
            }
        }
    }

    double* row(std::size_t k) { return &numbers_[k * count_]; }

    // Reflects a column so that its numbers below the diagonal become zero. Returns the diagonal element.
    double reflect(std::size_t column) {
        std::vector<double> mirror;
        double square = 0;
        for (std::size_t k = column; k < rows_; ++k) {
            mirror.push_back(row(k)[column]);
            square += mirror.back() * mirror.back();
        }
        const double length = std::copysign(std::sqrt(square), -mirror.front());
        mirror.front() -= length;
        square = 0;
        for (const double each : mirror) {
            square += each * each;
        }
        const double scale = square > 0 ? 2 / square : 0;
        along_.assign(count_, 0.0);
        for (std::size_t k = column; k < rows_; ++k) {
            const double* numbers = row(k);
            const double factor = mirror[k - column];
            for (std::size_t m = column + 1; m < count_; ++m) {
                along_[m] += factor * numbers[m];
            }
        }
        for (double& each : along_) {
            each *= scale;
        }
        for (std::size_t k = column; k < rows_; ++k) {
            double* numbers = row(k);
            const double factor = mirror[k - column];
            for (std::size_t m = column + 1; m < count_; ++m) {
                numbers[m] -= along_[m] * factor;
            }
        }
        return length;
    }

  private:
    std::size_t rows_;
    std::size_t count_;
    std::vector<double> numbers_;
    std::vector<double> along_;
};

} // namespace

std::vector<PlanePolynomial> fit_polynomials(int degree, const std::vector<glm::dvec2>& points,
                                             const std::vector<std::vector<double>>& values, Parity parity,
                                             const std::vector<double>& weights) {
    const std::vector<std::size_t> terms = terms_of(degree, parity);
    if (points.size() < terms.size()) {
        throw std::invalid_argument("fit_polynomials: fewer points than terms");
    }
    Columns columns(degree, parity, points, values, weights);
    std::vector<double> diagonal;
    for (std::size_t n = 0; n < terms.size(); ++n) {
        diagonal.push_back(columns.reflect(n));
    }
    std::vector<PlanePolynomial> fitted;
    for (std::size_t which = 0; which < values.size(); ++which) {
        PlanePolynomial polynomial(degree);
        const auto coefficients = polynomial.coefficients();
        for (std::size_t n = terms.size(); n-- > 0;) {
            const double* row = columns.row(n);
            double rest = row[terms.size() + which];
            for (std::size_t m = n + 1; m < terms.size(); ++m) {
                rest -= row[m] * coefficients[terms[m]];
            }
            coefficients[terms[n]] = diagonal[n] != 0 ? rest / diagonal[n] : 0;
        }
        fitted.push_back(std::move(polynomial));
    }
    return fitted;
}

} // namespace vkfv
