// Every model of shaders/physics/scatter, and the sums of lobes that materials are, draw their densities.
#include "physics/physics.hpp"
#include "physics/scatter_registry.hpp"
#include "specimen/scatter_tables.hpp"
#include "support/statistics.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <string>

using namespace vkfv::physics::f64;
using vkfv::specimen::tabulated;
using vkfv::test::integrate;
using vkfv::test::share_z;

namespace {

namespace f32 = vkfv::physics::f32;

constexpr uint draws_made = 1600000;
constexpr double z_limit = 3.5; // two-sided, 5e-4 a test; seeds are fixed

// Henyey and Greenstein's function, written anew: 1/sr.
double phase(double cosine, double g) {
    return (1 - g * g) / (4 * M_PI * std::pow(1 + g * g - 2 * g * cosine, 1.5));
}

real3 incoming_at(double theta) {
    return {std::sin(theta), 0.0, -std::cos(theta)};
}
const real3 up{0.0, 0.0, 1.0};

Lobe lobe(uint model, double weight, double parameter_0 = 0) {
    return tabulated({model, weight, parameter_0, 0, 0, 0, {}});
}

Material henyey_greenstein(double g) {
    return {lobe(SCATTER_HENYEY_GREENSTEIN, 1, g), {}, {}, {}};
}

struct Case {
    std::string name;
    bool delta;
    bool lossy;
    Material material; // one lobe of weight 1
};

// The cases: each model with its parameters at several places of their ranges; no place is an end, where a model may
// degenerate. Models that are read from a file have tests of their own.
std::vector<Case> cases() {
    std::vector<Case> result;
    for (uint model = 0; model < vkfv::physics::scatter_registry.size(); ++model) {
        const auto& entry = vkfv::physics::scatter_registry[model];
        if (entry.from_file) {
            continue;
        }
        const std::vector<double> places =
            entry.parameters.empty() ? std::vector<double>{0} : std::vector<double>{0.3, 0.55, 0.8, 0.93};
        for (const double place : places) {
            double values[4] = {0, 0, 0, 0};
            std::string name(entry.name);
            for (std::size_t k = 0; k < entry.parameters.size(); ++k) {
                const auto& parameter = entry.parameters[k];
                values[k] = parameter.minimum + place * (parameter.maximum - parameter.minimum);
                name += " " + std::string(parameter.name) + " = " + std::to_string(values[k]);
            }
            result.push_back({name,
                              entry.delta,
                              entry.lossy,
                              {tabulated({model, 1, values[0], values[1], values[2], values[3], {}}), {}, {}, {}}});
        }
    }
    return result;
}

// The share of light that is scattered: Simpson in t, the cosine being 1 - t^2, and the trapezoidal rule in the
// azimuth. Both resolve the sharpest lobe, of about 0.1 rad, and at grazing incidence 0.04 rad in the azimuth.
double share_scattered(const Material& material, double theta) {
    const int azimuths = 512;
    double sum = 0;
    for (int k = 0; k < azimuths; ++k) {
        const double phi = 2 * M_PI * k / azimuths;
        sum += integrate(
            [&](double t) {
                const double c = 1 - t * t;
                const double s = std::sqrt(1 - c * c);
                return 2 * t *
                       scatter_density(material, incoming_at(theta), up, {s * std::cos(phi), s * std::sin(phi), c});
            },
            0.0, 1.0, 200);
    }
    return sum * 2 * M_PI / azimuths;
}

// The mean of f(cos alpha) over the adapted density at normal incidence, by quadrature in the cosine.
template <class Function>
double mean_at_normal_incidence(double g, Function f) {
    // The substitution cos = 1 - t^4 resolves the peak at the mirror direction.
    const auto weigh = [&](auto h) {
        return integrate(
            [&](double t) {
                const double cosine = 1 - t * t * t * t;
                return h(cosine) * phase(cosine, g) * cosine * 4 * t * t * t;
            },
            0.0, 1.0, 4000);
    };
    return weigh(f) / weigh([](double) { return 1.0; });
}

// Draws at the incidence angle theta; calls visit(direction) for each.
template <class Visit>
void scatter_many(const Material& material, double theta, uint seed, Visit visit, uint draws = draws_made) {
    for (uint k = 0; k < draws; ++k) {
        const Scattered s = scatter(material, incoming_at(theta), up, seed, 1u, uvec2(k, 0u), 1u);
        if (s.accepted == 1u) {
            visit(s.direction);
        }
    }
}

double share_in_pupil(const Material& material, double sine, uint seed) {
    double inside = 0;
    scatter_many(material, 0.0, seed, [&](real3 d) { inside += std::hypot(d.x, d.y) < sine ? 1 : 0; });
    return inside;
}

// Cells of equal area of the unit disc under the hemisphere, and a last one for light that is not scattered.
constexpr int rings = 12, sectors = 16;

std::vector<double> seen_in_cells(const Material& material, double theta, uint seed, uint draws) {
    std::vector<double> seen(rings * sectors + 1);
    seen.back() = draws;
    scatter_many(
        material, theta, seed,
        [&](real3 d) {
            const double phi = std::atan2(d.y, d.x);
            const int ring = std::min<int>(rings - 1, static_cast<int>((d.x * d.x + d.y * d.y) * rings));
            const int sector = static_cast<int>((phi < 0 ? phi + 2 * M_PI : phi) / (2 * M_PI) * sectors) % sectors;
            seen[static_cast<std::size_t>(ring * sectors + sector)] += 1;
            seen.back() -= 1;
        },
        draws);
    return seen;
}

// The expected counts in the cells; density(direction) is per sr, and d(omega) cos(theta_o) = dA.
std::vector<double> expected_in_cells(const std::function<double(real3)>& density, uint draws) {
    std::vector<double> cells(rings * sectors + 1);
    const int sub = 24;
    double total = 0;
    for (int cell = 0; cell < rings * sectors; ++cell) {
        double& share = cells[static_cast<std::size_t>(cell)];
        for (int i = 0; i < sub * sub; ++i) {
            // Midpoints in the radius, in which a lobe about the normal is smooth.
            const double inner = std::sqrt(double(cell / sectors) / rings);
            const double width = std::sqrt(double(cell / sectors + 1) / rings) - inner;
            const double radius = inner + width * (i / sub + 0.5) / sub;
            const double phi = 2 * M_PI * (cell % sectors + (i % sub + 0.5) / sub) / sectors;
            const real3 d{radius * std::cos(phi), radius * std::sin(phi), std::sqrt(1 - radius * radius)};
            share += density(d) / d.z * radius * width;
        }
        share *= 2 * M_PI * draws / (sectors * sub * sub);
        total += share;
    }
    cells.back() = std::max(0.0, draws - total);
    return cells;
}

double deviation_p(const Material& material, double theta, uint seed, uint draws, const Material& expected,
                   double turn = 0) {
    const auto density = [&](real3 d) {
        const real3 turned{d.x * std::cos(turn) + d.z * std::sin(turn), d.y,
                           d.z * std::cos(turn) - d.x * std::sin(turn)};
        return scatter_density(expected, incoming_at(theta), up, turned);
    };
    return vkfv::test::chi_square_p(seen_in_cells(material, theta, seed, draws), expected_in_cells(density, draws));
}

} // namespace

