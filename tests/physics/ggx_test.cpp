// GGX is reciprocal, has the formula of textbooks, and keeps the share of light that another program finds, at both
// ends of its roughness too.
#include "ggx_quadratures.hpp"
#include "physics/physics.hpp"
#include "specimen/scatter_tables.hpp"
#include "support/statistics.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <random>

using namespace vkfv::physics::f64;
using vkfv::test::integrate;
using vkfv::test::kept_by_ggx;
using vkfv::test::share_z;

namespace {

namespace f32 = vkfv::physics::f32;

constexpr double z_limit = 4.0; // two-sided, 6e-5 a test; seeds are fixed

Material ggx(double alpha) {
    return {{SCATTER_GGX, 1, alpha, 0, 0, 0, {}}, {}, {}, {}};
}

real3 direction(double theta, double azimuth = 0) {
    return {std::sin(theta) * std::cos(azimuth), std::sin(theta) * std::sin(azimuth), std::cos(theta)};
}
const real3 up{0, 0, 1};

double radians(double degrees) {
    return degrees * M_PI / 180;
}

// The masking function Lambda = (sqrt(1 + alpha^2 tan^2) - 1) / 2.
double masking(double alpha, double cosine) {
    return (std::sqrt(1 + alpha * alpha * (1 / (cosine * cosine) - 1)) - 1) / 2;
}

// D G_2 / (4 cos_i cos_o), as Walter et al. (eq. 20, 33) and Heitz (eq. 99) print it; or with each direction's masking
// for itself.
double textbook(double alpha, real3 from, real3 to, bool correlated = true) {
    const real3 m = glm::normalize(from + to);
    const double tan2 = 1 / (m.z * m.z) - 1;
    const double d = alpha * alpha / (M_PI * std::pow(m.z, 4) * std::pow(alpha * alpha + tan2, 2));
    const double i = masking(alpha, from.z), o = masking(alpha, to.z);
    return d / (correlated ? 1 + i + o : (1 + i) * (1 + o)) / (4 * from.z * to.z);
}

// The share of the light that is scattered over the hemisphere, of which half is integrated, by the trapezoidal rule in
// the azimuth.
template <class Bsdf>
double kept(Bsdf bsdf, double theta) {
    const int azimuths = 512;
    double sum = 0;
    for (int k = 0; k <= azimuths; ++k) {
        const auto at = [&](double t) { // the cosine is 1 - t^2
            const double cosine = 1 - t * t;
            return 2 * t * cosine * bsdf(direction(theta), direction(std::acos(cosine), M_PI * k / azimuths));
        };
        sum += integrate(at, 0.0, 1 - 1e-9, 200) * (k % azimuths == 0 ? 1 : 2);
    }
    return sum * M_PI / azimuths;
}

} // namespace

TEST(Ggx, IsReciprocal) {
    std::mt19937 engine(7);
    std::uniform_real_distribution<double> uniform(0, 1);
    const auto above = [&](const Frame& frame, real3 normal) {
        const real3 d = direction(std::acos(uniform(engine)), 2 * M_PI * uniform(engine));
        return frame.first * d.x + frame.second * d.y + normal * d.z;
    };
    for (int k = 0; k < 20000; ++k) {
        const Material material = ggx(std::pow(10, -3 * uniform(engine)));
        const real3 normal = direction(std::acos(2 * uniform(engine) - 1), 2 * M_PI * uniform(engine));
        const Frame frame = frame_around(normal);
        const real3 a = above(frame, normal), b = above(frame, normal);
        const double there = scatter_bsdf(material, -a, normal, b), back = scatter_bsdf(material, -b, normal, a);
        ASSERT_GT(there, 0);
        EXPECT_LT(std::abs(there - back), 1e-12 * there);
    }
    // Henyey-Greenstein is not reciprocal: its norm is that of the incidence. scipy's quadrature of both norms gives
    // 1.8657.
    const auto ratio = [](const Material& material) {
        const real3 steep = direction(radians(60));
        return scatter_bsdf(material, -steep, up, up) / scatter_bsdf(material, -up, up, steep);
    };
    const Material henyey_greenstein = {
        vkfv::specimen::tabulated({SCATTER_HENYEY_GREENSTEIN, 1, 0.8, 0, 0, 0, {}}), {}, {}, {}};
    EXPECT_NEAR(ratio(henyey_greenstein), 1.8657, 1e-4);
    EXPECT_NEAR(ratio(ggx(0.3)), 1, 1e-12);
}

TEST(Ggx, IsTheTextbooksFormula) {
    double uncorrelated = 0;
    for (const double alpha : {0.01, 0.1, 0.3, 0.7, 1.0}) {
        for (const double theta : {0.0, 0.4, 1.0, 1.5}) {
            for (int k = 0; k < 200; ++k) {
                const real3 from = direction(theta), to = direction(1.55 * k / 200, 2.4 * k);
                const double bsdf = scatter_bsdf(ggx(alpha), -from, up, to);
                // tan^2 by 1 / cos^2 - 1 loses 1e-16 / alpha^2.
                EXPECT_NEAR(bsdf / textbook(alpha, from, to), 1, 1e-10) << alpha << " " << theta << " " << k;
                uncorrelated = std::max(uncorrelated, std::abs(bsdf / textbook(alpha, from, to, false) - 1));
            }
        }
    }
    EXPECT_GT(uncorrelated, 0.5); // wrong twin
}

