#include "optics/prescriptions/zmx.hpp"

#include "core/messages/error.hpp"
#include "optics/prescriptions/prescription_writer.hpp"
#include "parts.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <bit>
#include <cmath>
#include <iterator>

namespace vkfv::optics {
namespace {

using ::testing::AllOf;
using ::testing::HasSubstr;

std::string file_text(const std::string& name) {
    std::ifstream stream(test::source_folder() / "tests" / "data" / "zmx" / name, std::ios::binary);
    return {std::istreambuf_iterator<char>(stream), {}};
}

std::string replaced(std::string text, const std::string& from, const std::string& to) {
    const auto place = text.find(from);
    if (place == std::string::npos) {
        ADD_FAILURE() << "no " << from << " to replace";
        return text;
    }
    return text.replace(place, from.size(), to);
}

ZmxLens parsed(const std::string& bytes) {
    return parse_zmx(bytes, "lens.zmx", GlassCatalog::builtin());
}

InputProblem problem_of(const std::string& bytes) {
    try {
        parsed(bytes);
    } catch (const InputError& error) {
        return error.problem();
    }
    ADD_FAILURE() << "accepted";
    return {};
}

// What two imports have in common, to the last bit.
std::string digest(const ZmxLens& lens) {
    std::string text = prescription_text(lens.prescription);
    for (const double wavelength : lens.wavelengths_um) {
        text += std::to_string(std::bit_cast<std::uint64_t>(wavelength)) + "\n";
    }
    return text + std::to_string(lens.primary_wavelength_um);
}

std::string with_crlf(const std::string& text) {
    std::string result;
    for (const char character : text) {
        result += character == '\n' ? std::string("\r\n") : std::string(1, character);
    }
    return result;
}

std::string as_utf16(const std::string& ascii, bool little_endian) {
    std::string result = little_endian ? "\xff\xfe" : "\xfe\xff";
    for (const char character : ascii) {
        result += little_endian ? std::string{character, '\0'} : std::string{'\0', character};
    }
    return result;
}

TEST(Zmx, ReadsASinglet) {
    const auto lens = parsed(file_text("singlet.zmx"));
    const auto& prescription = lens.prescription;
    EXPECT_EQ(prescription.title, "Biconvex singlet");
    EXPECT_EQ(prescription.name, "lens");
    EXPECT_THAT(prescription.source, HasSubstr("lens.zmx"));
    EXPECT_FALSE(prescription.licence.empty());
    EXPECT_THAT(lens.wavelengths_um, ::testing::ElementsAre(0.4861327, 0.5875618, 0.6562725));
    EXPECT_EQ(lens.primary_wavelength_um, 0.5875618);
    EXPECT_EQ(prescription.medium_before.name, "air");
    ASSERT_EQ(prescription.surfaces.size(), 2u);
    const auto& front = prescription.surfaces[0];
    EXPECT_EQ(front.curvature, 0.02);
    EXPECT_EQ(front.thickness, 5.0);
    EXPECT_EQ(front.medium_after.name, "N-BK7");
    EXPECT_EQ(front.semi_diameter, 6.25);
    EXPECT_EQ(front.role, PrescribedSurface::Role::aperture_stop);
    const auto& back = prescription.surfaces[1];
    EXPECT_EQ(back.curvature, -0.025);
    EXPECT_EQ(back.medium_after.name, "air");
    EXPECT_EQ(back.role, PrescribedSurface::Role::refracting);
}

TEST(Zmx, ReadsModelGlassesOfACementedDoublet) {
    const auto lens = parsed(file_text("doublet.zmx")).prescription;
    ASSERT_EQ(lens.surfaces.size(), 3u);
    EXPECT_EQ(lens.title, "lens"); // NAME is empty
    EXPECT_EQ(lens.surfaces[0].medium_after.name, "517642");
    EXPECT_EQ(std::get<ModelGlass>(lens.surfaces[0].medium_after.dispersion), (ModelGlass{1.5168, 64.17}));
    EXPECT_EQ(lens.surfaces[1].medium_after.name, "672322");
    EXPECT_EQ(lens.surfaces[1].role, PrescribedSurface::Role::aperture_stop);
    // Another glass of the same code is another medium.
    const auto alike = parsed(replaced(file_text("doublet.zmx"), "1.672 3.22E+1", "1.5169 6.418E+1")).prescription;
    EXPECT_EQ(alike.surfaces[1].medium_after.name, "517642-2");
    EXPECT_EQ(std::get<ModelGlass>(alike.surfaces[1].medium_after.dispersion), (ModelGlass{1.5169, 64.18}));
}

// Inches; a4 has the dimension of a length to the power -3, a16 to the power -15.
TEST(Zmx, ConvertsUnitsOfEveryLength) {
    const auto lens = parsed(file_text("tilted_asphere.zmx")).prescription;
    ASSERT_EQ(lens.surfaces.size(), 2u);
    const auto& asphere = lens.surfaces[0];
    // Two roundings of a product and a power: 1e-15 relative.
    const auto near = [](double value) { return ::testing::DoubleNear(value, 1e-15 * std::abs(value)); };
    EXPECT_THAT(asphere.curvature, near(0.1));
    EXPECT_EQ(asphere.conic, -0.6);
    EXPECT_THAT(asphere.aspheric[0], near(3 / (25.4 * 25.4 * 25.4)));
    EXPECT_THAT(asphere.aspheric[1], near(-0.5 / std::pow(25.4, 5)));
    EXPECT_EQ(asphere.aspheric[2], 0);
    EXPECT_THAT(asphere.aspheric[6], near(200 / std::pow(25.4, 15)));
    EXPECT_THAT(asphere.thickness, near(5.08));
    EXPECT_THAT(asphere.semi_diameter.value(), near(6.35)); // the aperture, not the glass's edge
    EXPECT_FALSE(lens.surfaces[1].semi_diameter);
    const auto scaled = [](const std::string& unit) {
        return parsed(replaced(file_text("singlet.zmx"), "UNIT MM", "UNIT " + unit)).prescription.surfaces[0];
    };
    EXPECT_EQ(scaled("CM").thickness, 50);
    EXPECT_EQ(scaled("METER").thickness, 5000);
}

TEST(Zmx, PutsCoordinateBreaksBeforeTheNextSurface) {
    const auto lens = parsed(file_text("tilted_asphere.zmx")).prescription;
    ASSERT_EQ(lens.surfaces[0].breaks.size(), 1u);
    EXPECT_TRUE(lens.surfaces[1].breaks.empty()); // what follows the last surface places the image
    const auto& change = lens.surfaces[0].breaks[0];
    EXPECT_DOUBLE_EQ(change.decentre_x, 2.54);
    EXPECT_DOUBLE_EQ(change.decentre_y, -5.08);
    EXPECT_DOUBLE_EQ(change.tilt_x, std::acos(-1) / 6);
    EXPECT_DOUBLE_EQ(change.tilt_y, -std::acos(-1) / 36);
    EXPECT_DOUBLE_EQ(change.tilt_z, std::acos(-1) / 24);
    EXPECT_TRUE(change.tilt_first);
    EXPECT_DOUBLE_EQ(change.thickness, -6.35);
    const auto other = parsed(replaced(file_text("tilted_asphere.zmx"), "PARM 6 1", "PARM 6 0")).prescription;
    EXPECT_FALSE(other.surfaces[0].breaks[0].tilt_first);
}

TEST(Zmx, IsTheSameInEveryEncoding) {
    for (const char* name : {"singlet.zmx", "doublet.zmx", "tilted_asphere.zmx"}) {
        const auto text = file_text(name);
        const auto expected = digest(parsed(text));
        EXPECT_EQ(digest(parsed(with_crlf(text))), expected) << name;
        EXPECT_EQ(digest(parsed("\xef\xbb\xbf" + text)), expected) << name;
        EXPECT_EQ(digest(parsed(as_utf16(with_crlf(text), true))), expected) << name;
        EXPECT_EQ(digest(parsed(as_utf16(text, false))), expected) << name;
    }
}

TEST(Zmx, KeepsLettersBeyondAscii) {
    // "Objektiv groß, 𝜆" in UTF-8, and the same in UTF-16LE with a surrogate pair.
    const std::string utf8 = replaced(file_text("singlet.zmx"), "\"Biconvex singlet\"", "gro\xc3\x9f \xf0\x9d\x9c\x86");
    std::string utf16 = as_utf16(replaced(file_text("singlet.zmx"), "\"Biconvex singlet\"", "gro# ##"), true);
    utf16 = replaced(utf16, std::string("#\0 \0#\0#\0", 8), std::string("\xdf\0 \0\x35\xd8\x06\xdf", 8));
    EXPECT_EQ(parsed(utf8).prescription.title, "gro\xc3\x9f \xf0\x9d\x9c\x86");
    EXPECT_EQ(parsed(utf16).prescription.title, parsed(utf8).prescription.title);
}

TEST(Zmx, AnImmersedObjectIsTheMediumBefore) {
    const auto lens = parsed(replaced(file_text("singlet.zmx"), "DISZ INFINITY", "DISZ 3.0\n  GLAS N-BK7 0 0 1.5 60"));
    EXPECT_EQ(lens.prescription.medium_before.name, "N-BK7");
}

// A glass at the image is behind it; whether the catalogue knows it does not matter, nor what it is.
TEST(Zmx, TheMediumBehindTheImageIsLeftOut) {
    const auto text = file_text("singlet.zmx");
    const auto whole = digest(parsed(text));
    for (const char* glass : {"N-BK7 0 0 1.5 60", "SEAWATER 0 0 1.5 40", "MIRROR 0 0 1.5 40", "___BLANK 1 0 9"}) {
        const auto other = replaced(text, "  DISZ 0\n", std::string("  DISZ 0\n  GLAS ") + glass + "\n");
        EXPECT_EQ(digest(parsed(other)), whole) << glass;
    }
    // Before the image it matters.
    const auto last = "CURV -2.5E-2 0 0 0 0 \"\"";
    const auto immersed = parsed(replaced(text, last, std::string(last) + "\n  GLAS F2 0 0 1.6 36"));
    EXPECT_EQ(immersed.prescription.surfaces.back().medium_after.name, "F2");
    const auto problem = problem_of(replaced(text, last, std::string(last) + "\n  GLAS SEAWATER 0 0 1.5 40"));
    EXPECT_EQ(problem.key, "surface 2: GLAS");
    EXPECT_EQ(problem.found, "SEAWATER");
}

TEST(Zmx, AModelGlassOfAbbeNumberZeroHasNoDispersion) {
    const auto text = replaced(file_text("doublet.zmx"), "1.672 3.22E+1", "1.672 0.0");
    const auto lens = parsed(text).prescription;
    const auto& glass = lens.surfaces[1].medium_after;
    EXPECT_EQ(glass.name, "672000");
    EXPECT_EQ(std::get<ConstantIndex>(glass.dispersion), ConstantIndex{1.672});
    EXPECT_EQ(glass.index(0.2), 1.672);
    EXPECT_EQ(glass.index(12), 1.672);
    // Written out and read back.
    const auto written = prescription_text(lens);
    const auto again = parse_prescription(written, "written.toml", GlassCatalog::builtin());
    EXPECT_EQ(again.surfaces[1].medium_after.dispersion, glass.dispersion);
    EXPECT_EQ(prescription_text(again), written);
    // Another of the same code keeps its own name.
    const auto alike =
        parsed(replaced(replaced(file_text("doublet.zmx"), "1.672 3.22E+1", "1.672 0"), "1.5168 6.417E+1", "1.6721 0"));
    EXPECT_EQ(alike.prescription.surfaces[0].medium_after.name, "672000");
    EXPECT_EQ(alike.prescription.surfaces[1].medium_after.name, "672000-2");
}

TEST(Zmx, TellsOfAllGlassesThatAreMissing) {
    auto text = replaced(file_text("doublet.zmx"), "___BLANK 1 0 1.5168", "N-BK77 1 0 1.5168");
    text = replaced(text, "___BLANK 1 0 1.672", "F22 1 0 1.672");
    try {
        parsed(text);
        FAIL() << "accepted";
    } catch (const InputError& error) {
        ASSERT_EQ(error.problems().size(), 2u);
        EXPECT_EQ(error.problems()[0].found, "N-BK77");
        EXPECT_EQ(error.problems()[1].found, "F22");
        EXPECT_EQ(error.problems()[1].key, "surface 2: GLAS");
    }
}

struct Fault {
    const char* name;
    std::string from;
    std::string to;
    const char* key;
    int line;            // 0: none
    const char* message; // of found, expected or remedy
};

void PrintTo(const Fault& fault, std::ostream* stream) {
    *stream << fault.name;
}

class ZmxFault : public ::testing::TestWithParam<Fault> {};

TEST_P(ZmxFault, NamesLineSurfaceAndKeyword) {
    const Fault& fault = GetParam();
    const auto problem = problem_of(replaced(file_text("singlet.zmx"), fault.from, fault.to));
    EXPECT_EQ(problem.where.file, "lens.zmx");
    EXPECT_EQ(problem.where.line, fault.line);
    EXPECT_EQ(problem.key, fault.key);
    EXPECT_THAT(problem.found + "|" + problem.expected + "|" + problem.remedy, HasSubstr(fault.message));
    EXPECT_FALSE(problem.expected.empty() || problem.remedy.empty());
}

INSTANTIATE_TEST_SUITE_P(
    Table, ZmxFault,
    ::testing::Values(
        Fault{"UnknownKeyword", "  SLAB 1", "  SCBD 1", "surface 1: SCBD", 28, "understands"},
        Fault{"UnknownInHeader", "GCAT SCHOTT", "GLUE SCHOTT", "GLUE", 8, "understands"},
        Fault{"UnknownBehind", "TOL TOFF ", "TOLL TOFF", "TOLL", 47, "understands"},
        Fault{"SquareAperture", "  FLAP 0 6.25 0", "  SQAP 5 5", "surface 1: SQAP", 33, "understands"},
        Fault{"Obscuration", "  FLAP 0 6.25 0", "  CLAP 1 6.25 0", "surface 1: CLAP", 33, "obscuration"},
        Fault{"DecentredAperture", "  FLAP 0 6.25 0", "  OBDC 0 1", "surface 1: OBDC", 33, "vertex"},
        Fault{"Mirror", "GLAS N-BK7 0", "GLAS MIRROR 0", "surface 1: GLAS", 30, "refracting"},
        Fault{"MissingGlass", "GLAS N-BK7 0", "GLAS N-BK77 0", "surface 1: GLAS", 30, "Did you mean \"N-BK7\"?"},
        Fault{"NoGlass", "GLAS N-BK7 0 0 1.5168 6.417E+1 0 0 0 0 0 0", "GLAS", "surface 1: GLAS", 30, "name"},
        Fault{"ModelWithoutNumbers", "GLAS N-BK7 0 0 1.5168 6.417E+1 0 0 0 0 0 0", "GLAS ___BLANK 1 0 1.5",
              "surface 1: GLAS", 30, "value 5"},
        Fault{"ModelIndexBelowOne", "GLAS N-BK7 0 0 1.5168", "GLAS ___BLANK 1 0 0.5", "surface 1: GLAS", 30, "value 4"},
        Fault{"ModelWithTinyAbbeNumber", "GLAS N-BK7 0 0 1.5168 6.417E+1", "GLAS ___BLANK 1 0 1.5168 1",
              "surface 1: GLAS", 30, "in [5, 150], or 0 for no dispersion"},
        Fault{"ModelWithDeviation", "GLAS N-BK7 0 0 1.5168 6.417E+1 0", "GLAS ___BLANK 1 0 1.5168 6.417E+1 0.01",
              "surface 1: GLAS", 30, "partial dispersion"},
        Fault{"Biconic", "  TYPE STANDARD\n  FIMP", "  TYPE BICONICX\n  FIMP", "surface 1: TYPE", 23, "EVENASPH"},
        Fault{"Gradient", "  TYPE STANDARD\n  FIMP", "  TYPE GRINSUR5\n  FIMP", "surface 1: TYPE", 23, "EVENASPH"},
        Fault{"NoType", "  TYPE STANDARD\n  FIMP", "  TYPE\n  FIMP", "surface 1: TYPE", 23, "EVENASPH"},
        Fault{"ParameterOfASphere", "  SLAB 1", "  PARM 2 1e-5", "surface 1: PARM", 28, "no parameter 2"},
        Fault{"SquareTerm", "  TYPE STANDARD\n  FIMP", "  TYPE EVENASPH\n  PARM 1 1e-5", "surface 1: PARM", 24, "r^2"},
        Fault{"NinthTerm", "  TYPE STANDARD\n  FIMP", "  TYPE EVENASPH\n  PARM 9 1e-5", "surface 1: PARM", 24,
              "no parameter 9"},
        Fault{"RefractingBreak", "  TYPE STANDARD\n  FIMP", "  TYPE COORDBRK\n  FIMP", "surface 1: STOP", 22, "stop"},
        Fault{"BreakOfGlass", "  STOP\n  TYPE STANDARD\n  FIMP", "  SLAB 0\n  TYPE COORDBRK\n  FIMP", "surface 1: GLAS",
              30, "refracts"},
        Fault{"Nonsequential", "MODE SEQ", "MODE NSC", "MODE", 2, "SEQ"},
        Fault{"UnknownUnit", "UNIT MM", "UNIT FT", "UNIT", 5, "METER"},
        Fault{"NoUnit", "UNIT MM X W X CM MR CPMM\n", "", "", 1, "UNIT"},
        Fault{"HotGlass", "ENVD 2.0E+1 1 0", "ENVD 4.0E+1 1 1", "ENVD", 7, "20 degrees"},
        Fault{"WrongNumber", "CURV 2.0E-2", "CURV 2,0E-2", "surface 1: CURV", 25, "finite number"},
        Fault{"NotANumber", "CURV 2.0E-2", "CURV nan", "surface 1: CURV", 25, "finite number"},
        Fault{"NoNumber", "CURV 2.0E-2 0 0 0 0 \"\"", "CURV", "surface 1: CURV", 25, "value 1"},
        Fault{"TooGreatANumber", "CURV 2.0E-2", "CURV 2.0E+999", "surface 1: CURV", 25, "finite number"},
        Fault{"NegativeThickness", "DISZ 5.0", "DISZ -5.0", "surface 1: DISZ", 29, "thickness in [0, "},
        Fault{"InfiniteThickness", "DISZ 5.0", "DISZ INFINITY", "surface 1: DISZ", 29, "thickness in [0, "},
        Fault{"NegativeDiameter", "DIAM 6.25", "DIAM -6.25", "surface 1: DIAM", 31, ">= 0"},
        Fault{"NoThickness", "  DISZ 5.0\n", "", "surface 1: SURF", 21, "no DISZ"},
        Fault{"NoCurvature", "  CURV 2.0E-2 0 0 0 0 \"\"\n", "", "surface 1: SURF", 21, "no CURV"},
        Fault{"GapInNumbers", "SURF 2", "SURF 4", "surface 1: SURF", 34, "surface 2"},
        Fault{"PropertyOfNone", "GCAT SCHOTT", "CURV 1", "CURV", 8, "inside a surface"},
        Fault{"PropertyBehind", "MNUM 1 1", "MNUM 1 1\nCURV 1", "CURV", 49, "inside a surface"},
        Fault{"SurfaceBehind", "MNUM 1 1", "SURF 4", "SURF", 48, "surface 4"},
        Fault{"SecondStop", "  MAZH 0 0", "  STOP", "surface 2: STOP", 38, "one stop"},
        Fault{"StopAtTheObject", "  DISZ INFINITY", "  DISZ INFINITY\n  STOP", "surface 0: STOP", 20, "stop"},
        Fault{"TwoConfigurations", "MNUM 1 1", "MNUM 2 1", "MNUM", 48, "one configuration"},
        Fault{"NoPrimary", "PWAV 2", "PWAV 4", "PWAV", 15, "one of the 3"},
        Fault{"WavelengthOfZero", "WAVM 1 4.861327E-1", "WAVM 1 0", "WAVM", 11, "> 0"}),
    [](const ::testing::TestParamInfo<Fault>& info) { return info.param.name; });

// A file cut off anywhere is refused, or is cut behind its surfaces.
TEST(Zmx, TruncatedFilesAreRefused) {
    const auto text = file_text("singlet.zmx");
    const auto whole = digest(parsed(text));
    int accepted = 0;
    for (std::size_t length = 0; length < text.size(); ++length) {
        try {
            EXPECT_EQ(digest(parsed(text.substr(0, length))), whole) << length;
            EXPECT_GE(length, text.find("  DISZ 0\n") + 9) << "a lens of " << length << " bytes";
            ++accepted;
        } catch (const InputError&) {
        }
    }
    EXPECT_GT(accepted, 0);
}

TEST(Zmx, WhatIsNoTextIsRefused) {
    const auto text = file_text("singlet.zmx");
    EXPECT_THAT(problem_of("").found, HasSubstr("0 surfaces"));
    EXPECT_THAT(problem_of(std::string("VERS\0 1", 7)).found, HasSubstr("NUL"));
    EXPECT_EQ(problem_of(std::string("VERS\0 1", 7)).where.byte_offset, 4u);
    EXPECT_THAT(problem_of(as_utf16(text, true) + "x").found, HasSubstr("half a UTF-16"));
    EXPECT_THAT(problem_of(std::string("\xff\xfe\x35\xd8x\0", 6)).found, HasSubstr("surrogate"));
    EXPECT_THAT(problem_of(std::string("\xff\xfe\0\0", 4)).found, HasSubstr("NUL"));
    for (const char* bytes : {"\xff", "\xc3", "\xc0\xaf", "\xe0\x80\xaf", "\xed\xa0\x80", "\xf5\x80\x80\x80",
                              "\xf4\x90\x80\x80", "\xc3x", "\x80"}) {
        EXPECT_THAT(problem_of(replaced(text, "Biconvex", bytes)).found, HasSubstr("not UTF-8"));
    }
    EXPECT_THROW(read_zmx("no/such/file.zmx", GlassCatalog::builtin()), InputError);
    EXPECT_THROW(read_zmx(test::source_folder(), GlassCatalog::builtin()), InputError);
}

} // namespace
} // namespace vkfv::optics