// A density integrates to one over the hemisphere, or to 0 for a mirror; for lossy models no more than one is asked
// here, and their own tests know what they keep.
TEST(Scatter, EveryDensityIntegratesToOne) {
    int integrated = 0;
    for (const auto& [name, delta, lossy, material] : cases()) {
        for (const double theta : {0.0, 0.6, 1.2, 1.5}) {
            const double share = share_scattered(material, theta); // 1e-6 is what the densities are promised to
            EXPECT_NEAR(share, delta ? 0.0 : lossy ? std::min(share, 1.0) : 1.0, 1e-6) << name << " " << theta;
            integrated += delta ? 0 : 1;
        }
    }
    EXPECT_GE(integrated, 4 * 5);
    // The wrong twin is the density at another incidence, as if it were symmetric.
    const Material sharp = henyey_greenstein(0.8);
    const auto twin = [&](double c) {
        return scatter_density(sharp, incoming_at(std::acos(c)), up, {std::sin(0.6), 0, std::cos(0.6)});
    };
    EXPECT_GT(std::abs(2 * M_PI * integrate(twin, 0.0, 1.0) - 1), 1e-2);
}

// For every model the sampler draws its density: the family of tests errs once in 1000.
TEST(Scatter, EveryModelDrawsItsDensity) {
    const std::vector<double> thetas = {0.0, 0.7, 1.3};
    const uint draws = 200000;
    const auto all = cases();
    const double level = vkfv::test::sidak(1e-3, static_cast<int>(all.size() * thetas.size()));
    for (const auto& [name, delta, lossy, material] : all) {
        for (const double theta : thetas) {
            if (!delta) {
                EXPECT_GT(deviation_p(material, theta, 31u, draws, material), level) << name << " " << theta;
                // The wrong twin is 3 degrees off.
                EXPECT_LT(deviation_p(material, theta, 31u, draws, material, 0.05), level) << name << " " << theta;
            }
        }
    }
}

