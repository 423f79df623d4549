// Scatter models agree with formulas written anew: the light that ggx-multiple-scatter gives back, the lobes of
// polished surfaces over direction cosines, and metals.
#include "ggx_quadratures.hpp"
#include "physics/physics.hpp"
#include "specimen/scatter_tables.hpp"
#include "support/statistics.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <complex>
#include <random>
#include <vector>

using namespace vkfv::physics::f64;
using vkfv::specimen::ggx_kept;
using vkfv::specimen::tabulated;
using vkfv::test::integrate;
using vkfv::test::kept_by_ggx;
using vkfv::test::share_z;

namespace {

namespace f32 = vkfv::physics::f32;

constexpr double z_limit = 4.0; // two-sided, 6e-5 a test; seeds are fixed
const real3 up{0, 0, 1};

Material one(uint model, double a = 0, double b = 0, double c = 0) {
    return {tabulated({model, 1, a, b, c, 0, {}}), {}, {}, {}};
}

real3 direction(double theta, double azimuth = 0) {
    return {std::sin(theta) * std::cos(azimuth), std::sin(theta) * std::sin(azimuth), std::cos(theta)};
}

double radians(double degrees) {
    return degrees * M_PI / 180;
}

// The share of the light that is scattered, twice that of half the hemisphere: Simpson in t, the cosine being 1 - t^2.
double kept(const Material& material, double theta) {
    const int azimuths = 512;
    double sum = 0;
    for (int k = 0; k <= azimuths; ++k) {
        const double part = integrate(
            [&](double t) {
                const double cosine = 1 - t * t;
                return 2 * t * cosine *
                       scatter_bsdf(material, -direction(theta), up, direction(std::acos(cosine), M_PI * k / azimuths));
            },
            0.0, 1 - 1e-9, 200);
        sum += part * (k % azimuths == 0 ? 1 : 2);
    }
    return sum * M_PI / azimuths;
}

// The share of a lobe over direction cosines that lies above the horizon, by numpy's Gauss points (400) along the
// radius and 4000 azimuths, about the mirror direction's cosines out to the unit circle.
struct LobeKept {
    uint model;
    double first, second, degrees, share;
};
constexpr LobeKept lobes_kept[] = {
    {SCATTER_HARVEY_SHACK, 0.2, -1.5, 30, 0.91639848}, {SCATTER_HARVEY_SHACK, 0.2, -1.5, 60, 0.70422794},
    {SCATTER_HARVEY_SHACK, 0.2, -1.5, 80, 0.59538818}, {SCATTER_HARVEY_SHACK, 0.05, -1, 60, 0.76190794},
    {SCATTER_HARVEY_SHACK, 0.6, -3, 60, 0.64020231},   {SCATTER_ABG, 0.01, 1.2, 30, 0.93095990},
    {SCATTER_ABG, 0.01, 1.2, 60, 0.75092267},          {SCATTER_ABG, 0.01, 1.2, 80, 0.62517827},
    {SCATTER_ABG, 1e-4, 2.5, 60, 0.89749006},          {SCATTER_ABG, 0.3, 0.5, 60, 0.87794318},
};

// The reflectances of s- and p-polarised light at the angle of incidence with this cosine, by complex amplitudes.
struct Polarised {
    double s, p;
    double mean() const { return 0.5 * (s + p); }
};
Polarised reflected(std::complex<double> index, double cosine) {
    const auto inside = std::sqrt(1.0 - (1 - cosine * cosine) / (index * index));
    return {std::norm((cosine - index * inside) / (cosine + index * inside)),
            std::norm((index * cosine - inside) / (index * cosine + inside))};
}

} // namespace

// In the white furnace, with the single scattering of another program, the light given back makes up for all that is
// lost.
TEST(GgxMultipleScatter, GivesBackWhatFacetsLoseByReflectingOnce) {
    for (const auto& [alpha, degrees, share] : kept_by_ggx) {
        SCOPED_TRACE(testing::Message() << alpha << " at " << degrees);
        EXPECT_NEAR(ggx_kept(alpha, std::cos(radians(degrees))), share, 2e-8);
        const auto given_back = [&](const Material& material) {
            Lobe lobe = material.lobe_0;
            const auto lack = [&](double mu) { return ggx_multiple_scatter_lack(lobe.parameter_0, lobe.table, mu); };
            // The integral over the azimuth gives 1 / pi; the cosine is s^2.
            const double mean = integrate([&](double s) { return 4 * s * s * s * lack(s * s); }, 0.0, 1.0);
            return lack(std::cos(radians(degrees))) * mean;
        };
        EXPECT_NEAR(share + given_back(one(SCATTER_GGX_MULTIPLE_SCATTER, alpha)), 1, 2e-6);
        EXPECT_GT(std::abs(share + given_back(one(SCATTER_GGX_MULTIPLE_SCATTER, alpha + 0.02)) - 1), 1e-3); // twin
    }
}

