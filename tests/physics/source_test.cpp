#include "physics/physics.hpp"
#include "support/statistics.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <functional>

using namespace vkfv::physics::f64;
using vkfv::test::chi_square_p;
using vkfv::test::integrate;

namespace {

constexpr int rays = 1500000;
constexpr int annuli = 30;
constexpr double false_positive_rate = 1e-4; // of each test here; seeds are fixed

// Rays of a disc (radius, hemisphere) that land in rings of equal width on a plane at `distance`.
std::vector<double> land_in_rings(double radius, double distance, double outermost, uint seed) {
    std::vector<double> seen(annuli + 1);
    for (uint k = 0; k < rays; ++k) {
        const Draws u = draw(seed, 0u, uvec2(k, 0u), 0u);
        const Ray ray = fly_to_plane(emit_from_disc(radius, 1.0, u.u0, u.u1, u.u2, u.u3), distance, 1.0);
        const double r = std::hypot(ray.position.x, ray.position.y);
        seen[static_cast<std::size_t>(std::min<double>(annuli, r / outermost * annuli))] += 1;
    }
    return seen;
}

// Expected counts for an irradiance E(r), in units in which the source emits 1.
std::vector<double> expected_in_rings(const std::function<double(double)>& irradiance, double outermost) {
    std::vector<double> expected;
    double sum = 0;
    for (int ring = 0; ring < annuli; ++ring) {
        const double share = integrate([&](double r) { return 2 * M_PI * r * irradiance(r); },
                                       ring * outermost / annuli, (ring + 1) * outermost / annuli, 20);
        expected.push_back(share * rays);
        sum += share;
    }
    expected.push_back((1 - sum) * rays);
    return expected;
}

} // namespace

// A source small against its distance: E = E0 cos^4(theta); with d = 1, E0 = 1 / (pi d^2) of the emitted power.
TEST(Source, a_small_disc_obeys_the_cosine_to_the_fourth_law) {
    const auto seen = land_in_rings(1e-6, 1.0, 3.0, 11u);
    const auto law = [](double power) {
        return [power](double r) { return std::pow(1 / std::sqrt(1 + r * r), power) / M_PI; };
    };
    EXPECT_GT(chi_square_p(seen, expected_in_rings(law(4), 3.0)), false_positive_rate);
    EXPECT_LT(chi_square_p(seen, expected_in_rings(law(4.02), 3.0)), false_positive_rate); // wrong twin
}

// P. D. Foote, Bull. Bur. Stand. 12 (1915) 583: irradiance of a plane parallel to a Lambertian disc of radius R at the
// distance d and offset x: E = (M/2) [1 - (x^2 + d^2 - R^2) / sqrt((x^2 + d^2 + R^2)^2 - 4 x^2 R^2)], M the exitance.
TEST(Source, a_finite_disc_obeys_footes_formula) {
    const double d = 1.0;
    const auto foote = [d](double disc) {
        return [d, disc](double x) {
            const double a = x * x + d * d - disc * disc;
            const double b = x * x + d * d + disc * disc;
            return (1 - a / std::sqrt(b * b - 4 * x * x * disc * disc)) / (2 * M_PI * disc * disc);
        };
    };
    const auto seen = land_in_rings(0.8, d, 3.0, 12u);
    EXPECT_GT(chi_square_p(seen, expected_in_rings(foote(0.8), 3.0)), false_positive_rate);
    EXPECT_LT(chi_square_p(seen, expected_in_rings(foote(0.82), 3.0)), false_positive_rate); // wrong twin
}

// A Lambertian source sends sin^2 of its flux into a cone; the aimed source is the whole one's part in that cone.
TEST(Source, an_aimed_disc_is_the_cone_cut_out_of_the_whole) {
    const double sine = 0.3;
    std::vector<double> whole(20), aimed(20);
    double inside = 0;
    for (uint k = 0; k < rays; ++k) {
        const Draws u = draw(13u, 0u, uvec2(k, 0u), 0u);
        const double a = emit_from_disc(1.0, 1.0, u.u0, u.u1, u.u2, u.u3).direction.z;
        const double b = emit_from_disc(1.0, sine, u.u0, u.u1, u.u2, u.u3).direction.z;
        const auto bin = [&](double cosine) { return static_cast<std::size_t>((1 - cosine * cosine) / (sine * sine) * 20); };
        if (bin(a) < 20) {
            whole[bin(a)] += 1;
            inside += 1;
        }
        aimed[std::min<std::size_t>(bin(b), 19)] += 1;
    }
    EXPECT_LT(vkfv::test::share_z(inside, rays, sine * sine), 4.0);     // two-sided, 6e-5
    EXPECT_GT(vkfv::test::share_z(inside, rays, sine * sine * 1.03), 4.0); // wrong twin
    const std::vector<double> uniform_aimed(20, rays / 20.0), uniform_whole(20, inside / 20.0);
    EXPECT_GT(chi_square_p(aimed, uniform_aimed), false_positive_rate);
    EXPECT_GT(chi_square_p(whole, uniform_whole), false_positive_rate);
}