TEST(Scatter, ASumOfLobesHasTheWeightedMeanDensity) {
    const Material sum = {lobe(SCATTER_HENYEY_GREENSTEIN, 0.3, 0.8), lobe(SCATTER_LAMBERTIAN, 0.2),
                          lobe(SCATTER_HENYEY_GREENSTEIN, 0.1, -0.3), lobe(SCATTER_LAMBERTIAN, 0.15)};
    Material twin = sum; // of the same reflectance
    twin.lobe_0.weight = 0.29;
    twin.lobe_1.weight = 0.21;
    const auto mean = [&](real3 d) {
        double value = 0;
        for (const Lobe& part : {sum.lobe_0, sum.lobe_1, sum.lobe_2, sum.lobe_3}) {
            Lobe whole = part;
            whole.weight = 1;
            value += part.weight * scatter_density({whole, {}, {}, {}}, incoming_at(0.6), up, d);
        }
        return value;
    };
    const auto seen = seen_in_cells(sum, 0.6, 32u, draws_made);
    EXPECT_GT(vkfv::test::chi_square_p(seen, expected_in_cells(mean, draws_made)), 1e-3);
    EXPECT_GT(deviation_p(sum, 0.6, 32u, draws_made, sum), 1e-3);
    EXPECT_LT(deviation_p(sum, 0.6, 32u, draws_made, twin), 1e-3);
}

TEST(Scatter, ReflectanceIsTheShareThatIsNotAbsorbed) {
    for (const auto& [name, delta, lossy, material] : cases()) {
        if (delta && lossy) { // no density to integrate: conductor_test.cpp
            continue;
        }
        Material grey = material;
        grey.lobe_0.weight = 0.8;
        double scattered = 0;
        uint absorbed = 0;
        const uint draws = 200000;
        for (uint k = 0; k < draws; ++k) {
            const Scattered s = scatter(grey, incoming_at(0.4), up, 33u, 1u, uvec2(k, 0u), 1u);
            scattered += s.accepted;
            absorbed += s.absorbed;
        }
        EXPECT_EQ(scattered + absorbed, draws) << name;
        const double kept = lossy ? share_scattered(material, 0.4) : 1;
        EXPECT_LT(share_z(scattered, draws, 0.8 * kept), z_limit) << name;
        EXPECT_GT(share_z(scattered, draws, 0.8 * kept + 0.01), z_limit) << name; // wrong twin
    }
    EXPECT_EQ(scatter(Material{}, incoming_at(0.4), up, 33u, 1u, uvec2(0u), 1u).absorbed, 1u);
}

// Weights that add up to 1 absorb nothing, in float too: the rounding of their sum is less than half a step of the
// number that chooses. An absorber of one step more, 2^-20, would take one ray of a million.
TEST(Scatter, WeightsThatAddUpToOneAbsorbNothing) {
    const double parts[][4] = {{0.1, 0.2, 0.3, 0.4}, {0.7, 0.1, 0.1, 0.1}, {0.3, 0.3, 0.3, 0.1}, {0.6, 0.4, 0, 0}};
    const double largest = 1.0 - 1.0 / 4194304; // largest number that is drawn
    for (const auto& p : parts) {
        const Material whole = {lobe(SCATTER_LAMBERTIAN, p[0]), lobe(SCATTER_LAMBERTIAN, p[1]),
                                lobe(SCATTER_LAMBERTIAN, p[2]), lobe(SCATTER_LAMBERTIAN, p[3])};
        f32::Material single{};
        single.lobe_0.weight = static_cast<float>(p[0]);
        single.lobe_1.weight = static_cast<float>(p[1]);
        single.lobe_2.weight = static_cast<float>(p[2]);
        single.lobe_3.weight = static_cast<float>(p[3]);
        EXPECT_NE(choose_lobe(whole, largest).model, SCATTER_NONE) << p[0];
        EXPECT_NE(f32::choose_lobe(single, static_cast<float>(largest)).model, SCATTER_NONE) << p[0];
        single.lobe_0.weight -= 1.0f / 1048576; // wrong twin
        EXPECT_EQ(f32::choose_lobe(single, static_cast<float>(largest)).model, SCATTER_NONE) << p[0];
    }
}