// In the white furnace the density keeps the share of single scattering, and so does the sampler, which absorbs the
// rest and loses nothing else.
TEST(Ggx, KeepsTheShareOfSingleScattering) {
    for (const auto& [alpha, degrees, share] : kept_by_ggx) {
        SCOPED_TRACE(testing::Message() << alpha << " at " << degrees);
        const Material material = ggx(alpha);
        const double theta = radians(degrees);
        const auto own = [&](real3 from, real3 to) { return scatter_bsdf(material, -from, up, to); };
        EXPECT_NEAR(kept(own, theta), share, 1e-6);
        if (degrees > 0) { // wrong twin: no correlation, which normal incidence does not know
            const auto twin = [&](real3 from, real3 to) { return textbook(alpha, from, to, false); };
            EXPECT_GT(std::abs(kept(twin, theta) - share), 5e-5);
        }
        constexpr uint draws = 200000;
        double accepted = 0, absorbed = 0;
        for (uint k = 0; k < draws; ++k) {
            const Scattered s = scatter(material, -direction(theta), up, 41u, 1u, uvec2(k, 0u), 1u);
            accepted += s.accepted ? 1 : 0;
            absorbed += s.absorbed ? 1 : 0;
        }
        EXPECT_EQ(accepted + absorbed, draws);
        EXPECT_LT(share_z(accepted, draws, share), z_limit);
        EXPECT_GT(share_z(accepted, draws, share - 0.01), z_limit); // wrong twin
    }
}

// With alpha = 1, D is 1 / pi at all angles, and what is left is the law of Lommel and Seeliger, which keeps
// 1 - mu ln((1 + mu) / mu), mu the incidence's cosine.
TEST(Ggx, OfFullRoughnessIsLommelSeeliger) {
    for (const double degrees : {0.0, 30.0, 60.0, 85.0}) {
        const real3 from = direction(radians(degrees));
        const double mu = from.z;
        for (int k = 0; k < 50; ++k) {
            const real3 to = direction(0.03 * k, 2.4 * k);
            EXPECT_NEAR(scatter_bsdf(ggx(1), -from, up, to) * 2 * M_PI * (mu + to.z), 1, 1e-13);
            EXPECT_GT(std::abs(scatter_bsdf(ggx(0.99), -from, up, to) * 2 * M_PI * (mu + to.z) - 1), 1e-5); // twin
        }
        const double share = 1 - mu * std::log((1 + mu) / mu);
        EXPECT_NEAR(kept([](real3 in, real3 out) { return scatter_bsdf(ggx(1), -in, up, out); }, radians(degrees)),
                    share, 1e-6);
    }
}

// At normal incidence half of the light meets facets of slopes below alpha, and goes off at less than twice their
// angle: for sharp lobes too, on a surface that no axis is normal to, in float as in double.
TEST(Ggx, HalfOfTheLightStaysWithinTwiceTheSlope) {
    const real3 normal = direction(0.7, 0.3);
    constexpr uint draws = 100000;
    for (const double alpha : {0.001, 0.01, 0.1}) {
        const auto within = [&](double slope) {
            std::pair<double, double> inside{0, 0};
            const double limit = 2 * std::sin(std::atan(slope)); // |direction - normal|
            f32::Material single{};
            single.lobe_0 = {f32::SCATTER_GGX, 1, static_cast<float>(alpha), 0, 0, 0, {}};
            for (uint k = 0; k < draws; ++k) {
                const auto s = scatter(ggx(alpha), -normal, normal, 42u, 1u, uvec2(k, 0u), 1u);
                const auto t = f32::scatter(single, glm::vec3(-normal), glm::vec3(normal), 42u, 1u, uvec2(k, 0u), 1u);
                inside.first += glm::length(s.direction - normal) < limit ? 1 : 0;
                inside.second += glm::length(glm::dvec3(t.direction) - normal) < limit ? 1 : 0;
            }
            return inside;
        };
        const auto [in_double, in_float] = within(alpha);
        EXPECT_LT(share_z(in_double, draws, 0.5), z_limit) << alpha;
        EXPECT_LT(share_z(in_float, draws, 0.5), z_limit) << alpha;
        EXPECT_GT(share_z(within(0.98 * alpha).first, draws, 0.5), z_limit) << alpha; // wrong twin
    }
}

// Float keeps the density near the mirror direction of the sharpest lobe, where 1 - cos^2 would be lost.
TEST(Ggx, FloatKeepsTheDensity) {
    for (const double alpha : {0.001, 0.01, 0.2}) {
        f32::Material single{};
        single.lobe_0 = {f32::SCATTER_GGX, 1, static_cast<float>(alpha), 0, 0, 0, {}};
        for (int k = 0; k < 200; ++k) {
            const double theta = 0.5, off = alpha * (k - 100) / 25;
            const glm::vec3 from(-direction(theta)), to(direction(-theta + off, 0.0));
            const double exact = scatter_bsdf(ggx(alpha), glm::dvec3(from), up, glm::dvec3(to));
            const double seen = f32::scatter_bsdf(single, from, glm::vec3(up), to);
            EXPECT_NEAR(seen / exact, 1, 1e-6 + 3e-7 / alpha) << alpha << " " << k;
        }
    }
}
