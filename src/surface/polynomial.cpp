#include "surface/polynomial.hpp"

#include <Eigen/Dense>

#include <algorithm>
#include <cmath>
#include <limits>
#include <stdexcept>

namespace vkfv::surface {
namespace {

// The Legendre polynomials P_0 to P_degree at u, by Bonnet's recursion.
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

// The polynomial in x along a row at y, as coefficients of P_i(u).
Eigen::VectorXd along_row(const Polynomial& polynomial, double y) {
    const Eigen::VectorXd q = legendre(polynomial.degree, (y - polynomial.y_centre) / polynomial.half_y);
    Eigen::VectorXd result = Eigen::VectorXd::Zero(polynomial.degree + 1);
    for_terms(polynomial.degree, [&](int term, int i, int j) {
        result[i] += polynomial.coefficients[static_cast<std::size_t>(term)] * q[j];
    });
    return result;
}

// The Legendre polynomials in x at the map's columns, one column of the matrix each.
Eigen::MatrixXd along_columns(const HeightMap& map, const Polynomial& polynomial) {
    Eigen::MatrixXd values(polynomial.degree + 1, map.columns());
    for (int column = 0; column < map.columns(); ++column)
        values.col(column) = legendre(polynomial.degree, (map.x(column) - polynomial.x_centre) / polynomial.half_x);
    return values;
}

// The least-squares problem, built row by row. Orthogonal transformations reduce it to a triangle, which stays as well
// conditioned as the equations; normal equations would square the condition number that gaps cause.
class Triangle {
  public:
    explicit Triangle(int terms)
        : terms_(terms), used_(0), equations_(Eigen::MatrixXd::Zero(4 * (terms + 1), terms + 1)) {}

    // Adds equations: the coefficients of the terms, and the right side in the last column; at most three times as many
    // rows as terms at once.
    void add(const Eigen::MatrixXd& rows) {
        if (used_ + rows.rows() > equations_.rows())
            reduce();
        equations_.middleRows(used_, rows.rows()) = rows;
        used_ += rows.rows();
    }

    Eigen::VectorXd solution() {
        reduce();
        return equations_.topLeftCorner(terms_, terms_)
            .completeOrthogonalDecomposition()
            .solve(equations_.col(terms_).head(terms_));
    }

  private:
    void reduce() {
        const Eigen::HouseholderQR<Eigen::Ref<Eigen::MatrixXd>> in_place(equations_);
        used_ = terms_ + 1;
        equations_.topRows(used_).triangularView<Eigen::StrictlyLower>().setZero();
        equations_.bottomRows(equations_.rows() - used_).setZero();
    }

    Eigen::Index terms_;
    Eigen::Index used_;
    Eigen::MatrixXd equations_;
};

struct Range {
    int first = std::numeric_limits<int>::max();
    int last = -1;

    void include(int k) {
        first = std::min(first, k);
        last = std::max(last, k);
    }
};

} // namespace

double Polynomial::height(double x, double y) const {
    return along_row(*this, y).dot(legendre(degree, (x - x_centre) / half_x));
}

Polynomial least_squares_polynomial(const HeightMap& map, int degree) {
    if (degree < 0 || degree > 20)
        throw std::invalid_argument("least_squares_polynomial: the degree must be from 0 to 20");
    Range columns, rows; // ranges with measured points
    for (int row = 0; row < map.rows(); ++row)
        for (int column = 0; column < map.columns(); ++column)
            if (std::isfinite(map.height(column, row))) {
                columns.include(column);
                rows.include(row);
            }
    const int terms = (degree + 1) * (degree + 2) / 2;
    Polynomial polynomial{.degree = degree, .coefficients = {}};
    if (rows.last < 0) {
        polynomial.coefficients.assign(static_cast<std::size_t>(terms), std::numeric_limits<double>::quiet_NaN());
        return polynomial;
    }
    polynomial.x_centre = (map.x(columns.first) + map.x(columns.last)) / 2;
    polynomial.y_centre = (map.y(rows.first) + map.y(rows.last)) / 2;
    polynomial.half_x = map.pitch_x * std::max(columns.last - columns.first, 1) / 2;
    polynomial.half_y = map.pitch_y * std::max(rows.last - rows.first, 1) / 2;

    const Eigen::MatrixXd p = along_columns(map, polynomial);
    Triangle triangle(terms);
    Eigen::MatrixXd measured(map.columns(), degree + 2); // a row's points: polynomials in x, and the height
    for (int row = rows.first; row <= rows.last; ++row) {
        Eigen::Index points = 0;
        for (int column = columns.first; column <= columns.last; ++column)
            if (const double z = map.height(column, row); std::isfinite(z)) {
                measured.row(points).head(degree + 1) = p.col(column).transpose();
                measured(points++, degree + 1) = z;
            }
        // All points of a row have the same polynomials in y, so the row reduces to as many equations as it has
        // polynomials in x.
        if (points > degree + 2) {
            Eigen::Ref<Eigen::MatrixXd> present = measured.topRows(points);
            const Eigen::HouseholderQR<Eigen::Ref<Eigen::MatrixXd>> in_place(present);
            points = degree + 1;
            measured.topRows(points).triangularView<Eigen::StrictlyLower>().setZero();
        }
        const Eigen::VectorXd q = legendre(degree, (map.y(row) - polynomial.y_centre) / polynomial.half_y);
        Eigen::MatrixXd equations(points, terms + 1);
        for_terms(degree, [&](int term, int i, int j) { equations.col(term) = q[j] * measured.col(i).head(points); });
        equations.col(terms) = measured.col(degree + 1).head(points);
        triangle.add(equations);
    }
    const Eigen::VectorXd solution = triangle.solution();
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
