// A path's last scatter, decided by the gate (scatter_into_gate), agrees with the lobes' own draws and their density.
#include "trace/microscope.hpp"

#include "physics/scatter_registry.hpp"
#include "specimen/scatter_tables.hpp"
#include "support/statistics.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <vector>

using namespace vkfv;
using namespace vkfv::physics::f64;

namespace {

const real3 up(0, 0, 1);

struct Case {
    Lobe lobe;
    double theta; // of the incoming light
    double tilt;  // of the surface
};

std::vector<Case> cases() {
    std::vector<Case> result;
    for (const double theta : {0.0, 0.25}) {
        for (const double tilt : {0.0, 0.4}) {
            result.push_back({specimen::tabulated({SCATTER_LAMBERTIAN, 1, 0, 0, 0, 0, {}}), theta, tilt});
            for (const double g : {-0.2, 0.0, 0.3, 0.5, 0.7, 0.8, 0.9}) {
                result.push_back({specimen::tabulated({SCATTER_HENYEY_GREENSTEIN, 1, g, 0, 0, 0, {}}), theta, tilt});
            }
        }
    }
    return result;
}

Incidence incidence_of(const Case& c) {
    return make_incidence(real3(std::sin(c.theta), 0, -std::cos(c.theta)),
                          real3(std::sin(c.tilt) * 0.6, std::sin(c.tilt) * 0.8, std::cos(c.tilt)));
}

constexpr int rings = 6, sectors = 8;

// The number of the cell of a direction: cells are equal in the gate's slopes.
std::size_t cell_of(const GateDisc& disc, real3 direction) {
    const double x = (direction.x / direction.z - disc.centre.x) / disc.radius;
    const double y = (direction.y / direction.z - disc.centre.y) / disc.radius;
    const int ring = std::min(static_cast<int>(rings * (x * x + y * y)), rings - 1);
    const int sector = static_cast<int>(sectors * (0.5 + std::atan2(y, x) / (2 * M_PI))) % sectors;
    return static_cast<std::size_t>(ring * sectors + sector);
}

// The draws that pass into each cell of the gate, and in the last place those that do not pass.
std::vector<double> gated(const Case& c, const GateDisc& disc, std::uint32_t draws) {
    std::vector<double> seen(rings * sectors + 1);
    for (std::uint32_t k = 0; k < draws; ++k) {
        const Draws u = draw(31, 2, uvec2(k, 0), 1);
        const GatedScatter scattered = scatter_into_gate(c.lobe, incidence_of(c), disc, u.u0, u.u1, u.u2);
        EXPECT_TRUE(scattered.applies);
        seen[scattered.passes ? cell_of(disc, scattered.direction) : seen.size() - 1] += 1;
    }
    return seen;
}

// The expected counts by the density, over a fine grid of slopes; `jacobian` is the power of the cosine by which slopes
// become a solid angle.
std::vector<double> expected(const Case& c, const GateDisc& disc, std::uint32_t draws, int jacobian = 3) {
    std::vector<double> wanted(rings * sectors + 1);
    constexpr int fine = 24;
    const Incidence incidence = incidence_of(c);
    double inside = 0;
    for (int i = 0; i < rings * fine; ++i) {
        for (int j = 0; j < sectors * fine; ++j) {
            const real3 direction = direction_in_disc(disc, (i + 0.5) / (rings * fine), (j + 0.5) / (sectors * fine));
            const double density = lobe_bsdf(c.lobe, incidence, direction) *
                                   std::max(glm::dot(direction, incidence.normal), 0.0) *
                                   std::pow(direction.z, jacobian);
            const double share = density * M_PI * disc.radius * disc.radius / (rings * fine * sectors * fine);
            wanted[cell_of(disc, direction)] += draws * share;
            inside += share;
        }
    }
    wanted.back() = draws * (1 - inside);
    return wanted;
}

GateDisc disc_of_10x(double scale = 1) {
    const auto instrument = optics::assemble(test::microscope_description());
    GateDisc disc = gate_disc(instrument.constants, 0.01, real3(0.1, -0.2, 0.0));
    disc.radius *= scale;
    return disc;
}

TEST(GatedScatter, HasTheLobesDensityInTheGate) {
    const GateDisc disc = disc_of_10x();
    constexpr std::uint32_t draws = 400000;
    const auto all = cases();
    const double level = test::sidak(1e-3, static_cast<int>(all.size()));
    int seen_by_twin = 0;
    for (const Case& c : all) {
        SCOPED_TRACE(::testing::Message() << "model " << c.lobe.model << " g " << c.lobe.parameter_0 << " theta "
                                          << c.theta << " tilt " << c.tilt);
        const auto seen = gated(c, disc, draws);
        EXPECT_GT(test::chi_square_p(seen, expected(c, disc, draws)), level);
        // The wrong twin takes slopes for a solid angle.
        seen_by_twin += test::chi_square_p(seen, expected(c, disc, draws, 0)) < level ? 1 : 0;
    }
    EXPECT_GT(seen_by_twin, static_cast<int>(all.size()) * 2 / 3);
}

// The truth is the plain form: directions are drawn over the whole hemisphere, and those outside the gate escape.
TEST(GatedScatter, LooksLikeDirectionsDrawnOneByOne) {
    const GateDisc disc = disc_of_10x();
    constexpr std::uint32_t draws = 400000;
    for (const Case& c : cases()) {
        SCOPED_TRACE(::testing::Message() << "model " << c.lobe.model << " g " << c.lobe.parameter_0 << " theta "
                                          << c.theta << " tilt " << c.tilt);
        const Incidence incidence = incidence_of(c);
        const Material material{c.lobe, {}, {}, {}};
        std::vector<double> plain(rings * sectors + 1);
        for (std::uint32_t k = 0; k < draws; ++k) {
            const Scattered s = scatter(material, incidence.incoming, incidence.normal, 32, 3, uvec2(k, 0), 1);
            const double x = s.direction.x / s.direction.z - disc.centre.x;
            const double y = s.direction.y / s.direction.z - disc.centre.y;
            const bool inside = s.accepted && s.direction.z > 0 && x * x + y * y <= disc.radius * disc.radius;
            plain[inside ? cell_of(disc, s.direction) : plain.size() - 1] += 1;
        }
        const auto seen = gated(c, disc, draws);
        double chi_square = 0, degrees = -1;
        for (std::size_t cell = 0; cell < seen.size(); ++cell) {
            if (seen[cell] + plain[cell] >= 10) {
                chi_square += std::pow(seen[cell] - plain[cell], 2) / (seen[cell] + plain[cell]);
                degrees += 1;
            }
        }
        EXPECT_GT(test::chi_square_tail(chi_square, degrees), test::sidak(1e-3, static_cast<int>(cases().size())));
    }
}

TEST(GatedScatter, IsUsedWhereItIsExactAlone) {
    const auto applies = [](const Lobe& lobe, const GateDisc& disc, double tilt) {
        return scatter_into_gate(lobe, incidence_of({lobe, 0.0, tilt}), disc, 0.5, 0.5, 0.5).applies;
    };
    const auto hg = [](double g) { return specimen::tabulated({SCATTER_HENYEY_GREENSTEIN, 1, g, 0, 0, 0, {}}); };
    EXPECT_TRUE(applies(hg(0.3), disc_of_10x(), 0));
    EXPECT_TRUE(applies(hg(0.95), disc_of_10x(), 0));    // by the cone: its density times the gate exceeds 1
    EXPECT_FALSE(applies(hg(0.95), disc_of_10x(), 0.2)); // a cone around the whole gate exceeds 1 too
    EXPECT_TRUE(applies(hg(0.95), disc_of_10x(), 0.5));  // the lobe's middle is far from the gate
    EXPECT_FALSE(applies(hg(0.3), disc_of_10x(10), 0));
    EXPECT_FALSE(applies(hg(1), disc_of_10x(), 0));
    EXPECT_FALSE(applies({SCATTER_MIRROR, 1, 0, 0, 0, 0, {}}, disc_of_10x(), 0));
    EXPECT_FALSE(applies({SCATTER_GGX, 1, 0.3, 0, 0, 0, {}}, disc_of_10x(), 0));
    // Light from behind the surface is left to the plain form, which counts it as numerical.
    const Incidence behind = make_incidence(up, up);
    EXPECT_FALSE(scatter_into_gate(hg(0.3), behind, disc_of_10x(), 0.5, 0.5, 0.5).applies);
}

// The share of a lobe that a cone holds is the same in float as in double: for a lobe that is all but Lambertian a
// difference of two nearly equal numbers would be noise.
TEST(GatedScatter, KnowsTheShareWithinAConeInAFloat) {
    for (const double g : {1e-8, 6e-8, 1e-6, 1e-3, 0.3, 0.9, 0.99}) {
        Lobe lobe = specimen::tabulated({SCATTER_HENYEY_GREENSTEIN, 1, g, 0, 0, 0, {}});
        physics::f32::Lobe rounded{};
        rounded.parameter_0 = static_cast<float>(g);
        std::ranges::transform(lobe.table, std::begin(rounded.table),
                               [](double value) { return static_cast<float>(value); });
        const auto incidence = make_incidence(-up, up);
        const auto same = physics::f32::make_incidence(-glm::vec3(up), glm::vec3(up));
        for (const double versine : {0.1, 0.5, 2.0}) {
            const double share = henyey_greenstein_cone(g, lobe.table, incidence, versine, 0.5, 0.5).bound;
            const auto found = physics::f32::henyey_greenstein_cone(rounded.parameter_0, rounded.table, same,
                                                                    static_cast<float>(versine), 0.5F, 0.5F);
            EXPECT_NEAR(static_cast<double>(found.bound) / share, 1, 2e-5) << g << ' ' << versine;
            // The whole sphere holds all of the lobe: 1 / N.
            const double all = 1 / henyey_greenstein_norm(g, lobe.table, 1);
            EXPECT_TRUE(versine < 2 ? share < all : std::abs(share / all - 1) < 1e-12) << g;
        }
    }
}

// No direction is denser than the ceiling says for directions so far from the mirror's.
TEST(GatedScatter, TheCeilingIsOne) {
    for (const Case& c : cases()) {
        const Incidence incidence = incidence_of(c);
        for (std::uint32_t k = 0; k < 20000; ++k) {
            const Draws u = draw(33, 4, uvec2(k, 0), 0);
            const real3 direction = lambertian_direction(1, u.u0, u.u1);
            const double apart = glm::length(direction - incidence.mirror);
            const double bsdf = lobe_bsdf(c.lobe, incidence, direction);
            EXPECT_LE(bsdf, lobe_ceiling(c.lobe, incidence, apart) * (1 + 1e-12));
            EXPECT_LE(bsdf, lobe_ceiling(c.lobe, incidence, 0.5 * apart) * (1 + 1e-12));
        }
    }
}

} // namespace