TEST(Scatter, APupilCollectsTheClosedFormShare) {
    // The shares follow from the definition; for g = 0 it is sin^2 = 0.0784 exactly.
    const std::vector<std::pair<double, double>> published = {
        {0.0, 0.0784}, {0.3, 0.1174}, {0.65, 0.2914}, {0.8, 0.5125}, {0.95, 0.8780}};
    for (const auto& [g, share] : published) {
        const double pupil_cosine = std::sqrt(1 - 0.28 * 0.28);
        // The quadrature is of a step function: the pupil's edge is resolved to t^3 dt ~ 1e-4.
        const double quadrature = integrate([&](double c) { return phase(c, g) * c; }, pupil_cosine, 1.0, 4000) /
                                  integrate([&](double c) { return phase(c, g) * c; }, 0.0, 1.0, 40000);
        EXPECT_NEAR(quadrature, share, 5.1e-5) << g; // printed to four digits
        const double seen = share_in_pupil(henyey_greenstein(g), 0.28, 21u);
        EXPECT_LT(share_z(seen, draws_made, quadrature), z_limit) << g;
        // The wrong twin has a g that differs by 0.02.
        const double twin = share_in_pupil(henyey_greenstein(g < 0.9 ? g + 0.02 : g - 0.02), 0.28, 22u);
        EXPECT_GT(share_z(twin, draws_made, quadrature), z_limit) << g;
    }
    const Material lambertian = {lobe(SCATTER_LAMBERTIAN, 1), {}, {}, {}};
    for (const double sine : {0.15, 0.28, 0.66}) {
        EXPECT_LT(share_z(share_in_pupil(lambertian, sine, 28u), draws_made, sine * sine), z_limit) << sine;
        const double twin = 1 - std::sqrt(1 - sine * sine); // isotropic
        EXPECT_GT(share_z(share_in_pupil(lambertian, sine, 28u), draws_made, twin), z_limit) << sine;
    }
}

TEST(Scatter, MomentsAtNormalIncidenceAreShiftedByTheCosine) {
    const double g = 0.8;
    const auto p2 = [](double c) { return 1.5 * c * c - 0.5; };
    EXPECT_NEAR(mean_at_normal_incidence(g, [](double c) { return c; }), 0.9099, 5e-5);
    EXPECT_NEAR(mean_at_normal_incidence(g, p2), 0.7678, 5e-5);
    double sum = 0, sum_squared = 0, sum_p2 = 0, sum_p2_squared = 0;
    scatter_many(henyey_greenstein(g), 0.0, 23u, [&](real3 d) {
        sum += d.z;
        sum_squared += d.z * d.z;
        sum_p2 += p2(d.z);
        sum_p2_squared += p2(d.z) * p2(d.z);
    });
    const double n = draws_made;
    const double mean = sum / n, mean_p2 = sum_p2 / n;
    const double error = std::sqrt((sum_squared / n - mean * mean) / n);
    const double error_p2 = std::sqrt((sum_p2_squared / n - mean_p2 * mean_p2) / n);
    EXPECT_LT(std::abs(mean - 0.9099), z_limit * error + 5e-5);
    EXPECT_LT(std::abs(mean_p2 - 0.7678), z_limit * error_p2 + 5e-5);
    EXPECT_GT(std::abs(mean - g), z_limit * error); // wrong twins: the bare moments g and g^2
    EXPECT_GT(std::abs(mean_p2 - g * g), z_limit * error_p2);
}

