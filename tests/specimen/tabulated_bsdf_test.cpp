// Tables of bsdfs are read, refused or warned of as documented, and draw their density.
#include "specimen/tabulated_bsdf.hpp"

#include "core/mathematics/units.hpp"
#include "core/messages/error.hpp"
#include "specimen/specimen.hpp"
#include "specimen/temporary_files.hpp"
#include "support/statistics.hpp"

#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <string>
#include <vector>

namespace vkfv::specimen {
namespace {

using physics::f64::real3;
using testing::AllOf;
using testing::HasSubstr;

// A bsdf by its angles in degrees.
using Bsdf = std::function<double(double incidence, double scatter, double azimuth)>;

double cosine(double degrees) {
    return std::cos(degrees * radians_per_degree);
}
double sine(double degrees) {
    return std::sin(degrees * radians_per_degree);
}

// A reciprocal bsdf that is brighter about the mirror direction.
double glossy(double incidence, double scatter, double azimuth) {
    const double apart = std::pow(sine(incidence), 2) + std::pow(sine(scatter), 2) -
                         2 * sine(incidence) * sine(scatter) * cosine(azimuth);
    return 0.1 / (0.1 + apart) + 0.03 * cosine(incidence) * cosine(scatter);
}

std::string csv(const Bsdf& bsdf, double step = 7.5) {
    std::string text = "incidence_deg,scatter_deg,azimuth_deg,bsdf_per_sr\n";
    for (double i = 0; i <= 75; i += 15) {
        for (double s = 0; s <= 90; s += step) {
            for (double a = 0; a <= 180; a += 22.5) {
                text += fmt::format("{},{},{},{:.9g}\n", i, s, a, bsdf(i, s, a));
            }
        }
    }
    return text;
}

struct Scene {
    const std::vector<float>* numbers;
    double material_number(int index) const { return static_cast<double>((*numbers)[static_cast<std::size_t>(index)]); }
};
struct FloatScene {
    const std::vector<float>* numbers;
    float material_number(int index) const { return (*numbers)[static_cast<std::size_t>(index)]; }
};

class TabulatedBsdfFile : public test::TemporaryFiles {
  protected:
    TabulatedBsdf read(const std::string& text, double limit = 0.1) const {
        return read_tabulated_bsdf(write("bsdf.csv", text), "specimen.material.file", limit);
    }
    std::string problem(const std::string& text, double limit = 0.1) const {
        try {
            (void)read(text, limit);
        } catch (const InputError& error) {
            return error.what();
        }
        return "";
    }
};

TEST_F(TabulatedBsdfFile, KeepsTheIntegralOfItsValues) {
    // The table has no azimuth, is rough as Lambert's law of reflectance 0.4, and has one incidence.
    std::string text = "incidence_deg,scatter_deg,bsdf_per_sr\n";
    for (const double s : {0.0, 30.0, 60.0, 85.0}) {
        text += fmt::format("20,{},{}\n", s, 0.4 / pi);
    }
    const auto even = read(text);
    EXPECT_NEAR(even.kept(0), 0.4, 1e-12);
    EXPECT_EQ(even.reciprocity_deviation(), std::nullopt);
    EXPECT_NEAR(even.at(1.2, 1.5, 2.0), 0.4 / pi, 1e-12); // held up to grazing
    // cos(scatter) / pi keeps 2/3; a fine table of it is met to the square of its step.
    const auto falling = read(csv([](double, double s, double) { return cosine(s) / pi; }, 2.5), 1e9);
    EXPECT_NEAR(falling.kept(2), 2.0 / 3, 1e-3);
    EXPECT_GT(std::abs(falling.kept(2) - 0.5), 0.1); // twin: without the cosine of the projected area once more
}

TEST_F(TabulatedBsdfFile, IsToldHowFarFromReciprocalItIs) {
    EXPECT_LT(*read(csv(glossy)).reciprocity_deviation(), 1e-6); // the digits of the file
    EXPECT_LT(
        *read(csv([](double i, double s, double) { return 0.1 * (cosine(i) + cosine(s)); })).reciprocity_deviation(),
        1e-6);
    // For f(i, o) = 0.3 cos(i) the deviation is the sum of |cos(i) - cos(o)| over that of cos(i), each of 0, 15, ... 75
    // degrees for the projected solid angle up to halfway to the next.
    const auto one_sided = [](double i, double, double) { return 0.3 * cosine(i); };
    const double deviation = *read(csv(one_sided), 1e9).reciprocity_deviation();
    double apart = 0, mean = 0;
    const auto area = [](double a) {
        return std::pow(sine(std::min(a + 7.5, 75.0)), 2) - std::pow(sine(std::max(a - 7.5, 0.0)), 2);
    };
    for (double a = 0; a <= 75; a += 15) {
        for (double b = 0; b <= 75; b += 15) {
            apart += area(a) * area(b) * std::abs(cosine(a) - cosine(b));
            mean += area(a) * area(b) * cosine(a);
        }
    }
    EXPECT_NEAR(deviation, apart / mean, 1e-6);
    EXPECT_GT(deviation, 0.2);
    EXPECT_THAT(problem(csv(one_sided)), AllOf(HasSubstr("bsdf.csv:2"), HasSubstr("a deviation from reciprocity of 0."),
                                               HasSubstr("at most 0.1"), HasSubstr("reciprocity_limit")));
}

TEST_F(TabulatedBsdfFile, RefusesWhatIsNoBsdf) {
    const std::string bright = csv([](double i, double, double) { return i == 30 ? 0.34 : 0.3; });
    EXPECT_THAT(problem(bright),
                AllOf(HasSubstr("bsdf.csv:236"), HasSubstr("1.06814 of the light is scattered at 30 degrees"),
                      HasSubstr("at most 1")));
    const std::string head = "incidence_deg,scatter_deg,bsdf_per_sr\n";
    EXPECT_THAT(problem(head + "0,0,0.1\n0,45,-0.1\n"), AllOf(HasSubstr("bsdf.csv:3"), HasSubstr("bsdf_per_sr -0.1")));
    EXPECT_THAT(problem(head + "0,0,0.1\n0,95,0.1\n"), AllOf(HasSubstr("bsdf.csv:3"), HasSubstr("scatter_deg 95")));
    EXPECT_THAT(problem(head + "90,0,0.1\n"), AllOf(HasSubstr("bsdf.csv:2"), HasSubstr("incidence_deg 90")));
    EXPECT_THAT(problem(head + "0,0,0.1\n0,0,0.2\n"), AllOf(HasSubstr("bsdf.csv:3"), HasSubstr("line 2 has it")));
    EXPECT_THAT(problem(head + "0,0,0.1\n0,45,0.1\n30,45,0.1\n"),
                AllOf(HasSubstr("bsdf.csv:4"), HasSubstr("no value at incidence 30, scatter 0")));
    EXPECT_THAT(problem("incidence_deg,scatter_deg\n0,0\n"), HasSubstr("bsdf_per_sr"));
}

// Chi-square over cells of the directions, and of what is not scattered, finds the density drawn; in float each draw is
// that in double.
TEST_F(TabulatedBsdfFile, DrawsItsDensity) {
    Material material{{{"tabulated", 1, {}}}};
    material.lobes[0].bsdf = read(csv(glossy));
    const auto numbers = material_numbers(material);
    EXPECT_EQ(numbers.spectral_points, 0);
    const Scene scene{&numbers.numbers};
    const FloatScene single{&numbers.numbers};
    const auto record = material_record(material);
    physics::f32::Material rounded{};
    rounded.lobe_0.model = record.lobe_0.model;
    rounded.lobe_0.weight = 1;
    std::ranges::transform(record.lobe_0.table, rounded.lobe_0.table,
                           [](double value) { return static_cast<float>(value); });
    constexpr int rings = 6, sectors = 12, fine = 24;
    constexpr std::uint32_t draws = 60000;
    const real3 up(0, 0, 1);
    const auto cell_of = [&](real3 d) {
        const int ring = std::min(static_cast<int>((d.x * d.x + d.y * d.y) * rings), rings - 1);
        const int sector = static_cast<int>((std::atan2(d.y, d.x) / (2 * pi) + 1) * sectors) % sectors;
        return static_cast<std::size_t>(ring * sectors + sector);
    };
    for (const double degrees : {0.0, 22.0, 60.0, 82.0}) {
        const real3 in(sine(degrees), 0, -cosine(degrees));
        const auto wanted = [&](double turn) {
            std::vector<double> cells(rings * sectors + 1);
            double inside = 0;
            for (int i = 0; i < rings * fine; ++i) {
                for (int j = 0; j < sectors * fine; ++j) {
                    const double square = (i + 0.5) / (rings * fine), phi = 2 * pi * (j + 0.5) / (sectors * fine);
                    const real3 d(std::sqrt(square) * std::cos(phi), std::sqrt(square) * std::sin(phi),
                                  std::sqrt(1 - square));
                    const real3 seen(d.x * std::cos(turn) + d.z * std::sin(turn), d.y,
                                     d.z * std::cos(turn) - d.x * std::sin(turn));
                    const double share =
                        scatter_bsdf(scene, record, in, up, seen) * pi / (rings * fine * sectors * fine);
                    cells[cell_of(d)] += draws * share;
                    inside += share;
                }
            }
            cells.back() = std::max(0.0, draws * (1 - inside));
            return cells;
        };
        std::vector<double> seen(rings * sectors + 1);
        int differing = 0, unlike = 0;
        for (std::uint32_t k = 0; k < draws; ++k) {
            const auto s = scatter(scene, record, in, up, 46u, 1u, glm::uvec2(k, 0u), 1u);
            EXPECT_TRUE(s.accepted != s.absorbed);
            seen[s.accepted ? cell_of(s.direction) : seen.size() - 1] += 1;
            if (k < 5000) {
                const auto t = physics::f32::scatter(single, rounded, glm::vec3(in), glm::vec3(up), 46u, 1u,
                                                     glm::uvec2(k, 0u), 1u);
                differing += t.accepted != s.accepted ? 1 : 0;
                unlike += s.accepted && t.accepted && glm::length(glm::dvec3(t.direction) - s.direction) > 1e-3 ? 1 : 0;
            }
        }
        EXPECT_GT(test::chi_square_p(seen, wanted(0)), test::sidak(1e-3, 4)) << degrees;
        EXPECT_LT(test::chi_square_p(seen, wanted(0.05)), test::sidak(1e-3, 4)) << degrees; // wrong twin: 3 degrees off
        EXPECT_LE(differing, 2) << degrees;
        EXPECT_LE(unlike, 2) << degrees;
    }
}

// The model gives the table's own values and their linear mean.
TEST_F(TabulatedBsdfFile, IsItsTableAtItsAngles) {
    Material material{{{"tabulated", 1, {}}}};
    material.lobes[0].bsdf = read(csv(glossy));
    const auto numbers = material_numbers(material);
    const auto record = material_record(material);
    const auto at = [&](double i, double s, double a) {
        const real3 in(sine(i), 0, -cosine(i)), out(sine(s) * cosine(a), sine(s) * sine(a), cosine(s));
        return scatter_bsdf(Scene{&numbers.numbers}, record, in, real3(0, 0, 1), out);
    };
    for (const double i : {15.0, 45.0, 75.0}) {
        for (const double s : {7.5, 30.0, 82.5}) {
            for (const double a : {0.0, 22.5, 90.0, 180.0, 270.0}) {
                EXPECT_NEAR(at(i, s, a), glossy(i, s, std::min(a, 360 - a)), 1e-6);
            }
        }
    }
    EXPECT_NEAR(at(30, 33.75, 90), 0.5 * (glossy(30, 30, 90) + glossy(30, 37.5, 90)), 1e-6);
    EXPECT_NEAR(at(37.5, 30, 90), 0.5 * (glossy(30, 30, 90) + glossy(45, 30, 90)), 1e-6);
}

} // namespace
} // namespace vkfv::specimen
