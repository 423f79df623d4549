#include "surface/hybrid_parameters.hpp"

#include <cmath>

namespace vkfv::surface {
namespace {

struct MeanSquare {
    double sum = 0, count = 0;

    void add(double difference) {
        if (std::isfinite(difference)) {
            sum += difference * difference;
            count += 1;
        }
    }
    double value() const { return count > 0 ? sum / count : undefined; }
};

// The root mean square gradient from differences over so many pitches.
double gradient(const HeightMap& map, int over) {
    MeanSquare along_x, along_y;
    for (int row = 0; row < map.rows(); ++row)
        for (int column = 0; column < map.columns(); ++column) {
            const double z = map.height(column, row);
            if (column + over < map.columns())
                along_x.add((map.height(column + over, row) - z) / (over * map.pitch_x));
            if (row + over < map.rows())
                along_y.add((map.height(column, row + over) - z) / (over * map.pitch_y));
        }
    return std::sqrt(along_x.value() + along_y.value());
}

double area_ratio(const HeightMap& map) {
    double triangles = 0, excess = 0;
    const auto add_triangle = [&](double along_x, double along_y) {
        const double square = along_x * along_x + along_y * along_y;
        excess += square / (1 + std::sqrt(1 + square)); // sqrt(1 + square) - 1 without cancellation
        triangles += 1;
    };
    for (int row = 0; row + 1 < map.rows(); ++row)
        for (int column = 0; column + 1 < map.columns(); ++column) {
            const double a = map.height(column, row), b = map.height(column + 1, row);
            const double c = map.height(column, row + 1), d = map.height(column + 1, row + 1);
            if (!std::isfinite(a + b + c + d))
                continue;
            const double below = (b - a) / map.pitch_x, above = (d - c) / map.pitch_x;
            const double left = (c - a) / map.pitch_y, right = (d - b) / map.pitch_y;
            add_triangle(below, left);
            add_triangle(above, right);
            add_triangle(below, right);
            add_triangle(above, left);
        }
    return triangles > 0 ? excess / triangles : undefined;
}

} // namespace

HybridParameters hybrid_parameters(const HeightMap& map) {
    const double sdq = gradient(map, 1), coarser = gradient(map, 2);
    return {.sdq = sdq,
            .sdq_loss = sdq > 0 ? std::fmax(0, (1 - coarser / sdq) / 3) + 0 * coarser : undefined,
            .sdr = area_ratio(map)};
}

} // namespace vkfv::surface
