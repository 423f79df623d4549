#include "optics/prescriptions/zmx.hpp"

#include "core/messages/error.hpp"
#include "optics/media/agf.hpp"
#include "optics/prescriptions/prescription_writer.hpp"
#include "parts.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <spdlog/sinks/ostream_sink.h>
#include <spdlog/spdlog.h>

#include <algorithm>
#include <bit>
#include <cmath>
#include <iterator>
#include <sstream>

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

// A digest by which two imports are compared to the last bit.
std::string digest(const ZmxLens& lens) {
    std::string text = prescription_text(lens.prescription);
    for (const double wavelength : lens.wavelengths_um) {
        text += std::to_string(std::bit_cast<std::uint64_t>(wavelength)) + "\n";
    }
    return text + std::to_string(lens.primary_wavelength_um);
}

std::string with_cr(std::string text) {
    std::ranges::replace(text, '\n', '\r');
    return text;
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

// The file is in inches; a4 has the dimension of a length to the power -3, a16 to the power -15.
TEST(Zmx, ConvertsUnitsOfEveryLength) {
    const auto lens = parsed(file_text("tilted_asphere.zmx")).prescription;
    ASSERT_EQ(lens.surfaces.size(), 2u);
    const auto& asphere = lens.surfaces[0];
    // A product and a power round twice: 1e-15 relative.
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
        EXPECT_EQ(digest(parsed(with_cr(text))), expected) << name;
        EXPECT_EQ(digest(parsed(as_utf16(with_crlf(text), true))), expected) << name;
        EXPECT_EQ(digest(parsed(as_utf16(text, false))), expected) << name;
    }
}

TEST(Zmx, KeepsLettersBeyondAscii) {
    // The title "groß 𝜆" is given in UTF-8, and in UTF-16LE with a surrogate pair.
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
    // A glass before the image matters.
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
    // The glass is written out and read back.
    const auto written = prescription_text(lens);
    const auto again = parse_prescription(written, "written.toml", GlassCatalog::builtin());
    EXPECT_EQ(again.surfaces[1].medium_after.dispersion, glass.dispersion);
    EXPECT_EQ(prescription_text(again), written);
    // Another glass of the same code has a name of its own.
    const auto alike =
        parsed(replaced(replaced(file_text("doublet.zmx"), "1.672 3.22E+1", "1.672 0"), "1.5168 6.417E+1", "1.6721 0"));
    EXPECT_EQ(alike.prescription.surfaces[0].medium_after.name, "672000");
    EXPECT_EQ(alike.prescription.surfaces[1].medium_after.name, "672000-2");
}