TEST(GgxMultipleScatter, ClosesTheWhiteFurnaceAtAnyRoughnessAndIncidence) {
    for (const double alpha : {0.05, 0.1, 0.3, 0.6, 1.0}) {
        const Material material = one(SCATTER_GGX_MULTIPLE_SCATTER, alpha);
        for (const double degrees : {0.0, 30.0, 60.0, 80.0}) {
            EXPECT_NEAR(kept(material, radians(degrees)), 1, 2e-3) << alpha << " at " << degrees;
        }
        // Near grazing incidence too the furnace closes, by the integral over the angle of scatter that tests above
        // hold to scipy's.
        Lobe lobe = material.lobe_0;
        for (const double degrees : {85.0, 89.0, 89.9}) {
            const auto lack = [&](double mu) { return ggx_multiple_scatter_lack(alpha, lobe.table, mu); };
            const double mean = integrate([&](double s) { return 4 * s * s * s * lack(s * s); }, 0.0, 1.0);
            const double cosine = std::cos(radians(degrees));
            EXPECT_NEAR(ggx_kept(alpha, cosine) + lack(cosine) * mean, 1, 1e-5) << alpha << " at " << degrees;
        }
        EXPECT_LT(kept(one(SCATTER_GGX, alpha), radians(80)), 0.96); // wrong twin: single scattering
    }
    // Full roughness has a closed form: single scattering keeps 1 - mu ln((1 + mu) / mu), as in ggx_test.cpp.
    for (const double mu : {1.0, 0.5, 0.1, 0.01}) {
        EXPECT_NEAR(ggx_kept(1, mu), 1 - mu * std::log((1 + mu) / mu), 1e-9);
    }
    EXPECT_NEAR(1 - ggx_kept(1, 1), 0.693, 5e-4);
}

TEST(GgxMultipleScatter, IsReciprocalAndGgxBesides) {
    std::mt19937 engine(8);
    std::uniform_real_distribution<double> uniform(0, 1);
    for (int k = 0; k < 8; ++k) {
        const double alpha = 0.001 + 0.999 * k / 7;
        const Material material = one(SCATTER_GGX_MULTIPLE_SCATTER, alpha);
        for (int j = 0; j < 300; ++j) {
            const real3 a = direction(std::acos(uniform(engine)), 7 * uniform(engine));
            const real3 b = direction(std::acos(uniform(engine)), 7 * uniform(engine));
            const double there = scatter_bsdf(material, -a, up, b), back = scatter_bsdf(material, -b, up, a);
            ASSERT_GT(there, 0);
            EXPECT_LT(std::abs(there - back), 1e-12 * there);
            EXPECT_GE(there, scatter_bsdf(one(SCATTER_GGX, alpha), -a, up, b));
        }
    }
}

TEST(HarveyShack, IsTheFormulaOfDirectionCosines) {
    for (const double shoulder : {0.003, 0.05, 0.4}) {
        for (const double slope : {-0.7, -1.5, -2.0, -3.0}) {
            const Material material = one(SCATTER_HARVEY_SHACK, shoulder, slope);
            const double peak = scatter_bsdf(material, -up, up, up);
            // The peak follows from a total integrated scatter of 1 in closed form.
            const double p = 1 + slope / 2, last = 1 + 1 / (shoulder * shoulder);
            const double total = slope == -2 ? std::log(last) : (std::pow(last, p) - 1) / p;
            EXPECT_NEAR(peak * M_PI * shoulder * shoulder * total, 1, 1e-9) << shoulder << " " << slope;
            for (int k = 0; k < 50; ++k) {
                const real3 from = direction(0.03 * k), to = direction(0.031 * k, 2.4 * k);
                const double apart = std::hypot(to.x + from.x, to.y + from.y);
                const double formula = std::pow(1 + apart * apart / (shoulder * shoulder), slope / 2);
                EXPECT_NEAR(scatter_bsdf(material, -from, up, to) / (peak * formula), 1, 1e-9);
                EXPECT_NEAR(scatter_bsdf(material, -to, up, from) / (peak * formula), 1, 1e-9); // reciprocal
            }
        }
    }
}

