#include "surface/sphere.hpp"

#include <Eigen/Dense>

#include <cmath>

namespace vkfv::surface {
namespace {

using Eigen::Matrix4d;
using Eigen::Vector3d;
using Eigen::Vector4d;

template <class Visit>
void for_measured(const HeightMap& map, const Visit& visit) {
    for (int row = 0; row < map.rows(); ++row)
        for (int column = 0; column < map.columns(); ++column)
            if (const double z = map.height(column, row); std::isfinite(z))
                visit(Vector3d(map.x(column), map.y(row), z));
}

// Solves a linear system after scaling unknowns of different magnitude to one; NaN if the system leaves one
// undetermined.
template <class Matrix, class Vector>
Vector solve_scaled(const Matrix& matrix, const Vector& right) {
    const Vector scale = matrix.diagonal().cwiseSqrt().cwiseInverse();
    const auto decomposition = Matrix(scale.asDiagonal() * matrix * scale.asDiagonal()).fullPivLu();
    if (!scale.allFinite() || !decomposition.isInvertible())
        return Vector::Constant(undefined);
    return scale.asDiagonal() * decomposition.solve(Vector(scale.asDiagonal() * right));
}

} // namespace

double Sphere::height(double x, double y) const {
    const double dx = x - x_centre, dy = y - y_centre;
    const double square = dx * dx + dy * dy;
    // This form of the depth below the apex avoids cancellation for large radii.
    const double depth = square / (radius + std::sqrt(radius * radius - square));
    return convex ? apex - depth : apex + depth;
}

Sphere least_squares_sphere(const HeightMap& map) {
    double count = 0;
    Vector3d middle = Vector3d::Zero();
    for_measured(map, [&](const Vector3d& point) {
        middle += point;
        count += 1;
    });
    middle /= count;
    const Sphere none{.x_centre = undefined, .y_centre = undefined, .apex = undefined, .radius = undefined};
    if (count < 4)
        return none;

    // The algebraic fit |p|^2 = 2 c p + constant, over points relative to their mean, is linear in the centre c.
    Eigen::Matrix3d squares = Eigen::Matrix3d::Zero();
    Vector3d products = Vector3d::Zero();
    double mean_square = 0;
    for_measured(map, [&](const Vector3d& point) {
        const Vector3d p = point - middle;
        squares += p * p.transpose();
        products += 0.5 * p.squaredNorm() * p;
        mean_square += p.squaredNorm() / count;
    });
    const Vector3d centre = solve_scaled(squares, products);
    Sphere sphere{.x_centre = centre.x() + middle.x(),
                  .y_centre = centre.y() + middle.y(),
                  .radius = std::sqrt(mean_square + centre.squaredNorm()),
                  .convex = centre.z() < 0};
    const double side = sphere.convex ? 1 : -1;
    sphere.apex = middle.z() + centre.z() + side * sphere.radius;

    // The unknowns are the apex and the radius, at a fixed apex, instead of centre and radius, which would be nearly
    // dependent on a shallow cap.
    for (int iteration = 0; iteration < 100; ++iteration) {
        Matrix4d matrix = Matrix4d::Zero();
        Vector4d right = Vector4d::Zero();
        for_measured(map, [&](const Vector3d& point) {
            const Vector3d from_centre(point.x() - sphere.x_centre, point.y() - sphere.y_centre,
                                       point.z() - sphere.apex + side * sphere.radius);
            const double distance = from_centre.norm();
            const Vector3d normal = from_centre / distance;
            const Vector4d slope(-normal.x(), -normal.y(), -normal.z(), side * normal.z() - 1);
            matrix += slope * slope.transpose();
            right -= (distance - sphere.radius) * slope;
        });
        const Vector4d step = solve_scaled(matrix, right);
        sphere.x_centre += step[0];
        sphere.y_centre += step[1];
        sphere.apex += step[2];
        sphere.radius += step[3];
        if (!step.allFinite() || !(sphere.radius > 0))
            return none;
        if (std::abs(step[3]) < 1e-9 * sphere.radius)
            return sphere;
    }
    return none;
}

HeightMap remove_sphere(HeightMap map, const Sphere& sphere) {
    for (int row = 0; row < map.rows(); ++row)
        for (int column = 0; column < map.columns(); ++column)
            map.height(column, row) -= sphere.height(map.x(column), map.y(row));
    return map;
}

} // namespace vkfv::surface
