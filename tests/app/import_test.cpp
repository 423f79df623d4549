// vkfv import, through the real program, keeps closed-form focal lengths.
#include "app/program.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include <cmath>

namespace vkfv::test {
namespace {

using testing::HasSubstr;

std::string lens_path(const std::string& name) {
    return std::string(VKFV_SOURCE_DIR) + "/tests/data/zmx/" + name;
}

nlohmann::json report_of(const std::vector<std::string>& more, const std::filesystem::path& folder) {
    std::vector<std::string> arguments = {"--import", "--json"};
    arguments.insert(arguments.begin() + 1, more.begin(), more.end());
    const auto result = run_program(arguments, folder);
    EXPECT_EQ(result.exit_code, 0) << result.standard_error;
    return nlohmann::json::parse(result.standard_output);
}

// The index of N-BK7 by Schott's published coefficients.
double index_of_n_bk7(double um) {
    const double x2 = um * um;
    return std::sqrt(1 + 1.03961212 * x2 / (x2 - 0.00600069867) + 0.231792344 * x2 / (x2 - 0.0200179144) +
                     1.01046945 * x2 / (x2 - 103.560653));
}

// The truth is the lensmaker's equation of a thick lens in air.
TEST(Import, ASingletHasItsClosedFormFocalLengths) {
    const auto folder = fresh_folder("import_singlet");
    const auto report = report_of({lens_path("singlet.zmx")}, folder);
    const double n = index_of_n_bk7(0.5875618);
    const double c1 = 0.02, c2 = -0.025, d = 5;
    const double power = (n - 1) * (c1 - c2 + (n - 1) * d * c1 * c2 / n);
    const double back = (1 - (n - 1) * d * c1 / n) / power;
    EXPECT_EQ(report["surfaces"], 2);
    EXPECT_EQ(report["primary_wavelength_um"], 0.5875618);
    EXPECT_NEAR(report["efl_mm"].get<double>(), 1 / power, 1e-11); // rounding of some 40 mm, a dozen times
    EXPECT_NEAR(report["bfl_mm"].get<double>(), back, 1e-11);
    // The wrong twin has another primary wavelength.
    auto text = replaced(read_file(lens_path("singlet.zmx")), "PWAV 2", "PWAV 1");
    write_file(folder / "blue.zmx", text);
    EXPECT_GT(std::abs(report_of({"blue.zmx"}, folder)["efl_mm"].get<double>() - 1 / power), 0.1);
}

TEST(Import, WritesAPrescriptionThatAConfigurationNames) {
    const auto folder = fresh_folder("import_written");
    const std::vector<std::string> import = {"--import", lens_path("doublet.zmx"), "--out"};
    for (const char* file : {"doublet.toml", "again.toml"}) {
        auto arguments = import;
        arguments.push_back(file);
        const auto result = run_program(arguments, folder);
        ASSERT_EQ(result.exit_code, 0) << result.standard_error;
        EXPECT_EQ(result.standard_output, "");
        EXPECT_THAT(result.standard_error, HasSubstr("effective focal length"));
    }
    EXPECT_EQ(read_file(folder / "doublet.toml"), read_file(folder / "again.toml"));
    EXPECT_EQ(run_program({"--import", lens_path("doublet.zmx")}, folder).standard_output,
              read_file(folder / "doublet.toml"));
    write_file(folder / "c.toml",
               replaced(small_configuration, "prescription = \"200mm\"", "prescription = \"doublet.toml\""));
    const auto checked = run_program({"--check", "c.toml", "--json"}, folder);
    ASSERT_EQ(checked.exit_code, 0) << checked.standard_error;
    const double tube = nlohmann::json::parse(checked.standard_output)["efl_tube_lens_mm"];
    const double imported = report_of({lens_path("doublet.zmx")}, folder)["efl_mm"];
    // The imported lens is for 0.5876 um instead of 0.5875618 um; the dispersion of the glasses is some 1e-1 of the
    // power per um.
    EXPECT_NEAR(tube, imported, 1e-5 * imported);
}

TEST(Import, TakesGlassesOfACatalogue) {
    const auto folder = fresh_folder("import_catalogue");
    write_file(folder / "lens.zmx", replaced(read_file(lens_path("singlet.zmx")), "GLAS N-BK7", "GLAS MINE"));
    write_file(folder / "mine.agf", "CC made up\nNM MINE 5 0 1.5 50 0 0 0\nCD 1.5 0 0 0 0 0 0 0 0 0\nLD 0.3 2.5\n");
    const auto report = report_of({"lens.zmx", "--glass-catalog", "mine.agf"}, folder);
    EXPECT_NEAR(report["efl_mm"].get<double>(), 1 / (0.5 * (0.045 - 0.5 * 5 * 0.0005 / 1.5)), 1e-11);
    // The prescription needs no catalogue any more.
    const auto result = run_program({"--import", "lens.zmx", "--glass-catalog", "mine.agf"}, folder);
    EXPECT_THAT(result.standard_output, HasSubstr("[media.MINE]\n"));
    EXPECT_THAT(result.standard_output, HasSubstr("formula = \"conrady\""));
}

TEST(Import, AnAfocalLensHasNoFocalLength) {
    const auto folder = fresh_folder("import_afocal");
    auto text = replaced(read_file(lens_path("singlet.zmx")), "CURV 2.0E-2", "CURV 0.0");
    write_file(folder / "plate.zmx", replaced(text, "CURV -2.5E-2", "CURV 0.0"));
    EXPECT_TRUE(report_of({"plate.zmx"}, folder)["efl_mm"].is_null());
}

TEST(Import, SaysWhereItCannotWrite) {
    const auto folder = fresh_folder("import_nowhere");
    const auto result = run_program({"--import", lens_path("singlet.zmx"), "--out", "no/such/lens.toml"}, folder);
    EXPECT_EQ(result.exit_code, 4);
    EXPECT_THAT(result.standard_error, HasSubstr("no/such/lens.toml"));
}

} // namespace
} // namespace vkfv::test
