#include "optics/media/medium.hpp"

#include "core/messages/error.hpp"
#include "optics/media/glass_catalog.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <variant>
#include <vector>

namespace vkfv::optics {
namespace {

using ::testing::HasSubstr;

TEST(Medium, IsCauchysFormulaThroughItsPoints) {
    const auto cauchy = [](double um) { return 1.5 + 0.0042 / (um * um) + 1e-5 / (um * um * um * um); };
    const std::vector<double> wavelengths_um = {0.486, 0.59, 0.656}; // not the lines F, d and C
    std::vector<double> indices;
    for (const double um : wavelengths_um) {
        indices.push_back(cauchy(um));
    }
    const Medium medium = Medium::tabulated("glass", wavelengths_um, indices);
    for (std::size_t i = 0; i < 3; ++i) {
        EXPECT_EQ(medium.index(wavelengths_um[i]), indices[i]);
    }
    // The tolerance is for rounding of indices near 1.5, amplified by a few in the range.
    for (const double um : {0.4785, 0.52, 0.6, 0.663}) {
        EXPECT_NEAR(medium.index(um), cauchy(um), 1e-14) << um;
    }
    EXPECT_THROW(medium.index(0.4759), InputError);
    EXPECT_THROW(medium.index(0.667), InputError);
    EXPECT_THROW(medium.index(std::nan("")), InputError);
    EXPECT_EQ(medium.dispersion_uncertainty(0.4785), 0);
}

// A glass as a patent gives it: its indices at F, d and C.
Medium of_three_lines(const Medium& glass) {
    const std::vector<double> lines_um = {0.4861327, 0.5875618, 0.6562725};
    std::vector<double> indices;
    for (const double um : lines_um) {
        indices.push_back(glass.index(um));
    }
    return Medium::tabulated(glass.name, lines_um, indices);
}

TEST(Medium, OfThreeLinesIsCauchysFormulaBetweenThem) {
    const Medium medium = Medium::tabulated("glass", {0.486133, 0.587562, 0.656273}, {1.5224, 1.5168, 1.5143});
    const Medium cauchy = Medium::tabulated("glass", {0.4862, 0.5876, 0.6563}, {1.5224, 1.5168, 1.5143});
    EXPECT_NEAR(medium.index(0.55), cauchy.index(0.55), 5e-6) << "whose lines lie up to 0.07 nm beside";
    for (const double line_um : {0.486133, 0.656273}) { // where the two meet
        EXPECT_NEAR(medium.index(line_um - 1e-7), medium.index(line_um + 1e-7), 1e-7);
        EXPECT_NEAR(medium.dispersion_uncertainty(line_um), 0, 1e-12);
    }
    EXPECT_EQ(medium.dispersion_uncertainty(0.55), 0);
    EXPECT_GT(medium.dispersion_uncertainty(0.45), 0);
    EXPECT_GT(medium.dispersion_uncertainty(0.70), 0);
    EXPECT_THROW(medium.index(0.369), InputError);
    EXPECT_THROW(medium.index(0.721), InputError);
}

// SCHOTT's data sheets give h, g and r of two glasses of the normal line.
TEST(Medium, OfThreeLinesHasTheIndicesOfDataSheetsBeyondThem) {
    constexpr double printed = 0.5e-5; // half of the last digit
    const struct {
        double f, d, c, h, g, r;
    } sheets[] = {
        {1.52238, 1.51680, 1.51432, 1.53024, 1.52668, 1.51289}, // N-BK7
        {1.63208, 1.62004, 1.61503, 1.65064, 1.64202, 1.61227}, // F2
    };
    for (const auto& sheet : sheets) {
        const Medium glass = Medium::tabulated("glass", {0.4861327, 0.5875618, 0.6562725}, {sheet.f, sheet.d, sheet.c});
        // The formula through rounded indices has up to 12 times their rounding at h, 5 times at g, 2 times at r.
        EXPECT_NEAR(glass.index(0.4046561), sheet.h, glass.dispersion_uncertainty(0.4046561) + 13 * printed);
        EXPECT_NEAR(glass.index(0.4358343), sheet.g, glass.dispersion_uncertainty(0.4358343) + 6 * printed);
        EXPECT_NEAR(glass.index(0.7065188), sheet.r, glass.dispersion_uncertainty(0.7065188) + 3 * printed);
    }
}

// n = A + B / lambda^2 + C / lambda^4 through the indices at F, d and C, in Newton's form.
double cauchy_through(const Medium& glass, double um) {
    const auto x = [](double wavelength) { return 1 / (wavelength * wavelength); };
    const double f = 0.4861327, d = 0.5875618, c = 0.6562725;
    const double slope_fd = (glass.index(d) - glass.index(f)) / (x(d) - x(f));
    const double slope_dc = (glass.index(c) - glass.index(d)) / (x(c) - x(d));
    const double curvature = (slope_dc - slope_fd) / (x(c) - x(f));
    return glass.index(f) + (x(um) - x(f)) * (slope_fd + (x(um) - x(d)) * curvature);
}

// The formulas of catalogues are known; the indices at three lines alone find them again as well as is said. The wrong
// twin is Cauchy's formula, which knows nothing of how glasses go on.
TEST(Medium, OfThreeLinesIsAsNearToGlassesAsItSays) {
    const auto catalog = GlassCatalog::builtin();
    int compared = 0, near = 0, near_by_cauchy = 0;
    for (const auto& name : catalog.names()) {
        const Medium glass = catalog.get(name);
        const auto range = glass.valid_range();
        if (!std::holds_alternative<GlassFormula>(glass.dispersion) || range->minimum_um > 0.4047 ||
            range->maximum_um < 0.7065) {
            continue;
        }
        const Medium guessed = of_three_lines(glass);
        for (const double um : {0.4047, 0.4358, 0.46, 0.68, 0.7065}) {
            const double uncertainty = guessed.dispersion_uncertainty(um);
            ++compared;
            near += std::abs(guessed.index(um) - glass.index(um)) < uncertainty ? 1 : 0;
            near_by_cauchy += std::abs(cauchy_through(glass, um) - glass.index(um)) < uncertainty ? 1 : 0;
        }
    }
    EXPECT_GT(compared, 250);
    // The share is 0.95, less a little under two standard errors (0.03) of 55 glasses, whose wavelengths go together.
    EXPECT_GT(near, 0.9 * compared);
    EXPECT_LT(near_by_cauchy, 0.7 * compared);
}

TEST(Medium, TakesTheThreeNearestOfMore) {
    // The formula through the lower three is 1.5, through the upper three it is not.
    const Medium medium = Medium::tabulated("glass", {0.40, 0.45, 0.50, 0.70, 0.75}, {1.5, 1.5, 1.5, 1.6, 1.6});
    EXPECT_NEAR(medium.index(0.46), 1.5, 1e-14);
    EXPECT_GT(medium.index(0.68), 1.55);
    EXPECT_EQ(Medium::air().index(10.6), 1.0);
}

// Zemax's reports for LensLibrary's lenses print these indices at 0.4861327, 0.5875618 and 0.6562725 um.
TEST(Medium, ModelGlassHasZemaxsIndices) {
    const struct {
        double nd, vd;
        std::array<double, 3> indices;
    } rows[] = {
        {1.44, 94.6, {1.4431510608, 1.4400009540, 1.4385016931}},
        {1.5163, 64.0, {1.5218874693, 1.5163016110, 1.5138234915}},
        {1.54, 47.4, {1.5479841308, 1.5400022415, 1.5365963320}},
        {1.62, 36.3, {1.6320638805, 1.6200033271, 1.6149909704}},
        {1.7174, 29.5, {1.7346585744, 1.7174047079, 1.7103499326}},
        {1.75844, 52.09, {1.7686104195, 1.7584428769, 1.7540560957}},
        {1.8044, 39.59, {1.8187181389, 1.8044039697, 1.7984081538}},
    };
    for (const auto& row : rows) {
        const Medium glass = Medium::model("model", row.nd, row.vd);
        for (std::size_t i = 0; i < 3; ++i) {
            // The tolerance is half of the last digit printed, and the rounding of the six constants fitted to such
            // digits.
            EXPECT_NEAR(glass.index(std::array{0.4861327, 0.5875618, 0.6562725}[i]), row.indices[i], 8e-11);
        }
    }
    EXPECT_THROW(Medium::model("model", 1.5, 60).index(0.35), InputError);
    EXPECT_THROW(Medium::model("model", 1.5, 60).index(1.11), InputError);
}

// Away from F, d and C the truth is SCHOTT's published indices of two glasses of the normal line. Conrady's formula
// with a partial dispersion linear in vd is good to a few times 1e-5 between g and r; a formula that forgets vd there
// is not.
TEST(Medium, ModelGlassIsNearNormalGlasses) {
    const Medium n_bk7 = Medium::model("N-BK7", 1.5168, 64.17);
    EXPECT_NEAR(n_bk7.index(0.435835), 1.52668, 1e-4);
    EXPECT_NEAR(n_bk7.index(0.546074), 1.51872, 2e-5);
    EXPECT_NEAR(n_bk7.index(0.7065188), 1.51289, 5e-5);
    const Medium f2 = Medium::model("F2", 1.62004, 36.37);
    EXPECT_NEAR(f2.index(0.435835), 1.64202, 1e-4);
    EXPECT_NEAR(f2.index(0.546074), 1.62408, 2e-5);
    EXPECT_GT(std::abs(Medium::model("F2", 1.62004, 64.17).index(0.435835) - 1.64202), 5e-3);
}

struct Evaluation {
    DispersionFormula formula;
    std::vector<double> coefficients;
    double wavelength_um;
    double value; // by hand: of n, or of n^2
    bool squared;
};

// Coefficients are chosen so that every term is a small number at 2 um (x^2 = 4) or, for Conrady's, at 4 um (x^3.5 =
// 128).
const std::vector<Evaluation>& evaluations() {
    using enum DispersionFormula;
    constexpr double l = 4 - 0.028; // Herzberger's L is its reciprocal
    static const std::vector<Evaluation> rows = {
        {schott, {2, 0.5, 4, 32, 192, 1024}, 2, 2 + 2 + 1 + 2 + 3 + 4, true},
        {sellmeier_1, {1, 2, 2, 3, 3, -4}, 2, 1 + 2 + 8 + 1.5, true},
        {herzberger, {1, 2 * l, 3 * l * l, 1, 0.3125, 0.09375}, 2, 1 + 2 + 3 + 4 + 5 + 6, false},
        {sellmeier_2, {1, 3, 1, 7, 1.5}, 2, 1 + 1 + 4 + 4, true},
        {conrady, {1, 2, 128}, 4, 1 + 0.5 + 1, false},
        {sellmeier_3, {1, 2, 2, 3, 3, -4, 4, -12}, 2, 1 + 2 + 8 + 1.5 + 1, true},
        {handbook_1, {6, 4, 2, 0.5}, 2, 6 + 2 - 2, true},
        {handbook_2, {6, 4, 2, 0.5}, 2, 6 + 8 - 2, true},
        {sellmeier_4, {1, 4, 2, 2, 3}, 2, 1 + 8 + 8, true},
        {extended, {2, 0.5, 4, 32, 192, 1024, 5120, 24576}, 2, 14 + 5 + 6, true},
        {sellmeier_5, {1, 2, 2, 3, 3, -4, 4, -12, 5, -16}, 2, 1 + 2 + 8 + 1.5 + 1 + 1, true},
        {extended_2, {2, 0.5, 4, 32, 192, 1024, 0.3125, 0.09375}, 2, 14 + 5 + 6, true},
        {extended_3, {1, 0.5, 0.1875, 16, 80, 384, 1792, 8192, 36864}, 2, 1 + 2 + 3 + 4 + 5 + 6 + 7 + 8 + 9, true},
    };
    return rows;
}

TEST(Medium, EveryFormulaIsAsByHand) {
    ASSERT_EQ(evaluations().size(), dispersion_formula_names.size());
    for (const auto& row : evaluations()) {
        const auto number = static_cast<std::size_t>(row.formula);
        SCOPED_TRACE(dispersion_formula_names[number - 1]);
        ASSERT_EQ(row.coefficients.size(), coefficient_count(row.formula));
        const auto index = [&](const std::vector<double>& coefficients) {
            return Medium::formula("glass", row.formula, coefficients, 1, 5).index(row.wavelength_um);
        };
        const double expected = row.squared ? std::sqrt(row.value) : row.value;
        EXPECT_DOUBLE_EQ(index(row.coefficients), expected);
        for (std::size_t i = 0; i < row.coefficients.size(); ++i) { // each counts
            auto changed = row.coefficients;
            changed[i] *= 1.1;
            EXPECT_GT(std::abs(index(changed) - expected), 1e-3) << i;
        }
    }
}

TEST(Medium, FormulaHoldsInItsRangeOnly) {
    const Medium glass = Medium::formula("N-X", DispersionFormula::conrady, {1.5}, 0.4, 0.7, "a test");
    EXPECT_EQ(glass.index(0.4), 1.5);
    EXPECT_EQ(glass.index(0.7), 1.5);
    for (const double um : {0.39999, 0.70001, -0.5, std::nan("")}) {
        EXPECT_THROW(glass.index(um), InputError) << um;
    }
    try {
        glass.index(0.8);
        FAIL();
    } catch (const InputError& error) {
        EXPECT_THAT(error.what(), HasSubstr("index of N-X"));
        EXPECT_THAT(error.what(), HasSubstr("0.8 um"));
        EXPECT_THAT(error.what(), HasSubstr("[0.4, 0.7] um"));
        EXPECT_THAT(error.what(), HasSubstr("a test"));
    }
}

TEST(Medium, FormulaWithoutAnIndexIsAnError) {
    const auto index_of = [](DispersionFormula formula, std::vector<double> coefficients) {
        return Medium::formula("N-X", formula, std::move(coefficients), 0.4, 2.5).index(2);
    };
    EXPECT_THROW(index_of(DispersionFormula::schott, {-1}), InputError);                // n^2 < 0
    EXPECT_THROW(index_of(DispersionFormula::sellmeier_1, {1, 4}), InputError);         // on a resonance
    EXPECT_THROW(index_of(DispersionFormula::conrady, {-1.5}), InputError);             // n < 0
    EXPECT_THROW(index_of(DispersionFormula::conrady, {1.7e308, 1.7e308}), InputError); // overflow
}

TEST(Medium, TextTellsDispersionsApart) {
    const std::vector<Medium> media = {
        Medium::air(),
        Medium::constant("a", 1.5),
        Medium::tabulated("a", {0.5}, {1.5}),
        Medium::tabulated("a", {0.5, 0.6}, {1.5, 1.5}),
        Medium::model("a", 1.5, 60),
        Medium::model("a", 1.5, 61),
        Medium::formula("a", DispersionFormula::schott, {1.5, 60}, 0.4, 0.7),
        Medium::formula("a", DispersionFormula::handbook_1, {1.5, 60}, 0.4, 0.7),
        Medium::formula("a", DispersionFormula::schott, {1.5, 60}, 0.4, 0.8),
    };
    for (std::size_t i = 0; i < media.size(); ++i) {
        for (std::size_t j = 0; j < media.size(); ++j) {
            EXPECT_EQ(media[i].dispersion_text() == media[j].dispersion_text(), i == j) << i << ' ' << j;
        }
    }
    EXPECT_EQ(Medium::constant("a", 1.5).dispersion_text(), Medium::constant("b", 1.5, "x").dispersion_text());
}

} // namespace
} // namespace vkfv::optics
