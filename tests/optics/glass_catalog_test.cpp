#include "optics/media/glass_catalog.hpp"

#include "core/messages/error.hpp"
#include "core/toml/toml_reader.hpp"
#include "optics/media/agf.hpp"
#include "optics/prescriptions/prescription.hpp"
#include "parts.hpp"

#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cctype>
#include <fstream>

namespace vkfv::optics {
namespace {

using ::testing::HasSubstr;

// Spectral lines in um: i, h, g, F', F, e, d, C', C, r, s, t.
constexpr double line_i = 0.3650146, line_h = 0.4046561, line_g = 0.4358343, line_f2 = 0.4799914, line_f = 0.4861327,
                 line_e = 0.5460740, line_d = 0.5875618, line_c2 = 0.6438469, line_c = 0.6562725, line_r = 0.7065188,
                 line_s = 0.8521101, line_t = 1.0139798;

// The data sheets' indices, which their vendors round to the last digit given here.
TEST(GlassCatalog, HasPublishedIndicesToTheLastDigit) {
    const struct {
        const char* glass;
        double wavelength_um;
        double index;
        double last_digit;
    } rows[] = {
        // SCHOTT, data sheet 517642.251
        {"N-BK7", line_i, 1.53627, 1e-5},
        {"N-BK7", line_h, 1.53024, 1e-5},
        {"N-BK7", line_g, 1.52668, 1e-5},
        {"N-BK7", line_f2, 1.52283, 1e-5},
        {"N-BK7", line_f, 1.52238, 1e-5},
        {"N-BK7", line_e, 1.51872, 1e-5},
        {"N-BK7", line_d, 1.51680, 1e-5},
        {"N-BK7", line_c2, 1.51472, 1e-5},
        {"N-BK7", line_c, 1.51432, 1e-5},
        {"N-BK7", line_r, 1.51289, 1e-5},
        {"N-BK7", line_s, 1.50980, 1e-5},
        {"N-BK7", line_t, 1.50731, 1e-5},
        // OHARA, data sheet 883408
        {"S-LAH58", line_f, 1.89822, 1e-5},
        {"S-LAH58", line_d, 1.88300, 1e-5},
        {"S-LAH58", line_c, 1.87656, 1e-5},
        // SCHOTT, data sheet 620364.360
        {"F2", line_g, 1.64202, 1e-5},
        {"F2", line_f, 1.63208, 1e-5},
        {"F2", line_d, 1.62004, 1e-5},
        {"F2", line_c, 1.61503, 1e-5},
        // SCHOTT, data sheet 785257.322
        {"N-SF11", line_f, 1.80651, 1e-5},
        {"N-SF11", line_d, 1.78472, 1e-5},
        {"N-SF11", line_c, 1.77596, 1e-5},
        // Malitson's tables (1965, 1963)
        {"FUSED-SILICA", line_f, 1.46313, 1e-5},
        {"FUSED-SILICA", line_d, 1.45846, 1e-5},
        {"FUSED-SILICA", line_c, 1.45637, 1e-5},
        {"CAF2", line_d, 1.43385, 1e-5},
        // The sodium D line at 20 degrees C in air: the value long used to calibrate refractometers
        {"WATER", 0.5892938, 1.33299, 1e-5},
        // Handbook values of the ordinary rays at the sodium line
        {"MGF2", 0.5892938, 1.3777, 1e-4},
        {"SAPPHIRE", 0.5892938, 1.7681, 1e-4},
        // ISO 8036
        {"IMMERSION-OIL", line_e, 1.5180, 1e-4},
    };
    const auto glasses = GlassCatalog::builtin();
    for (const auto& row : rows) {
        EXPECT_NEAR(glasses.get(row.glass).index(row.wavelength_um), row.index, 0.5001 * row.last_digit)
            << row.glass << ' ' << row.wavelength_um;
    }
    const auto oil = glasses.get("oil");
    EXPECT_NEAR((oil.index(line_e) - 1) / (oil.index(line_f2) - oil.index(line_c2)), 44, 1e-3);
}

// The built-in catalogue has all glasses that the assets name, and the assets' indices are Zemax's of the vendors'
// catalogues of their time: the independent truth here.
TEST(GlassCatalog, HasEveryGlassOfTheAssets) {
    const auto glasses = GlassCatalog::builtin();
    std::size_t count = 0;
    for (const char* folder : {"objectives", "tube_lenses", "illuminators"}) {
        for (const auto& entry : std::filesystem::directory_iterator(test::source_folder() / "assets" / folder)) {
            for (const auto& surface :
                 load_prescription(entry.path().filename(), folder, entry.path().parent_path()).surfaces) {
                const Medium& medium = surface.medium_after;
                const auto* table = std::get_if<IndexTable>(&medium.dispersion);
                if (!table || std::isdigit(static_cast<unsigned char>(medium.name[0]))) {
                    continue; // air, a six-digit code
                }
                const auto found = glasses.find(medium.name);
                ASSERT_TRUE(found) << medium.name;
                EXPECT_FALSE(found->source.empty()) << medium.name;
                ++count;
                for (std::size_t i = 0; i < table->indices.size(); ++i) {
                    // The wavelengths are given to 1e-6 um, and glass changes by less than 0.3 per um.
                    EXPECT_NEAR(found->index(table->wavelengths_um[i]), table->indices[i], 3e-7) << medium.name;
                }
            }
        }
    }
    EXPECT_GT(count, 20u);
}

TEST(GlassCatalog, EveryGlassIsDenserAtTheBlueEndAndHasASource) {
    const auto glasses = GlassCatalog::builtin();
    EXPECT_GE(glasses.names().size(), 60u);
    for (const auto& name : glasses.names()) {
        const auto glass = glasses.get(name);
        const double dispersion = glass.index(line_f) - glass.index(line_c);
        const double abbe = (glass.index(line_d) - 1) / dispersion;
        EXPECT_TRUE(abbe > 18 && abbe < 110) << name << ' ' << abbe;
        EXPECT_FALSE(glass.source.empty()) << name;
        EXPECT_EQ(glass.name, name);
    }
}

// The papers give resonances as wavelengths, and water's formula relative to vacuum. The file has what the formula
// takes.
TEST(GlassCatalog, HasTheSquaresOfThePapersToTheLastBit) {
    const auto glasses = GlassCatalog::builtin();
    const auto coefficients = [&](const char* name) {
        return std::get<GlassFormula>(glasses.get(name).dispersion).coefficients;
    };
    const auto squared = [](double x) { return x * x; };
    const struct {
        const char* name;
        std::array<double, 3> resonances_um;
    } rows[] = {{"FUSED-SILICA", {0.0684043, 0.1162414, 9.896161}},
                {"CAF2", {0.050263605, 0.1003909, 34.649040}},
                {"MGF2", {0.04338408, 0.09461442, 23.793604}},
                {"SAPPHIRE", {0.0726631, 0.1193242, 18.028251}}};
    for (const auto& [name, resonances] : rows) {
        for (std::size_t i = 0; i < resonances.size(); ++i) {
            EXPECT_EQ(coefficients(name)[2 * i + 1], squared(resonances[i])) << name << ' ' << i;
        }
    }
    const double air = squared(1.000272);
    EXPECT_EQ(coefficients("WATER"), (std::vector<double>{5.684027565e-1 / air, 5.101829712e-3, 1.726177391e-1 / air,
                                                          1.821153936e-2, 2.086189578e-2 / air, 2.620722293e-2,
                                                          1.130748688e-1 / air, 1.069792721e1, 1 / air - 1, 0}));
}

TEST(GlassCatalog, AFileOfGlassesIsCheckedWhole) {
    const auto message = [](const std::string& text) -> std::string {
        try {
            GlassCatalog::of(TomlTable::parse(text, "glasses.toml"));
        } catch (const InputError& error) {
            return error.what();
        }
        return "accepted";
    };
    const std::string glass = "[media.A-1]\nsource = \"a test\"\nindex = 1.5\n";
    EXPECT_EQ(message(glass + "[aliases]\nB = \"A_1\"\n"), "accepted");
    EXPECT_THAT(message(glass + "[aliases]\nB = \"A-2\"\n"), HasSubstr("aliases.B"));
    EXPECT_THAT(message("[media.A-1]\nindex = 1.5\n"), HasSubstr("media.A-1.source"));
    EXPECT_THAT(message(glass + "indx = 2\n"), HasSubstr("media.A-1.indx"));
    EXPECT_THAT(message("title = \"none\"\n"), HasSubstr("media"));
}

TEST(GlassCatalog, KnowsNamesInAnyCaseAndSpelling) {
    const auto glasses = GlassCatalog::builtin();
    EXPECT_EQ(glasses.get("n-bk7").name, "N-BK7");
    EXPECT_EQ(glasses.get("N_BK7").name, "N-BK7");
    for (const char* name : {"Fused Silica", "SILICA", "F_SILICA", "SiO2"}) {
        EXPECT_EQ(glasses.get(name).name, "FUSED-SILICA") << name;
    }
    EXPECT_EQ(glasses.get("water").name, "WATER");
    EXPECT_EQ(glasses.get("CaF2").name, "CAF2");
    EXPECT_EQ(glasses.get("BK7").name, "N-BK7"); // the old name
    EXPECT_FALSE(glasses.find(""));
}

TEST(GlassCatalog, AnUnknownGlassIsNamedAndNoOtherSuggested) {
    const auto glasses = GlassCatalog::builtin();
    const auto message = [&](const char* name) -> std::string {
        try {
            glasses.get(name);
        } catch (const InputError& error) {
            return error.what();
        }
        return "found";
    };
    for (const char* name : {"N-BK8", "fused silca", "K8"}) {
        EXPECT_THAT(message(name), HasSubstr("\"" + std::string(name) + "\""));
        EXPECT_THAT(message(name), ::testing::Not(HasSubstr("Did you mean")));
    }
    // A code is no glass; the message says what to write.
    EXPECT_THAT(message("516640"), HasSubstr("nd = 1.516 and vd = 64.0"));
}

TEST(GlassCatalog, ACodeIsAnIndexAndAnAbbeNumber) {
    EXPECT_EQ(glass_of_code("517642"), (ModelGlass{1.517, 64.2}));
    EXPECT_EQ(glass_of_code("517.642"), (ModelGlass{1.517, 64.2}));
    EXPECT_EQ(glass_of_code("001050"), (ModelGlass{1.001, 5.0}));
    for (const char* name : {"", "51764", "5176420", "51764a", "5.17642", "-17642"}) {
        EXPECT_FALSE(glass_of_code(name)) << name;
    }
}

// A catalogue whose glass of this name has the index, without dispersion, from 0.4 to 0.7 um.
AgfGlasses with_glass(const std::string& name, double index) {
    return parse_agf("NM " + name + " 5\nCD " + fmt::format("{:.9f}", index) + "\nLD 0.4 0.7\n", "x.agf");
}

TEST(GlassCatalog, ACatalogueGoesBeforeTheBuiltInGlasses) {
    auto glasses = GlassCatalog::builtin();
    glasses.add(with_glass("n-bk7", 1.25), "mine.agf");
    EXPECT_EQ(glasses.get("N-BK7").index(0.5), 1.25);
    EXPECT_NEAR(glasses.get("F2").index(line_d), 1.62004, 1e-5);
    EXPECT_NEAR(GlassCatalog::builtin().get("N-BK7").index(line_d), 1.5168, 1e-5); // a value
}

TEST(GlassCatalog, CataloguesThatDisagreeAreNeverChosenByTheirOrder) {
    const std::vector<std::pair<std::string, double>> files = {{"folder/A.agf", 1.5}, {"b.AGF", 1.6}};
    for (const bool swapped : {false, true}) {
        GlassCatalog glasses;
        glasses.add(with_glass("G", files[swapped ? 1 : 0].second), files[swapped ? 1 : 0].first);
        glasses.add(with_glass("G", files[swapped ? 0 : 1].second), files[swapped ? 0 : 1].first);
        try {
            glasses.find("g");
            ADD_FAILURE() << "accepted";
        } catch (const InputError& error) {
            EXPECT_THAT(error.what(), ::testing::AllOf(HasSubstr("folder/A.agf"), HasSubstr("b.AGF"), HasSubstr("GCAT"),
                                                       HasSubstr("--glass-catalog"), HasSubstr("glass_catalogs")));
        }
        EXPECT_EQ(glasses.find("G", {.order = {"a", "B"}})->index(0.5), 1.5);
        EXPECT_EQ(glasses.find("G", {.order = {"B", "A"}})->index(0.5), 1.6);
        EXPECT_EQ(glasses.find("G", {.order = {"OTHER", "B"}})->index(0.5), 1.6);
        EXPECT_THROW(glasses.find("G", {.order = {"OTHER"}}), InputError);
    }
}

TEST(GlassCatalog, CataloguesAgreeToAMillionthOfTheIndexWhereTheLensIsUsed) {
    const auto both = [](double difference, const std::string& more) {
        GlassCatalog glasses;
        glasses.add(with_glass("G", 1.5), "a.agf");
        glasses.add(
            parse_agf("NM G 5\nCD " + fmt::format("{:.9f}", 1.5 + difference) + more + "\nLD 0.4 0.7\n", "b.agf"),
            "b.agf");
        return glasses;
    };
    EXPECT_EQ(both(9e-7, "").get("G").index(0.5), 1.5); // the index of the first catalogue by name
    EXPECT_THROW(both(1.1e-6, "").get("G"), InputError);
    // Two catalogues that agree at one wavelength alone are refused unless it is the only one used: their difference
    // 0.001 / x - 0.002 is 0 at x = 0.5 um.
    const auto crossing = both(-0.002, " 0.001");
    EXPECT_THROW(crossing.find("G"), InputError);
    EXPECT_TRUE(crossing.find("G", {.used = {.minimum_um = 0.5, .maximum_um = 0.5}}));
    // Catalogues cannot agree where none of both is valid.
    EXPECT_THROW(both(1e-9, "").find("G", {.used = {.minimum_um = 1, .maximum_um = 2}}), InputError);
}

// The built-in glasses of a vendor are asked in the order of GCAT too.
TEST(GlassCatalog, AVendorsBuiltInGlassesAreACatalogueOfItsName) {
    auto glasses = GlassCatalog::builtin();
    glasses.add(with_glass("F2", 1.25), "mine.agf");
    EXPECT_EQ(glasses.get("F2").index(0.5), 1.25);
    EXPECT_NEAR(glasses.find("F2", {.order = {"SCHOTT", "MINE"}})->index(line_d), 1.62004, 1e-5);
    EXPECT_EQ(glasses.find("F2", {.order = {"MINE", "SCHOTT"}})->index(0.5), 1.25);
    EXPECT_EQ(glasses.find("F2", {.order = {"OHARA"}})->index(0.5), 1.25);
}

} // namespace
} // namespace vkfv::optics
