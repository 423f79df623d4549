// A centred illumination as polynomials ends rays as the trace from surface to surface does.
#include "optics/instrument/train_polynomials.hpp"
#include "optics/parts.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <random>

using namespace vkfv;
using namespace vkfv::physics::f64;

namespace {

// The source is a little larger than the pupil, so that every stop has light to stop.
optics::Instrument microscope(const char* objective) {
    auto description = test::microscope(objective);
    description.source.radius = 1.02 * optics::assemble(description).first_order.pupil_radius_in_source;
    return optics::assemble(description);
}

physics::f32::TrainPolynomials in_float(const TrainPolynomials& train) {
    const auto polynomial = [](const Polynomial& from) {
        physics::f32::Polynomial to{};
        to.degree = from.degree;
        std::ranges::transform(from.terms, to.terms, [](double term) { return static_cast<float>(term); });
        return to;
    };
    physics::f32::TrainPolynomials result{};
    result.edges = train.edges;
    result.per_radius = static_cast<float>(train.per_radius);
    result.shift = static_cast<float>(train.shift);
    result.per_sine = static_cast<float>(train.per_sine);
    result.plane = static_cast<float>(train.plane);
    result.place_r = polynomial(train.place_r);
    result.place_s = polynomial(train.place_s);
    result.direction_r = polynomial(train.direction_r);
    result.direction_s = polynomial(train.direction_s);
    for (int e = 0; e < POLYNOMIAL_EDGES; ++e) {
        result.edge[e] = {.distance_squared = polynomial(train.edge[e].distance_squared),
                          .surface = train.edge[e].surface,
                          .inside_below = static_cast<float>(train.edge[e].inside_below),
                          .ends_from = static_cast<float>(train.edge[e].ends_from),
                          .ends_below = static_cast<float>(train.edge[e].ends_below)};
    }
    return result;
}

struct Compared {
    int told = 0;
    int ended = 0;
    int differing = 0;
    double place = 0; // mm, largest errors of what passes
    double direction = 0;
};

// Compares the rays that the source emits, with the polynomials in float as devices have them.
Compared compare(const optics::Instrument& instrument, const TrainPolynomials& polynomials, int count) {
    const physics::f32::TrainPolynomials rounded = in_float(polynomials);
    const auto& constants = instrument.constants;
    const optics::TrainScene scene{.surfaces = instrument.surfaces, .present = instrument.features};
    std::mt19937_64 generator(7);
    std::uniform_real_distribution<float> uniform(0, 1);
    Compared result;
    for (int k = 0; k < count; ++k) {
        const std::array u = {uniform(generator), uniform(generator), uniform(generator), uniform(generator)};
        const auto emitted = physics::f32::emit_from_disc(
            static_cast<float>(constants.source_radius), static_cast<float>(constants.emission_sine),
            static_cast<float>(constants.emission_shift), u[0], u[1], u[2], u[3]);
        const auto told = physics::f32::pass_by_polynomials(rounded, emitted, 1);
        if (!told.known) {
            continue;
        }
        Ray ray{};
        ray.position = glm::dvec3(emitted.position);
        ray.position.z = -constants.source_distance;
        const glm::dvec2 across(emitted.direction);
        ray.direction = {across.x, across.y, std::sqrt(1 - glm::dot(across, across))};
        const TrainResult traced = trace_train(scene, 0, constants.illumination_count, ray, 1, true, Light{});
        ++result.told;
        result.ended += told.status == PATH_ALIVE ? 0 : 1;
        if (traced.status != told.status || traced.surface != told.surface) {
            ++result.differing;
        } else if (traced.status == PATH_ALIVE) {
            const Ray there = fly_to_plane(traced.ray, polynomials.plane, traced.index);
            result.place =
                std::max(result.place, glm::length(glm::dvec2(there.position) - glm::dvec2(told.ray.position)));
            result.direction =
                std::max(result.direction, glm::length(there.direction - glm::dvec3(told.ray.direction)));
        }
    }
    return result;
}

} // namespace

// The value is the sum of the terms, each computed by itself, for every degree.
TEST(TrainPolynomials, AreTheSumOfTheirTerms) {
    std::mt19937_64 generator(5);
    std::uniform_real_distribution<double> uniform(-1, 1);
    for (int degree = 0; degree <= POLYNOMIAL_DEGREE; ++degree) {
        for (int round = 0; round < 20; ++round) {
            Polynomial polynomial{};
            polynomial.degree = degree;
            const double u = uniform(generator), v = uniform(generator), w = uniform(generator);
            double sum = 0;
            int place = 0;
            for (int i = 0; i <= POLYNOMIAL_DEGREE; ++i) {
                for (int j = 0; i + j <= POLYNOMIAL_DEGREE; ++j) {
                    for (int k = 0; i + j + k <= POLYNOMIAL_DEGREE; ++k, ++place) {
                        if (i + j + k <= degree) {
                            polynomial.terms[place] = uniform(generator);
                            sum += polynomial.terms[place] * std::pow(u, i) * std::pow(v, j) * std::pow(w, k);
                        }
                    }
                }
            }
            ASSERT_EQ(place, POLYNOMIAL_TERMS);
            EXPECT_NEAR(value_of(polynomial, u, v, w), sum, 1e-13);
        }
    }
}

// A million rays have equal statuses except for the few that are left to the trace, and light that passes lands within
// the errors that the fit has found; errors half as large again may be between its samples.
TEST(TrainPolynomials, EndAMillionRaysAsTheTraceDoes) {
    for (const char* objective : {"10x_0.28", "20x_0.41"}) {
        const auto instrument = microscope(objective);
        const auto fitted = optics::fit_illumination(instrument);
        ASSERT_TRUE(fitted) << objective;
        EXPECT_LE(fitted->place_error, 2e-4);
        constexpr int rays = 500000;
        const Compared compared = compare(instrument, fitted->polynomials, rays);
        EXPECT_EQ(compared.differing, 0) << objective;
        EXPECT_GT(compared.ended, rays / 100) << objective;
        EXPECT_GT(compared.told, 0.995 * rays) << objective;
        EXPECT_LT(compared.place, 1.5 * fitted->place_error + 1e-6) << objective;
        EXPECT_LT(compared.direction, 1.5 * fitted->direction_error + 1e-6) << objective;
        // The wrong twins are an edge whose radius is a thousandth larger, and a term that is a hundredth off.
        auto wide = fitted->polynomials;
        wide.edge[0].inside_below *= 1.002;
        wide.edge[0].ends_from *= 1.002;
        EXPECT_GT(compare(instrument, wide, rays / 10).differing, 0) << objective;
        auto off = fitted->polynomials;
        off.place_s.terms[0] *= 1.01;
        EXPECT_GT(compare(instrument, off, rays / 10).place, 10 * fitted->place_error) << objective;
    }
}

// An illumination is traced that depends on more than the ray, or of whose light too much comes near edges.
TEST(TrainPolynomials, LeaveOtherIlluminationsToTheTrace) {
    auto instrument = microscope("10x_0.28");
    ASSERT_TRUE(optics::fit_illumination(instrument));
    for (const std::uint32_t feature :
         {FEATURE_PLACEMENT, FEATURE_LOSSES, FEATURE_SPECTRUM, FEATURE_RING, FEATURE_LIGHT_FIELD}) {
        auto other = instrument;
        other.features |= feature;
        EXPECT_FALSE(optics::fit_illumination(other)) << feature;
    }
    EXPECT_FALSE(optics::fit_illumination(microscope("100x_0.83")));
}