TEST(Abg, IsTheFormulaOfDirectionCosinesAndAHarveyShackLobeWhereGIsTwo) {
    for (const double b : {1e-9, 1e-4, 0.03, 1.0}) {
        // For g = 2 the factor A has a closed form.
        const Material material = one(SCATTER_ABG, b, 2);
        EXPECT_NEAR(scatter_bsdf(material, -up, up, up) * b * M_PI * std::log((1 + b) / b), 1, 1e-9) << b;
        const Material same = one(SCATTER_HARVEY_SHACK, std::sqrt(b), -2);
        for (const double g : {0.8, 1.5, 2.0, 2.7}) {
            const Material lobe = one(SCATTER_ABG, b, g);
            const double a = scatter_bsdf(lobe, -up, up, up) * b;
            for (int k = 0; k < 40; ++k) {
                const real3 from = direction(0.03 * k), to = direction(0.031 * k, 2.4 * k);
                const double apart = std::hypot(to.x + from.x, to.y + from.y);
                EXPECT_NEAR(scatter_bsdf(lobe, -from, up, to) * (b + std::pow(apart, g)) / a, 1, 1e-9);
                EXPECT_NEAR(scatter_bsdf(lobe, -to, up, from) * (b + std::pow(apart, g)) / a, 1, 1e-9);
                if (g == 2 && b < 1) {
                    EXPECT_NEAR(scatter_bsdf(lobe, -from, up, to) / scatter_bsdf(same, -from, up, to), 1, 1e-8);
                }
            }
        }
    }
}

// The sampler absorbs the light that would leave below the horizon, and nothing else, at all incidences.
TEST(ScatterOfCosines, KeepsTheShareOfTheLobeAboveTheHorizon) {
    constexpr uint draws = 40000;
    for (const auto& [model, first, second, degrees, share] : lobes_kept) {
        SCOPED_TRACE(testing::Message() << model << " " << first << " " << second << " at " << degrees);
        const Material material = one(model, first, second);
        double accepted = 0, absorbed = 0;
        for (uint k = 0; k < draws; ++k) {
            const Scattered s = scatter(material, -direction(radians(degrees)), up, 43u, 1u, uvec2(k, 0u), 1u);
            accepted += s.accepted ? 1 : 0;
            absorbed += s.absorbed ? 1 : 0;
        }
        EXPECT_EQ(accepted + absorbed, draws);
        EXPECT_LT(share_z(accepted, draws, share), z_limit);
        EXPECT_GT(share_z(accepted, draws, share + 0.02), z_limit); // wrong twin
    }
}

// Half of the light of sharp lobes lies within the median radius, in float as in double, on a surface that no axis is
// normal to.
TEST(ScatterOfCosines, HalfOfTheLightIsWithinTheMedianDistance) {
    const real3 normal = direction(0.7, 0.3);
    constexpr uint draws = 40000;
    struct Sharp {
        uint model;
        double first, second, median;
    };
    // The median of Harvey and Shack's lobe follows from (1 + (d/l)^2)^p = 1 + u ((1 + 1/l^2)^p - 1) with u = 1/2, and
    // that of ABg with g = 2 from log(1 + d^2/B) = u log(1 + 1/B).
    const auto harvey = [](double l, double slope) {
        const double p = 1 + slope / 2;
        return l * std::sqrt(std::pow(1 + 0.5 * (std::pow(1 + 1 / (l * l), p) - 1), 1 / p) - 1);
    };
    const auto abg = [](double b) { return std::sqrt(b * (std::exp(0.5 * std::log(1 + 1 / b)) - 1)); };
    for (const auto& [model, first, second, median] :
         {Sharp{SCATTER_HARVEY_SHACK, 0.001, -3, harvey(0.001, -3)},
          Sharp{SCATTER_HARVEY_SHACK, 0.01, -1.5, harvey(0.01, -1.5)}, Sharp{SCATTER_ABG, 1e-6, 2, abg(1e-6)},
          Sharp{SCATTER_ABG, 1e-3, 2, abg(1e-3)}}) {
        const Material material = one(model, first, second);
        f32::Material single{};
        single.lobe_0 = {model, 1, static_cast<float>(first), static_cast<float>(second), 0, 0, {}};
        double in_double = 0, in_float = 0, within_more = 0;
        for (uint k = 0; k < draws; ++k) {
            const auto apart = [&](real3 d) { return glm::length(d - normal * glm::dot(d, normal)); };
            const real3 s = scatter(material, -normal, normal, 44u, 1u, uvec2(k, 0u), 1u).direction;
            const auto t = f32::scatter(single, glm::vec3(-normal), glm::vec3(normal), 44u, 1u, uvec2(k, 0u), 1u);
            in_double += apart(s) < median ? 1 : 0;
            in_float += apart(real3(t.direction)) < median ? 1 : 0;
            within_more += apart(s) < 1.15 * median ? 1 : 0;
        }
        EXPECT_LT(share_z(in_double, draws, 0.5), z_limit) << model << " " << first;
        EXPECT_LT(share_z(in_float, draws, 0.5), z_limit) << model << " " << first;
        EXPECT_GT(share_z(within_more, draws, 0.5), z_limit) << model << " " << first; // wrong twin
    }
}

