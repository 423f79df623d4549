#include "physics/physics.hpp"
#include "support/statistics.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <numeric>

using namespace vkfv::physics::f64;
using vkfv::test::chi_square_p;
using vkfv::test::integrate;

namespace {

constexpr int rays = 1500000;
constexpr int annuli = 30;
constexpr double false_positive_rate = 1e-4; // of each test here; seeds are fixed

// The numbers of rays of a disc (radius, hemisphere) that land in rings of equal width on a plane at `distance`.
std::vector<double> land_in_rings(double radius, double distance, double outermost, uint seed) {
    std::vector<double> seen(annuli + 1);
    for (uint k = 0; k < rays; ++k) {
        const Draws u = draw(seed, 0u, uvec2(k, 0u), 0u);
        const Ray ray = fly_to_plane(emit_from_disc(radius, 1.0, 0.0, u.u0, u.u1, u.u2, u.u3), distance, 1.0);
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

// The light of a source small against its distance obeys E = E0 cos^4(theta); with d = 1, E0 = 1 / (pi d^2) of the
// emitted power.
TEST(Source, ASmallDiscObeysTheCosineToTheFourthLaw) {
    const auto seen = land_in_rings(1e-6, 1.0, 3.0, 11u);
    const auto law = [](double power) {
        return [power](double r) { return std::pow(1 / std::sqrt(1 + r * r), power) / M_PI; };
    };
    EXPECT_GT(chi_square_p(seen, expected_in_rings(law(4), 3.0)), false_positive_rate);
    EXPECT_LT(chi_square_p(seen, expected_in_rings(law(4.02), 3.0)), false_positive_rate); // wrong twin
}

// P. D. Foote, Bull. Bur. Stand. 12 (1915) 583, gives the irradiance of a plane parallel to a Lambertian disc of radius
// R at the distance d and offset x: E = (M/2) [1 - (x^2 + d^2 - R^2) / sqrt((x^2 + d^2 + R^2)^2 - 4 x^2 R^2)], M the
// exitance.
TEST(Source, AFiniteDiscObeysFootesFormula) {
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

// The configuration factor of a surface element at the distance 1 below a corner of a parallel rectangle a x b (J. R.
// Howell, A Catalog of Radiation Heat Transfer Configuration Factors, C-11); it is odd in both sides, so that four
// corners make any rectangle.
double corner_factor(double a, double b) {
    const double along = std::sqrt(1 + a * a), across = std::sqrt(1 + b * b);
    return (a / along * std::atan(b / along) + b / across * std::atan(a / across)) / (2 * M_PI);
}

// The irradiance is the factor times the exitance pi L, and pi L w h is the flux: shares of the flux on 12 x 10 cells
// of a plane, and beside them. So the whole of the light, pi L times the area, is the sum over all of the plane.
TEST(Source, ARectangleObeysTheConfigurationFactor) {
    constexpr double half_width = 0.8, half_height = 0.3, width = 3.6, height = 3;
    constexpr int columns = 12, rows = 10;
    std::vector<double> seen(columns * rows + 1);
    for (uint k = 0; k < rays; ++k) {
        const Draws u = draw(14u, 0u, uvec2(k, 0u), 0u);
        const Ray ray =
            fly_to_plane(emit_from_rectangle(half_width, half_height, 1.0, 0.0, u.u0, u.u1, u.u2, u.u3), 1.0, 1.0);
        const double column = std::floor((ray.position.x / width + 0.5) * columns);
        const double row = std::floor((ray.position.y / height + 0.5) * rows);
        const bool inside = column >= 0 && column < columns && row >= 0 && row < rows;
        seen[inside ? static_cast<std::size_t>(row * columns + column) : seen.size() - 1] += 1;
    }
    const auto expected = [&](double a, double b) {
        const auto irradiance = [&](double x, double y) {
            return (corner_factor(a - x, b - y) - corner_factor(-a - x, b - y) - corner_factor(a - x, -b - y) +
                    corner_factor(-a - x, -b - y)) /
                   (4 * a * b);
        };
        std::vector<double> counts;
        double sum = 0;
        for (int row = 0; row < rows; ++row) {
            const double y = (static_cast<double>(row) / rows - 0.5) * height;
            for (int column = 0; column < columns; ++column) {
                const double x = (static_cast<double>(column) / columns - 0.5) * width;
                const double share = integrate(
                    [&](double at_y) {
                        return integrate([&](double at_x) { return irradiance(at_x, at_y); }, x, x + width / columns,
                                         4);
                    },
                    y, y + height / rows, 4);
                counts.push_back(share * rays);
                sum += share;
            }
        }
        counts.push_back((1 - sum) * rays);
        return counts;
    };
    EXPECT_GT(chi_square_p(seen, expected(half_width, half_height)), false_positive_rate);
    // The wrong twins are a little wider, or have their sides exchanged.
    EXPECT_LT(chi_square_p(seen, expected(1.03 * half_width, half_height)), false_positive_rate);
    EXPECT_LT(chi_square_p(seen, expected(half_height, half_width)), false_positive_rate);
}

// A Lambertian source sends sin^2 of its flux into a cone; the aimed source is the whole one's part in that cone.
TEST(Source, AnAimedDiscIsTheConeCutOutOfTheWhole) {
    const double sine = 0.3;
    std::vector<double> whole(20), aimed(20);
    double inside = 0;
    for (uint k = 0; k < rays; ++k) {
        const Draws u = draw(13u, 0u, uvec2(k, 0u), 0u);
        const double a = emit_from_disc(1.0, 1.0, 0.0, u.u0, u.u1, u.u2, u.u3).direction.z;
        const double b = emit_from_disc(1.0, sine, 0.0, u.u0, u.u1, u.u2, u.u3).direction.z;
        const auto bin = [&](double cosine) {
            return static_cast<std::size_t>((1 - cosine * cosine) / (sine * sine) * 20);
        };
        if (bin(a) < 20) {
            whole[bin(a)] += 1;
            inside += 1;
        }
        aimed[std::min<std::size_t>(bin(b), 19)] += 1;
    }
    EXPECT_LT(vkfv::test::share_z(inside, rays, sine * sine), 4.0);        // two-sided, 6e-5
    EXPECT_GT(vkfv::test::share_z(inside, rays, sine * sine * 1.03), 4.0); // wrong twin
    const std::vector<double> uniform_aimed(20, rays / 20.0), uniform_whole(20, inside / 20.0);
    EXPECT_GT(chi_square_p(aimed, uniform_aimed), false_positive_rate);
    EXPECT_GT(chi_square_p(whole, uniform_whole), false_positive_rate);
}

// An aim whose middle moves with the place is a part cut out of the whole too: about the middle it is as even, from
// every part of the source. Bins are of equal light: by the place, and by the distance from the middle and the side of
// it.
TEST(Source, AnAimThatMovesWithThePlaceIsCutOutOfTheWhole) {
    constexpr double sine = 0.3, shift = -0.6;
    constexpr int places = 5, distances = 6, sides = 8, bins = places * distances * sides;
    double off_unit = 0;
    const auto in_bins = [&](double emission_sine, double emission_shift, double middle, bool rectangle, uint seed) {
        std::vector<double> seen(bins);
        for (uint k = 0; k < rays; ++k) {
            const Draws u = draw(seed, 0u, uvec2(k, 0u), 0u);
            const Ray ray = rectangle
                                ? emit_from_rectangle(0.8, 0.5, emission_sine, emission_shift, u.u0, u.u1, u.u2, u.u3)
                                : emit_from_disc(1.0, emission_sine, emission_shift, u.u0, u.u1, u.u2, u.u3);
            off_unit = std::max(off_unit, std::abs(glm::length(ray.direction) - 1));
            const glm::dvec2 place(ray.position);
            const glm::dvec2 beside = glm::dvec2(ray.direction) - middle * place;
            const double distance = glm::dot(beside, beside) / (sine * sine);
            if (distance < 1) {
                const double share = rectangle ? 0.5 + place.x / 1.6 : glm::dot(place, place);
                const double side = std::atan2(beside.y, beside.x) / (2 * M_PI) + 0.5;
                const int ring = std::min(int(share * places), places - 1) * distances + int(distance * distances);
                const int bin = ring * sides + std::min(int(side * sides), sides - 1);
                seen[static_cast<std::size_t>(bin)] += 1;
            }
        }
        return seen;
    };
    const auto p_of = [&](const std::vector<double>& seen) {
        const double inside = std::accumulate(seen.begin(), seen.end(), 0.0);
        return chi_square_p(seen, std::vector<double>(bins, inside / bins));
    };
    for (const bool rectangle : {false, true}) {
        const auto whole = in_bins(1, 0, shift, rectangle, 23u);
        const double inside = std::accumulate(whole.begin(), whole.end(), 0.0);
        EXPECT_LT(vkfv::test::share_z(inside, rays, sine * sine), 4.0);
        EXPECT_GT(p_of(whole), false_positive_rate);
        const auto aimed = in_bins(sine, shift, shift, rectangle, 24u);
        EXPECT_GE(std::accumulate(aimed.begin(), aimed.end(), 0.0), rays - 1); // but for rounding on the rim
        EXPECT_GT(p_of(aimed), false_positive_rate);
        EXPECT_LT(p_of(in_bins(sine, shift, 0.99 * shift, rectangle, 25u)), false_positive_rate); // wrong twin
    }
    EXPECT_LT(off_unit, 1e-15);
}

namespace {

constexpr double pi = M_PI;

// A ring 60 degrees high, broad enough that its inside and outside differ.
RingLight broad_ring() {
    RingLight ring{};
    ring.distance = 50;
    ring.elevation_sine = std::sin(pi / 3);
    ring.elevation_cosine = std::cos(pi / 3);
    ring.half_width = 10;
    ring.fill = 1;
    ring.segments = 1;
    ring.switched_on = 1u;
    return ring;
}

// A ray of the ring in the specimen's frame, its aim at the origin, and where on the band it starts.
struct RingRay {
    glm::dvec3 position;
    glm::dvec3 direction;
    double across;  // mm, from the middle of the band, upward
    double azimuth; // turns, from +x towards +y
};

RingRay ring_ray(const RingLight& ring, double sine, uint seed, uint k) {
    const Draws u = draw(seed, 0u, uvec2(k, 0u), 0u);
    const Ray ray = emit_from_ring(ring, sine, u.u0, u.u1, u.u2, u.u3);
    const auto to_specimen = [](glm::dvec3 v) { return glm::dvec3(v.x, -v.y, -v.z); };
    RingRay result{to_specimen(ray.position), to_specimen(ray.direction), 0, 0};
    const double rho = std::hypot(result.position.x, result.position.y);
    result.across = result.position.z * ring.elevation_cosine - rho * ring.elevation_sine;
    const double turns = std::atan2(result.position.y, result.position.x) / (2 * pi);
    result.azimuth = turns < 0 ? turns + 1 : turns;
    return result;
}

} // namespace

// Every ray starts on the band, within the sectors of the segments that are on.
TEST(RingLight, StandsWhereItIsSaidTo) {
    RingLight ring = broad_ring();
    ring.segments = 8;
    ring.switched_on = 0b10010110u;
    ring.fill = 0.7;
    std::vector<double> segments(8);
    std::vector<double> within(20);
    for (uint k = 0; k < 200000; ++k) {
        const RingRay ray = ring_ray(ring, 1, 21u, k);
        const double rho = std::hypot(ray.position.x, ray.position.y);
        // The band is at right angles to the direction of its middle.
        ASSERT_NEAR(rho * ring.elevation_cosine + ray.position.z * ring.elevation_sine, ring.distance, 1e-12);
        ASSERT_LE(std::abs(ray.across), ring.half_width * (1 + 1e-12));
        ASSERT_GT(ray.position.z, 0);
        const int segment = static_cast<int>(8 * ray.azimuth);
        ASSERT_EQ(ring.switched_on >> segment & 1u, 1u) << ray.azimuth;
        const double place = (8 * ray.azimuth - segment - 0.5) / ring.fill + 0.5;
        ASSERT_GT(place, -1e-12);
        ASSERT_LT(place, 1 + 1e-12);
        segments[static_cast<std::size_t>(segment)] += 1;
        within[static_cast<std::size_t>(std::clamp(20 * place, 0.0, 19.5))] += 1;
    }
    std::vector<double> expected(8);
    for (const std::size_t on : {1u, 2u, 4u, 7u}) {
        expected[on] = 200000 / 4.0;
    }
    EXPECT_GT(chi_square_p(segments, expected), false_positive_rate);
    EXPECT_GT(chi_square_p(within, std::vector<double>(20, 200000 / 20.0)), false_positive_rate);
}

// Light is uniform per area: over the width the density goes as the radius. A density uniform in width is the wrong
// twin.
TEST(RingLight, IsUniformOverItsArea) {
    const RingLight ring = broad_ring();
    const double radius = ring.distance * ring.elevation_cosine;
    std::vector<double> across(30), azimuths(30), expected;
    for (uint k = 0; k < 300000; ++k) {
        const RingRay ray = ring_ray(ring, 1, 22u, k);
        across[static_cast<std::size_t>(std::clamp(15 + 15 * ray.across / ring.half_width, 0.0, 29.5))] += 1;
        azimuths[static_cast<std::size_t>(30 * ray.azimuth)] += 1;
    }
    for (int i = 0; i < 30; ++i) {
        const double middle = ring.half_width * (-1 + (i + 0.5) / 15);
        expected.push_back(1e4 * (radius - middle * ring.elevation_sine) / radius);
    }
    EXPECT_GT(chi_square_p(across, expected), false_positive_rate);
    EXPECT_LT(chi_square_p(across, std::vector<double>(30, 1e4)), false_positive_rate);
    EXPECT_GT(chi_square_p(azimuths, std::vector<double>(30, 1e4)), false_positive_rate);
}

// About the normal towards the aim, sin^2 of the angle to it is uniform up to that of the cone, the cosine (the wrong
// twin) is not, and the azimuth about it is.
TEST(RingLight, IsLambertianAboutTheWayToItsAim) {
    const RingLight ring = broad_ring();
    const double sine = 0.9;
    std::vector<double> squares(20), cosines(20), azimuths(20);
    const double least_cosine = std::sqrt(1 - sine * sine);
    for (uint k = 0; k < 300000; ++k) {
        const RingRay ray = ring_ray(ring, sine, 23u, k);
        const glm::dvec3 outward(std::cos(2 * pi * ray.azimuth), std::sin(2 * pi * ray.azimuth), 0);
        const glm::dvec3 normal = -ring.elevation_cosine * outward - glm::dvec3(0, 0, ring.elevation_sine);
        const glm::dvec3 around = glm::cross(glm::dvec3(0, 0, 1), outward);
        const double cosine = glm::dot(ray.direction, normal);
        ASSERT_NEAR(glm::length(ray.direction), 1, 1e-14);
        const double share = (1 - cosine * cosine) / (sine * sine);
        squares[static_cast<std::size_t>(std::clamp(20 * share, 0.0, 19.5))] += 1;
        cosines[static_cast<std::size_t>(std::clamp(20 * (cosine - least_cosine) / (1 - least_cosine), 0.0, 19.5))] +=
            1;
        const double angle =
            std::atan2(glm::dot(ray.direction, around), glm::dot(ray.direction, glm::cross(normal, around)));
        azimuths[static_cast<std::size_t>(std::clamp(10 * (1 + angle / pi), 0.0, 19.5))] += 1;
    }
    const std::vector<double> uniform(20, 300000 / 20.0);
    EXPECT_GT(chi_square_p(squares, uniform), false_positive_rate);
    EXPECT_LT(chi_square_p(cosines, uniform), false_positive_rate);
    EXPECT_GT(chi_square_p(azimuths, uniform), false_positive_rate);
}

// The irradiance is E = L times the projected solid angle: the band is seen from its aim at elevations e +- atan(h /
// d), so E = L pi (sin^2 up - sin^2 down) with the radiance L = flux / (pi area), area 2 pi d cos(e) 2 h.
TEST(RingLight, LightsItsAimAsItsProjectedSolidAngleSays) {
    for (const double elevation : {pi / 6, pi / 3}) {
        RingLight ring = broad_ring();
        ring.half_width = 4;
        ring.elevation_sine = std::sin(elevation);
        ring.elevation_cosine = std::cos(elevation);
        const double half_angle = std::atan(ring.half_width / ring.distance);
        const double area = 4 * pi * ring.distance * ring.elevation_cosine * ring.half_width;
        const double irradiance =
            (std::pow(std::sin(elevation + half_angle), 2) - std::pow(std::sin(elevation - half_angle), 2)) / area;
        // The cone reaches from the farthest of the band to the rim of a spot of this radius, over which E changes by
        // (spot / d)^2.
        constexpr double spot = 2;
        constexpr double sine = 0.15;
        constexpr int count = 400000;
        double landed = 0;
        for (uint k = 0; k < count; ++k) {
            const RingRay ray = ring_ray(ring, sine, 24u, k);
            const glm::dvec3 at = ray.position - ray.direction * (ray.position.z / ray.direction.z);
            landed += at.x * at.x + at.y * at.y < spot * spot ? 1 : 0;
        }
        const double share = irradiance * pi * spot * spot / (sine * sine);
        EXPECT_LT(vkfv::test::share_z(landed, count, share), 4.0) << landed / count << " " << share;
        // The wrong twin has the cosine of the elevation for its sine.
        EXPECT_GT(vkfv::test::share_z(landed, count, share / std::tan(elevation)), 4.0);
    }
}

// The half of a ring that is switched on lights from its own side, across the axis to the other.
TEST(RingLight, HalfOfItLightsFromItsSide) {
    for (const uint half : {0u, 1u}) {
        RingLight ring = broad_ring();
        ring.segments = 2;
        ring.switched_on = 1u << half;
        const double side = half == 0u ? 1 : -1; // segment 0: from +x over +y to -x
        double mean = 0;
        for (uint k = 0; k < 20000; ++k) {
            const RingRay ray = ring_ray(ring, 0.3, 25u, k);
            ASSERT_GE(side * ray.position.y, 0);
            mean += side * ray.direction.y / 20000;
        }
        EXPECT_LT(mean, -0.25); // -cos(60 degrees) times 2 / pi, less the cone's own spread
    }
}

TEST(TurnOf, AgreesWithCosineAndSine) {
    for (int i = 0; i <= 20000; ++i) {
        const double u = i / 20000.0;
        // A few roundings of 2^-53 are left, in float three of 2^-24. GLSL's own functions may be off by 2^-11.
        EXPECT_NEAR(turn_of(u).cosine, std::cos(2 * pi * u), 1e-15);
        EXPECT_NEAR(turn_of(u).sine, std::sin(2 * pi * u), 1e-15);
        const float single = static_cast<float>(u);
        EXPECT_NEAR(vkfv::physics::f32::turn_of(single).cosine, std::cos(2 * pi * double(single)), 1.8e-7);
        EXPECT_NEAR(vkfv::physics::f32::turn_of(single).sine, std::sin(2 * pi * double(single)), 1.8e-7);
        EXPECT_NEAR(turn_of(u - 3).sine, std::sin(2 * pi * u), 3e-15); // u - 3 rounds to 2^-52
    }
}
