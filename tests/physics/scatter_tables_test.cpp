// The tables that the host works out for the scatter models agree with closed forms and integrals.
#include "specimen/scatter_tables.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <vector>

using namespace vkfv::physics::f64;
using vkfv::specimen::henyey_greenstein_exact_norm;
using vkfv::specimen::tabulated;

namespace {

namespace f32 = vkfv::physics::f32;

} // namespace

// The norm is N = sum over l of (2 l + 1) / 2 g^l P_l(cos(theta_i)) c_l with c_l the integral of mu P_l(mu) over [0,
// 1]: 1/2, 1/3, then 0 for odd l and c_2 = 1/8, c_{2k+2} = -c_{2k} (2k - 1) / (2k + 4).
TEST(ScatterTables, TheNormIsThatOfTheLegendreSeries) {
    const auto series = [](double g, double cosine) {
        double sum = 0.25 + g * cosine / 2;
        double before = cosine, legendre = (3 * cosine * cosine - 1) / 2, c = 0.125; // P_1, P_2, c_2
        for (int k = 1; k < 4000; ++k) {
            const int l = 2 * k;
            sum += (2 * l + 1) / 2.0 * std::pow(g, l) * legendre * c;
            before = ((2 * l + 1) * cosine * legendre - l * before) / (l + 1);
            legendre = ((2 * l + 3) * cosine * before - (l + 1) * legendre) / (l + 2);
            c *= -(2 * k - 1) / (2.0 * k + 4);
        }
        return sum;
    };
    EXPECT_NEAR(series(0.8, std::sqrt(0.5)) / series(0.8, 1), 0.725, 5e-4); // published to three digits
    for (const double g : {-0.9, -0.5, 0.0, 0.3, 0.65, 0.8, 0.9, 0.97, 0.995}) {
        for (const double degrees : {0.0, 20.0, 45.0, 70.0, 85.0, 89.5}) {
            const double cosine = std::cos(degrees * M_PI / 180), expected = series(g, cosine);
            EXPECT_NEAR(henyey_greenstein_exact_norm(g, cosine) / expected, 1, 1e-10) << g << " " << degrees;
            EXPECT_GT(std::abs(henyey_greenstein_exact_norm(g + 1e-3, cosine) / expected - 1), 1e-5) // wrong twin
                << g << " " << degrees;
        }
    }
}

// The norm that density and kernels take from the table is the integral's, in double and in float, between the points
// of the fit too.
TEST(ScatterTables, TheTableGivesTheNorm) {
    std::vector<double> gs = {-0.899, -0.41, -0.39, -1e-9, 1e-9, 0.39, 0.41, 0.995, 0.998, 0.999};
    for (int k = 0; k < 95; ++k) {
        gs.push_back(-0.9 + 0.02 * k);
    }
    const auto worst = [](double g, double table_g) {
        Lobe table = tabulated({SCATTER_HENYEY_GREENSTEIN, 1, table_g, 0, 0, 0, {}});
        float single[LOBE_TABLE_SIZE];
        std::ranges::transform(table.table, single, [](double value) { return float(value); });
        double error = 0;
        for (int k = 0; k <= 300; ++k) {
            const double cosine = std::pow(k / 300.0, 4); // dense at the horizon, over which sharp lobes change
            const double exact = henyey_greenstein_exact_norm(g, cosine);
            error = std::max(error, std::abs(henyey_greenstein_norm(g, table.table, cosine) / exact - 1));
            error = std::max(error, std::abs(f32::henyey_greenstein_norm(float(g), single, float(cosine)) / exact - 1));
        }
        return error;
    };
    for (const double g : gs) {
        EXPECT_LT(worst(g, g), 1e-6) << g;
    }
    EXPECT_LT(worst(0.9999, 0.9999), 3e-6);
    EXPECT_GT(worst(0.8, 0.8001), 1e-6); // wrong twin
}