TEST(TotalScatter, IsThatOfThePhaseThatTheHeightMakes) {
    // A roughness of 10 nm at 632.8 nm has (4 pi 10 / 632.8)^2 = 0.03944.
    EXPECT_NEAR(vkfv::specimen::total_scatter(10e-6, 0.6328), 0.03867, 1e-5);
    EXPECT_NEAR(vkfv::specimen::total_scatter(1e-6, 0.6328) / 3.944e-4, 1, 1e-3);
    EXPECT_NEAR(vkfv::specimen::total_scatter(0.01, 0.5), 1, 1e-12);
}

// The indices are those of gold at 0.5876 um, silver, iron, a dielectric, and one below that of the medium.
TEST(Conductor, ReflectsAsFresnelsComplexAmplitudesSay) {
    const std::vector<std::complex<double>> indices = {{0.27, 2.95}, {0.05, 4.0}, {2.9, 3.1},
                                                       {1.5, 0},     {0.8, 0},    {4, 0.1}};
    for (const auto& index : indices) {
        for (int degrees = 0; degrees < 90; degrees += 5) {
            const double cosine = std::cos(radians(degrees));
            const Polarised wanted = reflected(index, cosine);
            const double seen = absorbing_reflectance(index.real(), index.imag(), cosine);
            EXPECT_NEAR(seen, wanted.mean(), 1e-12) << index << " " << degrees;
            const float single = f32::absorbing_reflectance(
                static_cast<float>(index.real()), static_cast<float>(index.imag()), static_cast<float>(cosine));
            EXPECT_NEAR(double(single), seen, 5e-6) << index << " " << degrees;
            if (index.imag() == 0 && index.real() > 1) {
                EXPECT_NEAR(seen, fresnel_reflectance(1, index.real(), cosine), 1e-12);
            }
            // The wrong twin is the reflectance of one polarisation.
            EXPECT_TRUE(degrees < 20 || index == std::complex<double>(0.8, 0) || std::abs(seen - wanted.s) > 1e-4)
                << index << " " << degrees;
        }
        // At normal incidence the reflectance is ((n - 1)^2 + k^2) / ((n + 1)^2 + k^2).
        EXPECT_NEAR(absorbing_reflectance(index.real(), index.imag(), 1),
                    std::norm(index - 1.0) / std::norm(index + 1.0), 1e-14);
    }
}

TEST(Conductor, AbsorbsWhatItDoesNotMirror) {
    constexpr uint draws = 40000;
    const std::complex<double> index(2.9, 3.1);
    for (const double degrees : {0.0, 50.0, 78.0, 88.0}) {
        const Material metal = one(SCATTER_CONDUCTOR, index.real(), index.imag());
        const double share = reflected(index, std::cos(radians(degrees))).mean();
        double accepted = 0;
        for (uint k = 0; k < draws; ++k) {
            const Scattered s = scatter(metal, -direction(radians(degrees)), up, 45u, 1u, uvec2(k, 0u), 1u);
            accepted += s.accepted ? 1 : 0;
            EXPECT_TRUE(s.accepted != s.absorbed);
            EXPECT_LT(glm::length(s.direction - direction(radians(degrees), M_PI)), 1e-12);
        }
        EXPECT_LT(share_z(accepted, draws, share), z_limit) << degrees;
        EXPECT_GT(share_z(accepted, draws, share + 0.02), z_limit) << degrees; // wrong twin
    }
}

TEST(GgxConductor, IsGgxTimesTheFacetsReflectance) {
    const std::complex<double> index(0.27, 2.95);
    const Material metal = one(SCATTER_GGX_CONDUCTOR, index.real(), index.imag(), 0.4), white = one(SCATTER_GGX, 0.4);
    double flat = 0; // wrong twin: the reflectance at the angle to the surface
    for (int k = 0; k < 200; ++k) {
        const real3 from = direction(0.007 * k), to = direction(0.0075 * k, 2.4 * k);
        const double cosine = glm::dot(from, glm::normalize(from + to));
        const double wanted = scatter_bsdf(white, -from, up, to) * reflected(index, cosine).mean();
        EXPECT_NEAR(scatter_bsdf(metal, -from, up, to) / wanted, 1, 1e-10);
        EXPECT_NEAR(scatter_bsdf(metal, -to, up, from) / wanted, 1, 1e-10); // reciprocal
        flat = std::max(flat, std::abs(reflected(index, from.z).mean() / reflected(index, cosine).mean() - 1));
    }
    EXPECT_GT(flat, 1e-3);
}