TEST(Zmx, TellsOfAllGlassesThatAreMissing) {
    auto text = replaced(file_text("doublet.zmx"), "___BLANK 1 0 1.5168 6.417E+1", "N-BK77 1 0 1.5 40");
    text = replaced(text, "___BLANK 1 0 1.672 3.22E+1", "F22 1 0 1.5 40");
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
        Fault{"SquareAperture", "  FLAP 0 6.25 0", "  SQAP 5 5", "surface 1: SQAP", 33, "circular aperture"},
        Fault{"Spider", "  FLAP 0 6.25 0", "  SPID 1 3", "surface 1: SPID", 33, "circular aperture"},
        Fault{"ExtraData", "  SLAB 1", "  XDAT 1 1e-5", "surface 1: XDAT", 28, "no extra data"},
        Fault{"Obscuration", "  FLAP 0 6.25 0", "  CLAP 1 6.25 0", "surface 1: CLAP", 33, "obscuration"},
        Fault{"DecentredAperture", "  FLAP 0 6.25 0", "  OBDC 0 1", "surface 1: OBDC", 33, "vertex"},
        Fault{"Mirror", "GLAS N-BK7 0", "GLAS MIRROR 0", "surface 1: GLAS", 30, "a plane mirror"},
        Fault{"MissingGlass", "GLAS N-BK7 0 0 1.5168 6.417E+1", "GLAS N-BK77 0 0 1.5 40", "surface 1: GLAS", 30,
              "--glass-catalog"},
        Fault{"ParaxialWithoutFocalLength", "  TYPE STANDARD\n  FIMP", "  TYPE PARAXIAL\n  FIMP", "surface 1: TYPE", 23,
              "plane PARAXIAL surface in air"},
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

TEST(Zmx, AFileThatIsNoLensFileIsCalledSo) {
    const auto text = file_text("singlet.zmx");
    const std::pair<std::string, const char*> rows[] = {{"", "without a line SURF"},
                                                        {"title = \"no lens\"\n", "without a line SURF"},
                                                        {std::string("VERS\0 1", 7), "no text"},
                                                        {std::string(100, '\xff'), "without a line SURF"},
                                                        {"PK\3\4 and more", "a ZIP archive"}};
    for (const auto& [bytes, found] : rows) {
        const auto problem = problem_of(bytes);
        EXPECT_THAT(problem.found, HasSubstr(found));
        EXPECT_THAT(problem.expected, HasSubstr("a lens file"));
    }
    EXPECT_THROW(read_zmx("no/such/file.zmx", GlassCatalog::builtin()), InputError);
    EXPECT_THROW(read_zmx(test::source_folder(), GlassCatalog::builtin()), InputError);
}

// Notes hold whatever their authors typed.
TEST(Zmx, BytesThatAreNotUtf8AreLatin1) {
    const auto text = file_text("singlet.zmx");
    for (const char* bytes : {"\xff", "\xc3x", "\x80"}) {
        EXPECT_EQ(parsed(replaced(text, "GCAT SCHOTT", std::string("NOTE 0 ") + bytes)).prescription.surfaces.size(),
                  2u);
    }
    EXPECT_EQ(parsed(replaced(text, "\"Biconvex singlet\"", "gro\xdf")).prescription.title, "gro\xc3\x9f");
}

// The log of an import.
std::string log_of(const std::string& bytes, std::optional<int> configuration = std::nullopt) {
    std::ostringstream log;
    const auto before = spdlog::default_logger();
    spdlog::set_default_logger(
        std::make_shared<spdlog::logger>("test", std::make_shared<spdlog::sinks::ostream_sink_st>(log)));
    try {
        parse_zmx(bytes, "lens.zmx", GlassCatalog::builtin(), configuration);
    } catch (...) {
        spdlog::set_default_logger(before);
        throw;
    }
    spdlog::set_default_logger(before);
    return log.str();
}

TEST(Zmx, KeywordsWithoutOpticalMeaningArePassedOver) {
    const auto text = file_text("singlet.zmx");
    const auto whole = digest(parsed(text));
    for (const char* keyword : {"WAVN 0.5 0.6", "AUTH somebody", "DBDT 1", "SCOL 0", "TOLE 1 2", "LUID x-1", "SSID 3",
                                "FCOM a b", "IWDP 0", "BLNK"}) {
        for (const char* place : {"GCAT SCHOTT\n", "  SLAB 1\n", "MNUM 1 1\n"}) {
            const auto with = replaced(text, place, std::string(place) + "  " + keyword + "\n");
            EXPECT_EQ(digest(parsed(with)), whole) << keyword << place;
            EXPECT_EQ(log_of(with), log_of(text)) << keyword << place;
        }
    }
}

TEST(Zmx, OtherKeywordsAreToldOfAndPassedOver) {
    const auto text = file_text("singlet.zmx");
    const auto whole = digest(parsed(text));
    EXPECT_THAT(log_of(text), ::testing::Not(HasSubstr("passed over")));
    const std::pair<const char*, const char*> rows[] = {
        {"  SLAB 1", "  SCBD 1"}, {"GCAT SCHOTT", "GLUE SCHOTT"}, {"TOL TOFF ", "TOLL TOFF "}};
    for (const auto& [from, to] : rows) {
        const auto with = replaced(text, from, to);
        EXPECT_EQ(digest(parsed(with)), whole) << to;
        EXPECT_THAT(log_of(with),
                    AllOf(HasSubstr("passed over"), HasSubstr(std::string(to).substr(to[0] == ' ' ? 2 : 0, 4))));
    }
}

// The text of the singlet with this glass behind its first surface.
std::string with_glass(const std::string& glass) {
    return replaced(file_text("singlet.zmx"), "GLAS N-BK7 0 0 1.5168 6.417E+1", "GLAS " + glass);
}

TEST(Zmx, GlassesGivenByNumbersAreModelGlasses) {
    const auto model = [](const std::string& glass) {
        EXPECT_THAT(log_of(with_glass(glass)), HasSubstr("model glass")) << glass;
        return std::get<ModelGlass>(parsed(with_glass(glass)).prescription.surfaces[0].medium_after.dispersion);
    };
    EXPECT_EQ(model("517642 0 0 1.5 40"), (ModelGlass{1.517, 64.2}));
    EXPECT_EQ(model("517.642 0 0 1.5 40"), (ModelGlass{1.517, 64.2}));
    EXPECT_EQ(model("UNOBTAINIUM 0 0 1.62 36.3"), (ModelGlass{1.62, 36.3}));
    EXPECT_EQ(parsed(with_glass("BK7 0 0 1.5 40")).prescription.surfaces[0].medium_after.name, "N-BK7");
    // Zemax's numbers for a glass that it does not know are no glass.
    EXPECT_THROW(parsed(with_glass("UNOBTAINIUM 0 0 1.5 40")), InputError);
    EXPECT_THROW(parsed(with_glass("UNOBTAINIUM")), InputError);
}

TEST(Zmx, TheCataloguesOfGcatAreAskedInItsOrder) {
    const auto index_with = [](const char* order, bool swapped) {
        GlassCatalog glasses;
        for (const bool first : {!swapped, swapped}) {
            glasses.add(parse_agf(first ? "NM N-BK7 5\nCD 1.5\nLD 0.4 0.7\n" : "NM N-BK7 5\nCD 1.6\nLD 0.4 0.7\n", "x"),
                        first ? "VENDORA.agf" : "vendorb.agf");
        }
        const auto text = replaced(file_text("singlet.zmx"), "GCAT SCHOTT", std::string("GCAT ") + order);
        return parse_zmx(text, "lens.zmx", glasses).prescription.surfaces[0].medium_after.index(0.5);
    };
    for (const bool swapped : {false, true}) {
        EXPECT_EQ(index_with("VENDORA VENDORB", swapped), 1.5);
        EXPECT_EQ(index_with("VENDORB VENDORA", swapped), 1.6);
        EXPECT_THROW(index_with("SCHOTT", swapped), InputError);
    }
}

TEST(Zmx, AParaxialSurfaceInAirIsAnIdealLens) {
    const std::string text = "MODE SEQ\nUNIT CM\nWAVM 1 0.55 1\nSURF 0\n  TYPE STANDARD\n  CURV 0\n  DISZ INFINITY\n"
                             "SURF 1\n  STOP\n  TYPE PARAXIAL\n  CURV 0\n  DISZ 2\n  PARM 1 2\n  PARM 2 1\n"
                             "SURF 2\n  TYPE STANDARD\n  CURV 0\n  DISZ 0\n";
    const auto surface = parsed(text).prescription.surfaces.at(0);
    EXPECT_DOUBLE_EQ(surface.ideal_power.value(), 1 / 20.0);
    EXPECT_THAT(log_of(text), HasSubstr("ideal lens"));
    EXPECT_THROW(parsed(replaced(text, "PARM 1 2", "PARM 1 0")), InputError);
    EXPECT_THROW(parsed(replaced(text, "  DISZ 2", "  DISZ 2\n  GLAS N-BK7")), InputError);
}

// Behind a lens a mirror at 45 degrees sends light down to another lens: the import is that without the mirror.
TEST(Zmx, APlaneMirrorIsUnfolded) {
    const std::string head = "MODE SEQ\nUNIT MM\nWAVM 1 0.55 1\nSURF 0\n  TYPE STANDARD\n  CURV 0\n  DISZ INFINITY\n"
                             "SURF 1\n  TYPE STANDARD\n  CURV 0.02\n  DISZ 4\n  GLAS N-BK7\n"
                             "SURF 2\n  TYPE STANDARD\n  CURV -0.01\n  DISZ ";
    const std::string straight = head + "50\nSURF 3\n  TYPE EVENASPH\n  CURV 0.03\n  DISZ 5\n  GLAS F2\n  PARM 2 1e-6\n"
                                        "SURF 4\n  TYPE STANDARD\n  CURV 0.005\n  DISZ 30\n"
                                        "SURF 5\n  TYPE STANDARD\n  CURV 0\n  DISZ 0\n";
    const std::string folded = head + "20\nSURF 3\n  TYPE COORDBRK\n  CURV 0\n  DISZ 0\n  PARM 3 45\n"
                                      "SURF 4\n  TYPE STANDARD\n  CURV 0\n  DISZ 0\n  GLAS MIRROR\n"
                                      "SURF 5\n  TYPE COORDBRK\n  CURV 0\n  DISZ -30\n  PARM 3 45\n"
                                      "SURF 6\n  TYPE EVENASPH\n  CURV -0.03\n  DISZ -5\n  GLAS F2\n  PARM 2 -1e-6\n"
                                      "SURF 7\n  TYPE STANDARD\n  CURV -0.005\n  DISZ -30\n"
                                      "SURF 8\n  TYPE STANDARD\n  CURV 0\n  DISZ 0\n";
    EXPECT_EQ(digest(parsed(folded)), digest(parsed(straight)));
    EXPECT_THAT(log_of(folded), HasSubstr("unfolded"));
    // The wrong twin: a mirror that does not send light along the next part's axis leaves that part tilted.
    EXPECT_NE(digest(parsed(replaced(folded, "DISZ -30\n  PARM 3 45", "DISZ -30\n  PARM 3 44"))),
              digest(parsed(straight)));
    // Twice folded, light goes along z again.
    const std::string twice =
        head +
        "20\nSURF 3\n  TYPE STANDARD\n  CURV 0\n  DISZ -12\n  GLAS MIRROR\n"
        "SURF 4\n  TYPE STANDARD\n  CURV 0\n  DISZ 18\n  GLAS MIRROR\n" +
        replaced(replaced(replaced(straight.substr(head.size() + 3), "SURF 3", "SURF 5"), "SURF 4", "SURF 6"),
                 "SURF 5\n  TYPE STANDARD\n  CURV 0\n", "SURF 7\n  TYPE STANDARD\n  CURV 0\n");
    EXPECT_EQ(digest(parsed(twice)), digest(parsed(straight)));
}

TEST(Zmx, AConfigurationIsChosenByItsNumber) {
    const auto text =
        replaced(file_text("singlet.zmx"), "MNUM 1 1",
                 "MNUM 3 2\nLTTL 0 1 \"far\" 0\nLTTL 0 2 \"near\" 0\nMOFF 0 1 \"\" 0\n"
                 "THIC 1 1 7.5 0 0 0 1 1 1 0 0 \"\" 0\nTHIC 1 2 5.0 0 0 0 1 1 1 0 0 \"\" 0\nTHIC 1 3 9.5 0 0 0\n"
                 "CRVT 1 3 0.03 0 0 0\nCONN 2 3 -0.5 0 0 0\nGLSS 1 3 \"F2\" 0 0\nTHIC 0 3 1e10 0 0 0");
    const auto of = [&](std::optional<int> configuration) {
        return parse_zmx(text, "lens.zmx", GlassCatalog::builtin(), configuration).prescription;
    };
    const auto saved = parsed(file_text("singlet.zmx")).prescription;
    EXPECT_EQ(prescription_text(of(std::nullopt)), prescription_text(saved));
    EXPECT_EQ(prescription_text(of(2)), prescription_text(saved));
    EXPECT_THAT(log_of(text), AllOf(HasSubstr("3 configurations"), HasSubstr("number 2")));
    EXPECT_THAT(log_of(text, 2), ::testing::Not(HasSubstr("configurations")));
    EXPECT_EQ(of(1).surfaces[0].thickness, 7.5);
    const auto third = of(3);
    EXPECT_EQ(third.surfaces[0].thickness, 9.5);
    EXPECT_EQ(third.surfaces[0].curvature, 0.03);
    EXPECT_EQ(third.surfaces[0].medium_after.name, "F2");
    EXPECT_EQ(third.surfaces[1].conic, -0.5);
    EXPECT_THROW(of(4), InputError);
    // A parameter that the import does not understand makes the configuration that has it unusable, but no other one.
    const auto with_parameter = replaced(text, "MNUM 3 2", "MNUM 3 2\nPRAM 1 3 0.5 0 0");
    EXPECT_THROW(parse_zmx(with_parameter, "lens.zmx", GlassCatalog::builtin(), 3), InputError);
    EXPECT_EQ(parse_zmx(with_parameter, "lens.zmx", GlassCatalog::builtin(), 1).prescription.surfaces[0].thickness,
              7.5);
    for (const char* operand :
         {"MIND 1 3 1.7", "MABB 1 3 30", "EDVA 1 3 2 1", "PAR1 1 3 0.1", "IGNR 1 3 1", "APMX 1 3 2"}) {
        const auto with_operand = replaced(text, "MNUM 3 2", std::string("MNUM 3 2\n") + operand);
        EXPECT_THROW(parse_zmx(with_operand, "lens.zmx", GlassCatalog::builtin(), 3), InputError) << operand;
        EXPECT_NO_THROW(parse_zmx(with_operand, "lens.zmx", GlassCatalog::builtin(), 1)) << operand;
    }
    // An operand that nobody knows is told of where its configuration is taken.
    const auto with_unknown = replaced(text, "MNUM 3 2", "MNUM 3 2\nQQQQ 1 3 0.5\nYFIE 1 3 2");
    EXPECT_THAT(log_of(with_unknown, 3), AllOf(HasSubstr("QQQQ"), ::testing::Not(HasSubstr("YFIE"))));
    EXPECT_THAT(log_of(with_unknown, 1), ::testing::Not(HasSubstr("QQQQ")));
    const auto with_stop = replaced(text, "MNUM 3 2", "MNUM 3 2\nSTPS 0 3 2");
    EXPECT_EQ(parse_zmx(with_stop, "lens.zmx", GlassCatalog::builtin(), 3).prescription.surfaces[1].role,
              PrescribedSurface::Role::aperture_stop);
}

// Mail programs and editors take the blanks away by which surfaces' lines are indented.
TEST(Zmx, UnknownKeywordsOfSurfacesThatAreNotIndented) {
    std::string text;
    std::istringstream lines(file_text("singlet.zmx"));
    for (std::string line; std::getline(lines, line);) {
        const auto begin = line.find_first_not_of(" \t");
        text += begin == std::string::npos ? "" : line.substr(begin);
        text += line.find("TYPE") != std::string::npos ? "\nQQQQ 1 0\n" : "\n";
    }
    const auto lens = parsed(text);
    EXPECT_EQ(prescription_text(lens.prescription), prescription_text(parsed(file_text("singlet.zmx")).prescription));
    EXPECT_THAT(log_of(text), HasSubstr("QQQQ"));
}

TEST(Zmx, DecimalCommasOfGlassesAreRead) {
    const auto glass = [](const std::string& line) {
        const auto lens = parsed(replaced(file_text("singlet.zmx"), "GLAS N-BK7", line));
        return lens.prescription.surfaces[0].medium_after.index(0.5875618);
    };
    const double with_points = glass("GLAS NONE-SUCH 0 0 1.62 36.3");
    EXPECT_NEAR(with_points, 1.62, 1e-5);
    EXPECT_EQ(glass("GLAS NONE-SUCH 0 0 1,62 36,3"), with_points);
    EXPECT_EQ(glass("GLAS ___BLANK 1 0 1,62 36,3"), with_points);
    for (const char* no_glass : {"000000", "517003", "000642"}) {
        EXPECT_FALSE(glass_of_code(no_glass).has_value()) << no_glass;
    }
}

TEST(Zmx, CataloguesMayBeQuoted) {
    const auto text = file_text("singlet.zmx");
    EXPECT_EQ(prescription_text(parsed(replaced(text, "GCAT SCHOTT", "GCAT \"SCHOTT\"")).prescription),
              prescription_text(parsed(text).prescription));
}

} // namespace
} // namespace vkfv::optics
