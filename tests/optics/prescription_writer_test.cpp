#include "optics/prescriptions/prescription_writer.hpp"

#include "core/mathematics/units.hpp"
#include "optics/prescriptions/ideal_lens.hpp"
#include "optics/prescriptions/zmx.hpp"
#include "parts.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <bit>
#include <cstdint>
#include <random>

namespace vkfv::optics {
namespace {

using ::testing::HasSubstr;
using ::testing::Not;

// Values are the same if their bits are, or if both are zeros of either sign.
void expect_same(double a, double b) {
    EXPECT_EQ(std::bit_cast<std::uint64_t>(a + 0.0), std::bit_cast<std::uint64_t>(b + 0.0)) << a << " " << b;
}

void expect_same(const Medium& a, const Medium& b) {
    EXPECT_EQ(a.name, b.name);
    EXPECT_EQ(a.dispersion, b.dispersion) << a.name;
}

void expect_same(const Prescription& a, const Prescription& b) {
    EXPECT_EQ(a.title, b.title);
    EXPECT_EQ(a.source, b.source);
    EXPECT_EQ(a.licence, b.licence);
    EXPECT_EQ(a.source_distance, b.source_distance);
    expect_same(a.medium_before, b.medium_before);
    ASSERT_EQ(a.surfaces.size(), b.surfaces.size());
    for (std::size_t i = 0; i < a.surfaces.size(); ++i) {
        const auto& one = a.surfaces[i];
        const auto& other = b.surfaces[i];
        expect_same(one.curvature, other.curvature);
        expect_same(one.conic, other.conic);
        for (std::size_t j = 0; j < one.aspheric.size(); ++j) {
            expect_same(one.aspheric[j], other.aspheric[j]);
        }
        expect_same(one.thickness, other.thickness);
        expect_same(one.medium_after, other.medium_after);
        EXPECT_EQ(one.semi_diameter, other.semi_diameter);
        EXPECT_EQ(one.ideal_power, other.ideal_power);
        EXPECT_EQ(one.role, other.role);
        ASSERT_EQ(one.breaks.size(), other.breaks.size());
        for (std::size_t j = 0; j < one.breaks.size(); ++j) {
            expect_same(one.breaks[j].decentre_x, other.breaks[j].decentre_x);
            expect_same(one.breaks[j].decentre_y, other.breaks[j].decentre_y);
            expect_same(one.breaks[j].tilt_x, other.breaks[j].tilt_x);
            expect_same(one.breaks[j].tilt_y, other.breaks[j].tilt_y);
            expect_same(one.breaks[j].tilt_z, other.breaks[j].tilt_z);
            EXPECT_EQ(one.breaks[j].tilt_first, other.breaks[j].tilt_first);
            expect_same(one.breaks[j].thickness, other.breaks[j].thickness);
        }
    }
}

Prescription read_back(const Prescription& lens) {
    return parse_prescription(prescription_text(lens), "written.toml");
}

TEST(PrescriptionWriter, ImportedLensesReadBackToTheSameBits) {
    for (const char* name : {"singlet.zmx", "doublet.zmx", "tilted_asphere.zmx"}) {
        SCOPED_TRACE(name);
        const auto lens =
            read_zmx(test::source_folder() / "tests" / "data" / "zmx" / name, GlassCatalog::builtin()).prescription;
        expect_same(read_back(lens), lens);
        EXPECT_EQ(prescription_text(read_back(lens)), prescription_text(lens));
    }
}

TEST(PrescriptionWriter, AssetsReadBackToTheSameBits) {
    for (const auto& [folder, name] : {std::pair{"objectives", "10x_0.28"}, {"illuminators", "koehler"}}) {
        SCOPED_TRACE(name);
        const auto lens = load_prescription(name, folder, test::source_folder());
        expect_same(read_back(lens), lens);
    }
}

// A prescription may hold any numbers. Tilts are those of some degrees: no other one comes from a file.
TEST(PrescriptionWriter, AnyNumbersReadBackToTheSameBits) {
    std::mt19937_64 random(20261121);
    std::uniform_real_distribution<double> mantissa(-10, 10);
    std::uniform_int_distribution<int> exponent(-12, 4);
    const auto number = [&] { return mantissa(random) * std::pow(10.0, exponent(random)); };
    Prescription lens{.file = {},
                      .name = "any",
                      .title = "quotes \" and \\ and a\ttab, ß",
                      .source = "random",
                      .licence = "none",
                      .medium_before = Medium::constant("oil, n = 1.515", 1.515, "random"),
                      .surfaces = {},
                      .source_distance = 12.3456789012345678};
    const std::vector<Medium> media = {
        Medium::air(), Medium::model("made up", 1.6, 40.1), *GlassCatalog::builtin().find("N-BK7"),
        Medium::tabulated("table", {0.4861, 0.5876, 0.6563}, {1.52, 1.51, 1.5 + 1e-16}, "measured"),
        Medium::formula("N-BK7x", DispersionFormula::conrady, {1.5, 0.01, 1 / 3.0}, 0.3, 2.5)};
    for (std::size_t i = 0; i < 200; ++i) {
        PrescribedSurface surface;
        surface.curvature = number();
        surface.conic = number();
        surface.aspheric = {number(), 0, number(), 0, number(), number(), number()};
        surface.thickness = std::abs(number());
        surface.medium_after = media[i % media.size()];
        surface.semi_diameter = std::abs(number());
        surface.breaks.push_back({.decentre_x = number(),
                                  .decentre_y = number(),
                                  .tilt_x = mantissa(random) * radians_per_degree,
                                  .tilt_y = mantissa(random) * 10 * radians_per_degree,
                                  .tilt_z = number() * 1e-3 * radians_per_degree,
                                  .tilt_first = i % 2 == 0,
                                  .thickness = number()});
        surface.breaks.resize(i % 3);
        lens.surfaces.push_back(surface);
    }
    lens.surfaces[3].role = PrescribedSurface::Role::aperture_stop;
    lens.surfaces[7].role = PrescribedSurface::Role::field_stop;
    expect_same(read_back(lens), lens);
}

// An ideal lens has any power that a focal length gives.
TEST(PrescriptionWriter, IdealLensesReadBackToTheSameBits) {
    std::mt19937_64 random(20261122);
    std::uniform_real_distribution<double> focal_length(-300, 300);
    for (int i = 0; i < 200; ++i) {
        auto lens = ideal_objective(focal_length(random), 0.25);
        lens.source = lens.licence = "none";
        lens.surfaces[1].semi_diameter = lens.surfaces[0].thickness = std::abs(lens.surfaces[0].thickness);
        expect_same(read_back(lens), lens);
    }
    auto lens = ideal_lens(200);
    lens.source = lens.licence = "none";
    EXPECT_THAT(prescription_text(lens), HasSubstr("ideal_focal_length_mm = 200\n"));
}

TEST(PrescriptionWriter, WritesWhatAPersonWould) {
    const auto text = prescription_text(
        parse_prescription("source = \"a\"\nlicence = \"b\"\n[[surface]]\ncurvature_per_mm = 0.02\nmedium = \"N-BK7\"\n"
                           "thickness_mm = 3\n[[surface]]\nradius_mm = -20.3\n",
                           "lens.toml"));
    EXPECT_EQ(text,
              "title = \"lens\"\nsource = \"a\"\nlicence = \"b\"\n\n[[surface]]\nradius_mm = 50\nthickness_mm = 3\n"
              "medium = \"N-BK7\"\n\n[[surface]]\nradius_mm = -20.3\n");
}

// A glass by the name of a built-in one, but with other indices, is written with them.
TEST(PrescriptionWriter, GlassesOfOtherCataloguesAreWrittenOut) {
    auto lens = parse_prescription("source = \"a\"\nlicence = \"b\"\n[[surface]]\nmedium = \"N-BK7\"\n", "lens.toml");
    EXPECT_THAT(prescription_text(lens), Not(HasSubstr("[media")));
    lens.surfaces[0].medium_after = Medium::formula("N-BK7", DispersionFormula::conrady, {1.5, 0.01, 0.001}, 0.3, 2.5);
    EXPECT_THAT(prescription_text(lens), HasSubstr("[media.N-BK7]\nformula = \"conrady\""));
    expect_same(read_back(lens), lens);
}

} // namespace
} // namespace vkfv::optics