// The truth is Henyey and Greenstein's formula written anew and normalised over the cells; the family of tests errs
// once in 1000.
TEST(Scatter, HenyeyGreensteinHasTheStatedDensityAtEveryIncidence) {
    const std::vector<double> gs = {-0.4, 0.0, 0.3, 0.65, 0.8, 0.9};
    const std::vector<double> thetas = {0.0, 0.5, 1.0, 1.4};
    const double level = vkfv::test::sidak(1e-3, static_cast<int>(gs.size() * thetas.size()));
    const auto expected = [&](double g, double theta, uint draws) {
        const real3 mirror{std::sin(theta), 0.0, std::cos(theta)};
        auto cells = expected_in_cells([&](real3 d) { return phase(dot(d, mirror), g) * d.z; }, draws);
        cells.back() = 0;
        double total = 0;
        for (const double cell : cells) {
            total += cell;
        }
        for (double& cell : cells) {
            cell *= draws / total;
        }
        return cells;
    };
    for (const double g : gs) {
        // Flat lobes take more draws to tell apart.
        const uint draws = g < 0 ? 2 * draws_made : draws_made;
        for (const double theta : thetas) {
            const auto seen = seen_in_cells(henyey_greenstein(g), theta, 24u, draws);
            EXPECT_EQ(seen.back(), 0) << g << " " << theta;
            EXPECT_GT(vkfv::test::chi_square_p(seen, expected(g, theta, draws)), level) << g << " " << theta;
            EXPECT_LT(vkfv::test::chi_square_p(seen, expected(g + 0.03, theta, draws)), level) // wrong twin
                << g << " " << theta;
        }
    }
}

TEST(Scatter, AWhiteFurnaceKeepsEveryRay) {
    auto all = cases();
    for (const double g : {-0.6, 0.0, 0.3, 0.36, 0.65, 0.8, 0.95, 0.99, 1.0}) {
        all.push_back({"henyey-greenstein g = " + std::to_string(g), false, false, henyey_greenstein(g)});
    }
    for (const auto& [name, delta, lossy, material] : all) {
        const double g = material.lobe_0.parameter_0;
        for (const double degrees : {0.0, 30.0, 60.0, 80.0, 89.0}) {
            uint lost = 0;
            uint below = 0;
            uint single = 0;
            for (uint k = 0; k < 4000; ++k) {
                const real3 in = incoming_at(degrees * M_PI / 180);
                const Scattered s = scatter(material, in, up, 25u, 1u, uvec2(k, 0u), 1u);
                lost += s.accepted || (lossy && s.absorbed) ? 0u : 1u;
                below += s.direction.z > 0 || s.absorbed ? 0u : 1u;
                const Draws u = draw(25u, 1u, uvec2(k, 0u), 1u);
                single += lobe_try(material.lobe_0, make_incidence(in, up), u.u0, u.u1, u.u2).accepted;
            }
            EXPECT_EQ(lost, 0u) << name << " at " << degrees;
            EXPECT_EQ(below, 0u) << name << " at " << degrees;
            // The wrong twin: without trying again energy is lost (except for the two forms that need one try).
            if (material.lobe_0.model == SCATTER_HENYEY_GREENSTEIN && g != 0.0 && g != 1.0) {
                EXPECT_LT(single, 4000u) << name << " at " << degrees;
            }
        }
    }
}

TEST(Scatter, LightFromBehindIsNotScattered) {
    const Scattered s = scatter(henyey_greenstein(0.8), real3(0.0, 0.0, 1.0), up, 1u, 1u, uvec2(0u), 1u);
    EXPECT_EQ(s.accepted, 0u);
    EXPECT_EQ(s.absorbed, 0u);
}

TEST(Scatter, TheEndsOfHenyeyGreensteinAreLambertianAndMirror) {
    const Material lambertian = {lobe(SCATTER_LAMBERTIAN, 1), {}, {}, {}};
    const Material mirror = {lobe(SCATTER_MIRROR, 1), {}, {}, {}};
    const Material zero = henyey_greenstein(0), one = henyey_greenstein(1);
    const Material near_zero = henyey_greenstein(0.05), near_one = henyey_greenstein(0.999);
    uint twins = 0;
    for (uint k = 0; k < 1000; ++k) {
        const uvec2 path(k, 0u);
        const double theta = 1.5 * k / 1000;
        const real3 in = incoming_at(theta);
        const real3 drawn = scatter(lambertian, in, up, 29u, 1u, path, 1u).direction;
        EXPECT_EQ(scatter(zero, in, up, 29u, 1u, path, 1u).direction, drawn);
        EXPECT_NEAR(scatter_density(zero, in, up, drawn), drawn.z / M_PI, 1e-12);
        EXPECT_NEAR(scatter_density(lambertian, in, up, drawn), drawn.z / M_PI, 1e-15);
        const real3 reflected = scatter(mirror, in, up, 29u, 1u, path, 1u).direction;
        EXPECT_EQ(scatter(one, in, up, 29u, 1u, path, 1u).direction, reflected);
        EXPECT_NEAR(glm::length(reflected - real3(std::sin(theta), 0, std::cos(theta))), 0, 1e-15);
        EXPECT_EQ(scatter_density(one, in, up, reflected), 0);
        // The wrong twins are near the ends, though they may draw the same direction where the first try is accepted.
        twins += scatter(near_zero, in, up, 29u, 1u, path, 1u).direction != drawn ? 1u : 0u;
        EXPECT_NE(scatter(near_one, in, up, 29u, 1u, path, 1u).direction, reflected);
    }
    EXPECT_GT(twins, 0u);
}

