#include "surface/polynomial.hpp"

#include <Eigen/Dense>

#include <algorithm>
#include <cmath>
#include <limits>
#include <stdexcept>

namespace vkfv::surface {
namespace {

// P_0 to P_degree at u, by Bonnet's recursion.
Eigen::VectorXd legendre(int degree, double u) {
    Eigen::VectorXd p(degree + 1);
    p[0] = 1;
    if (degree > 0)
        p[1] = u;
    for (int n = 1; n < degree; ++n)
        p[n + 1] = ((2 * n + 1) * u * p[n] - n * p[n - 1]) / (n + 1);
    return p;
}

// Calls visit(term, i, j) for all i + j <= degree.
template <class Visit>
void for_terms(int degree, const Visit& visit) {
    int term = 0;
    for (int i = 0; i <= degree; ++i)
        for (int j = 0; i + j <= degree; ++j)
            visit(term++, i, j);
}

// The polynomial in x that stands in the row: its coefficients of P_i(u).
Eigen::VectorXd along_row(const Polynomial& polynomial, double y) {
    const Eigen::VectorXd q = legendre(polynomial.degree, (y - polynomial.y_centre) / polynomial.half_y);
    Eigen::VectorXd result = Eigen::VectorXd::Zero(polynomial.degree + 1);
    for_terms(polynomial.degree, [&](int term, int i, int j) {
        result[i] += polynomial.coefficients[static_cast<std::size_t>(term)] * q[j];
    });
    return result;
}

// Column k: the Legendre polynomials at the map's column k.
Eigen::MatrixXd along_columns(const HeightMap& map, const Polynomial& polynomial) {
    Eigen::MatrixXd values(polynomial.degree + 1, map.columns());
    for (int column = 0; column < map.columns(); ++column)
        values.col(column) = legendre(polynomial.degree, (map.x(column) - polynomial.x_centre) / polynomial.half_x);
    return values;
}

} // namespace

double Polynomial::height(double x, double y) const {
    return along_row(*this, y).dot(legendre(degree, (x - x_centre) / half_x));
}

Polynomial least_squares_polynomial(const HeightMap& map, int degree) {
    if (degree < 0 || degree > 20)
        throw std::invalid_argument("least_squares_polynomial: the degree must be from 0 to 20");
    Polynomial polynomial{.degree = degree,
                          .x_centre = (map.x(0) + map.x(map.columns() - 1)) / 2,
                          .y_centre = (map.y(0) + map.y(map.rows() - 1)) / 2,
                          .half_x = map.pitch_x * std::max(map.columns() - 1, 1) / 2,
                          .half_y = map.pitch_y * std::max(map.rows() - 1, 1) / 2,
                          .coefficients = {}};
    const Eigen::MatrixXd p = along_columns(map, polynomial);
    const int terms = (degree + 1) * (degree + 2) / 2;
    // Normal equations, the sums over a row first: a row shares its powers of y.
    Eigen::MatrixXd matrix = Eigen::MatrixXd::Zero(terms, terms);
    Eigen::VectorXd right = Eigen::VectorXd::Zero(terms);
    double count = 0;
    Eigen::MatrixXd measured(degree + 1, map.columns());
    Eigen::VectorXd heights(map.columns());
    for (int row = 0; row < map.rows(); ++row) {
        int points = 0;
        for (int column = 0; column < map.columns(); ++column)
            if (const double z = map.height(column, row); std::isfinite(z)) {
                measured.col(points) = p.col(column);
                heights[points++] = z;
            }
        count += points;
        const auto present = measured.leftCols(points);
        const Eigen::MatrixXd squares = present * present.transpose();
        const Eigen::VectorXd products = present * heights.head(points);
        const Eigen::VectorXd q = legendre(degree, (map.y(row) - polynomial.y_centre) / polynomial.half_y);
        for_terms(degree, [&](int term, int i, int j) {
            right[term] += products[i] * q[j];
            for_terms(degree, [&](int other, int k, int l) { matrix(term, other) += squares(i, k) * q[j] * q[l]; });
        });
    }
    Eigen::VectorXd solution = matrix.completeOrthogonalDecomposition().solve(right);
    if (count == 0)
        solution.setConstant(std::numeric_limits<double>::quiet_NaN());
    polynomial.coefficients.assign(solution.begin(), solution.end());
    return polynomial;
}

HeightMap remove_polynomial(HeightMap map, const Polynomial& polynomial) {
    const Eigen::MatrixXd p = along_columns(map, polynomial);
    for (int row = 0; row < map.rows(); ++row) {
        const Eigen::VectorXd coefficients = along_row(polynomial, map.y(row));
        for (int column = 0; column < map.columns(); ++column)
            map.height(column, row) -= coefficients.dot(p.col(column));
    }
    return map;
}

} // namespace vkfv::surface
