// Polynomials of two variables, fitted over the unit disc.
#pragma once

#include <glm/glm.hpp>

#include <span>
#include <vector>

namespace vkfv {

// The sum of c_ij x^i y^j over i + j <= degree.
class PlanePolynomial {
  public:
    PlanePolynomial() : PlanePolynomial(0) {}
    explicit PlanePolynomial(int degree) : degree_(degree), coefficients_(terms(degree), 0.0) {}

    static std::size_t terms(int degree) { return static_cast<std::size_t>((degree + 1) * (degree + 2) / 2); }

    int degree() const { return degree_; }
    std::span<double> coefficients() { return coefficients_; } // ordered by j, then by i
    std::span<const double> along_x() const {
        return std::span(coefficients_).first(static_cast<std::size_t>(degree_ + 1));
    }
    double value(glm::dvec2 at) const;
    glm::dvec2 gradient(glm::dvec2 at) const;

  private:
    int degree_ = 0;
    std::vector<double> coefficients_;
};

// The powers of y in a polynomial: even for a function symmetric about the x axis, odd for an antisymmetric one; none
// for a function of x alone.
enum class Parity { any, even, odd, none };

// Fits, for each column of `values`, the polynomial with the least sum of squared deviations at the points, by
// Householder reflections (Golub and Van Loan, "Matrix Computations", section 5.3). The points lie within the unit disc
// and are at least as many as the terms, else std::invalid_argument. weights: of the squares; empty: all equal.
std::vector<PlanePolynomial> fit_polynomials(int degree, const std::vector<glm::dvec2>& points,
                                             const std::vector<std::vector<double>>& values,
                                             Parity parity = Parity::any, const std::vector<double>& weights = {});

} // namespace vkfv