// Light of a cone that a tilted mirror returns into the cone is the overlap of two cones, weighted by the cosine to the
// axis.
TEST(Scatter, ATiltedMirrorReturnsTheOverlapOfTwoCones) {
    const double sine = 0.4;
    const auto returned = [&](const Material& mirror, double tilt) {
        const real3 normal{std::sin(tilt), 0.0, std::cos(tilt)};
        double inside = 0;
        for (uint k = 0; k < draws_made; ++k) {
            const Draws u = draw(26u, 0u, uvec2(k, 0u), 0u);
            const Ray ray = emit_from_disc(0.0, sine, 0.0, u.u0, u.u1, u.u2, u.u3);
            const real3 down{ray.direction.x, ray.direction.y, -ray.direction.z};
            const Scattered s = scatter(mirror, down, normal, 26u, 0u, uvec2(k, 0u), 1u);
            inside += s.accepted == 1u && std::hypot(s.direction.x, s.direction.y) < sine ? 1 : 0;
        }
        return inside;
    };
    const double n = draws_made;
    // The published shares have three digits; their rounding is added to the statistical error.
    const auto near = [&](double seen, double share) {
        return std::abs(seen / n - share) < z_limit * std::sqrt(share * (1 - share) / n) + 5e-4;
    };
    for (const Material& mirror : {henyey_greenstein(1), Material{lobe(SCATTER_MIRROR, 1), {}, {}, {}}}) {
        const double five = returned(mirror, 5 * M_PI / 180), ten = returned(mirror, 10 * M_PI / 180);
        EXPECT_TRUE(near(five, 0.741)) << five / n;
        EXPECT_TRUE(near(ten, 0.485)) << ten / n;
        EXPECT_FALSE(near(returned(mirror, 5.5 * M_PI / 180), 0.741)); // wrong twin
    }
}

TEST(Scatter, FloatDrawsTheSameDirectionsAsDouble) {
    // The lobe's versine of about 1e-6 and more keeps its relative precision in float: directions agree to a few
    // ulps (6e-8) of the unit vector; 1e-6 leaves a factor of ten for the sum of roundings.
    const auto differing = [](const Material& material, double twin) {
        const Lobe& lobe = material.lobe_0;
        f32::Material single{};
        single.lobe_0 = {lobe.model,
                         float(lobe.weight),
                         float(lobe.parameter_0 + twin),
                         float(lobe.parameter_1),
                         float(lobe.parameter_2),
                         float(lobe.parameter_3),
                         {}};
        std::ranges::transform(lobe.table, single.lobe_0.table, [](double value) { return float(value); });
        // Models that draw in the plane of direction cosines have their precision there; the height of the direction
        // over the surface loses it near the horizon.
        const bool in_cosines = lobe.model == SCATTER_ABG || lobe.model == SCATTER_HARVEY_SHACK;
        uint count = 0;
        for (uint k = 0; k < 20000; ++k) {
            const auto in = incoming_at(0.3);
            const Scattered a = scatter(material, in, up, 27u, 1u, uvec2(k, 0u), 1u);
            const auto b = f32::scatter(single, glm::vec3(in), glm::vec3(up), 27u, 1u, uvec2(k, 0u), 1u);
            real3 apart = glm::dvec3(b.direction) - a.direction;
            apart.z = in_cosines ? 0 : apart.z;
            count += glm::length(apart) > 1e-6 || (in_cosines && a.accepted != b.accepted) ? 1u : 0u;
        }
        return count;
    };
    auto all = cases();
    all.push_back({"henyey-greenstein g = 0.8", false, false, henyey_greenstein(0.8)});
    for (const auto& [name, delta, lossy, material] : all) {
        // A try within an ulp of its threshold may be decided differently: about 3 tries * 1e-7 a draw.
        EXPECT_LE(differing(material, 0), 2u) << name;
    }
    EXPECT_GT(differing(henyey_greenstein(0.8), 0.001), 2u); // wrong twin
}
