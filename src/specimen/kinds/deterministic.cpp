#include "specimen/kinds/deterministic.hpp"

#include "core/keys/section.hpp"
#include "core/threads/parallel_rows.hpp"

#include <algorithm>
#include <cmath>

namespace vkfv::specimen {
namespace {

const NumberKey deterministic_sq_key =
    for_example("0.5", NumberKey("sq_um", NumberRange::at_least(0), needed, "Root mean square height over a period."));
const NumberKey deterministic_period_key = for_example(
    "50.0", NumberKey("period_um", NumberRange::positive(), needed, "Side of the square that is repeated."));
const IntegerKey orders_key("orders", 1, 32, 8, "Waves of the highest order in a period.");
const NumberKey deterministic_hurst_key("hurst_exponent", NumberRange::within(0, 1), 0.8,
                                        "Hurst exponent: how fast the amplitudes of shorter waves fall.");

struct Harmonic {
    int m, n;
    double amplitude, turns;
};

std::vector<Harmonic> harmonics_of(const Deterministic& texture) {
    const double golden = 0.5 * (std::sqrt(5.0) - 1);
    std::vector<Harmonic> harmonics;
    double squares = 0;
    for (int m = 0; m <= texture.orders; ++m) {
        for (int n = m == 0 ? 1 : -texture.orders; n <= texture.orders; ++n) {
            if (const int order = m * m + n * n; order <= texture.orders * texture.orders) {
                const double amplitude = std::pow(order, -0.5 * (1 + texture.hurst));
                harmonics.push_back({m, n, amplitude, golden * static_cast<double>(harmonics.size() + 1)});
                squares += 0.5 * amplitude * amplitude;
            }
        }
    }
    for (auto& one : harmonics) {
        one.amplitude *= texture.sq / std::sqrt(squares);
    }
    return harmonics;
}

} // namespace

std::vector<const Key*> Deterministic::keys() {
    return square_keys({&deterministic_sq_key, &deterministic_period_key, &orders_key, &deterministic_hurst_key});
}

Deterministic Deterministic::read(const Section& section) {
    Deterministic texture;
    read_square(section, texture);
    texture.sq = from_um(section.number(deterministic_sq_key));
    texture.period = from_um(section.number(deterministic_period_key));
    texture.orders = static_cast<int>(section.integer(orders_key));
    texture.hurst = section.number(deterministic_hurst_key);
    return texture;
}

void Deterministic::raise(HeightField& field, double, const SourceLocation& where) const {
    require_um(positive(period) && period >= 2 * orders * field.pitch_x, where, "period_um", period,
               "at least two points of the facets' grid for each of the orders");
    const auto harmonics = harmonics_of(*this);
    parallel_bands(field.heights.rows, 1, [&](int row, int) {
        const double y = field.y_min + row * field.pitch_y;
        for (int column = 0; column < field.heights.columns; ++column) {
            const double x = field.x_min + column * field.pitch_x;
            double z = 0;
            for (const auto& one : harmonics) {
                z += one.amplitude * std::cos(2 * pi * ((one.m * x + one.n * y) / period + one.turns));
            }
            field.heights(column, row) = static_cast<float>(z);
        }
    });
}

} // namespace vkfv::specimen
