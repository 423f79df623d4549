// vkfv check prints every figure in both forms, and each warning where it belongs and nowhere else.
#include "app/program.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include <cmath>
#include <map>
#include <sstream>
#include <sys/stat.h>

namespace vkfv::test {
namespace {

using ::testing::Contains;
using ::testing::HasSubstr;
using ::testing::Not;

nlohmann::json check(const std::string& configuration, const std::vector<std::string>& more = {}) {
    const auto folder = fresh_folder("check_command");
    write_file(folder / "c.toml", configuration);
    std::vector<std::string> arguments = {"--check", "c.toml", "--json"};
    arguments.insert(arguments.end(), more.begin(), more.end());
    const auto result = run_program(arguments, folder);
    EXPECT_EQ(result.exit_code, 0) << result.standard_error;
    return nlohmann::json::parse(result.standard_output);
}

std::vector<std::string> warnings_of(const nlohmann::json& report) {
    std::vector<std::string> sentences;
    for (const auto& warning : report["warnings"]) {
        sentences.push_back(warning["sentence"]);
    }
    return sentences;
}

const std::vector<std::string> figures = {"efl_objective_mm",
                                          "objective_front_principal_plane_mm",
                                          "objective_back_principal_plane_mm",
                                          "efl_tube_lens_mm",
                                          "tube_lens_front_principal_plane_mm",
                                          "tube_lens_back_principal_plane_mm",
                                          "working_distance_mm",
                                          "free_distance_mm",
                                          "best_focus_offset_um",
                                          "least_spot_offset_um",
                                          "numerical_aperture",
                                          "entrance_pupil_height_mm",
                                          "entrance_pupil_radius_mm",
                                          "back_pupil_distance_mm",
                                          "back_pupil_radius_mm",
                                          "beam_radius_mm",
                                          "exit_pupil_distance_mm",
                                          "exit_pupil_radius_mm",
                                          "source_radius_mm",
                                          "pupil_radius_in_source_mm",
                                          "illumination_to_objective_mm",
                                          "magnification",
                                          "real_magnification",
                                          "detector_numerical_aperture",
                                          "f_number",
                                          "field_of_view_um",
                                          "field_diagonal_um",
                                          "pixel_pitch_um",
                                          "wavelength_um",
                                          "airy_radius_um",
                                          "detector_airy_radius_um",
                                          "pixels_per_airy_radius",
                                          "depth_of_field_um",
                                          "detector_depth_of_field_um",
                                          "field_edge_um",
                                          "rms_spot_axis_um",
                                          "rms_spot_edge_um",
                                          "rms_spot_corner_um",
                                          "detector_rms_spot_axis_um",
                                          "detector_rms_spot_edge_um",
                                          "detector_rms_spot_corner_um",
                                          "wavefront_rms_axis_waves",
                                          "wavefront_rms_edge_waves",
                                          "wavefront_rms_corner_waves",
                                          "strehl_axis",
                                          "strehl_edge",
                                          "strehl_corner",
                                          "field_curvature_um",
                                          "field_curvature_corner_um",
                                          "distortion_edge_percent",
                                          "distortion_corner_percent",
                                          "relative_light_edge_percent",
                                          "relative_light_corner_percent",
                                          "axial_colour_um",
                                          "lateral_colour_um"};

TEST(Check, EveryMicroscopeHasEveryFigure) {
    for (const char* objective : {"5x_0.15", "10x_0.28", "20x_0.41", "50x_0.66", "100x_0.83"}) {
        const auto report = check(replaced(small_configuration, "10x_0.28", objective));
        for (const auto& name : figures) {
            ASSERT_TRUE(report.contains(name)) << objective << " " << name;
            EXPECT_TRUE(report[name].is_number() && std::isfinite(report[name].get<double>()))
                << objective << " " << name;
        }
    }
}

TEST(Check, TextHasTheSameFiguresWithinItsWidth) {
    const auto folder = fresh_folder("check_text");
    write_file(folder / "c.toml", small_configuration);
    const auto result = run_program({"--check", "c.toml", "--all"}, folder);
    ASSERT_EQ(result.exit_code, 0) << result.standard_error;
    for (const auto& name : figures) {
        EXPECT_THAT(result.standard_output, HasSubstr("  " + name + " "));
    }
    std::istringstream lines(result.standard_output);
    for (std::string line; std::getline(lines, line);) {
        if (line.find("warning: ") == std::string::npos) {
            EXPECT_LE(line.size(), 110u) << line;
        }
    }
}

// Each figure is computed here from other figures by its definition.
TEST(Check, FiguresAgreeWithTheirDefinitions) {
    const auto report = check(small_configuration);
    const auto value = [&](const char* name) { return report[name].get<double>(); };
    const double aperture = value("numerical_aperture");
    const double magnification = std::abs(value("magnification"));
    // The factor 0.61 of the Airy radius is 0.6098 rounded.
    EXPECT_NEAR(value("airy_radius_um"), 0.61 * 0.5876 / aperture, 5e-4 * value("airy_radius_um"));
    EXPECT_NEAR(value("detector_airy_radius_um") / value("airy_radius_um"), magnification, 1e-9);
    EXPECT_NEAR(value("field_of_view_um"), 160 / magnification, 1e-9);
    EXPECT_NEAR(value("field_diagonal_um"), std::sqrt(2.0) * 160 / magnification, 1e-9);
    EXPECT_NEAR(value("detector_depth_of_field_um"), 20 / magnification / aperture, 1e-9);
    EXPECT_NEAR(value("f_number") * 2 * value("detector_numerical_aperture"), 1, 1e-12);
    EXPECT_NEAR(value("rms_spot_edge_um") * magnification, value("detector_rms_spot_edge_um"), 1e-9);
    EXPECT_NEAR(value("free_distance_mm"), value("working_distance_mm") - 1e-3 * value("best_focus_offset_um"), 1e-12);
    EXPECT_NEAR(value("wavelength_um"), 0.5876, 1e-12);
}

TEST(Check, WarnsOfACoarseScanOnly) {
    // The depth of field is 7.66 um.
    const auto fine = check(small_configuration, {"--set", "scan.z_step_um=3.8", "--set", "scan.z_stop_um=20"});
    EXPECT_THAT(warnings_of(fine), Not(Contains(HasSubstr("The scan's step"))));
    const auto coarse = check(small_configuration, {"--set", "scan.z_step_um=3.9", "--set", "scan.z_stop_um=20"});
    EXPECT_THAT(warnings_of(coarse), Contains(HasSubstr("The scan's step")));
}

TEST(Check, WarnsOfASpecimenLargerThanTheField) {
    // The field is 16 um wide and a pixel 2 um; a specimen twice as large as the field leaves no warning.
    EXPECT_THAT(warnings_of(check(small_configuration)), Contains(HasSubstr("as large as the field of view")));
    EXPECT_THAT(warnings_of(check(replaced(small_configuration, "size_mm = 0.2", "size_mm = 0.032"))),
                Not(Contains(HasSubstr("as large as the field of view"))));
}

TEST(Check, WarnsOfCoarseAndOfFinePixels) {
    EXPECT_THAT(warnings_of(check(small_configuration, {"--set", "detector.pixels=7"})),
                Contains(HasSubstr("coarser than the optics")));
    EXPECT_THAT(warnings_of(check(small_configuration, {"--set", "detector.pixels=128"})),
                Contains(HasSubstr("far finer than the optics")));
    for (const auto& warning : warnings_of(check(small_configuration))) {
        EXPECT_THAT(warning, Not(HasSubstr("The detector's pixel")));
    }
}

TEST(Check, WarnsOfASourceThatDoesNotFillThePupil) {
    EXPECT_THAT(warnings_of(check(small_configuration, {"--set", "source.radius_mm=0.5"})),
                Contains(HasSubstr("does not fill the objective's pupil")));
    EXPECT_THAT(warnings_of(check(small_configuration)), Not(Contains(HasSubstr("does not fill"))));
}

TEST(Check, NamesTheLensThatClipsTheCorner) {
    const auto wide = check(small_configuration, {"--set", "detector.size_mm=40", "--set", "detector.pixels=2000"});
    EXPECT_THAT(warnings_of(wide), Contains(::testing::AllOf(HasSubstr("from the field's corner is clipped by imaging"),
                                                             HasSubstr("% of the rim"))));
    EXPECT_THAT(warnings_of(check(small_configuration)), Not(Contains(HasSubstr("clipped"))));
}

// The corners of 1 mm by 1 mm come into focus 14.9 um below the middle, by the wavefront.
TEST(Check, WarnsOfAScanThatTheFieldCurvatureLeaves) {
    const auto wide_with = [](const std::string& start) {
        return check(small_configuration,
                     {"--set", "detector.size_mm=10", "--set", "detector.pixels=1000", "--set",
                      "scan.z_start_um=" + start, "--set", "scan.z_stop_um=5", "--set", "scan.z_step_um=1"});
    };
    const auto cut = wide_with("-10");
    EXPECT_NEAR(cut["field_curvature_corner_um"], 14.9, 0.1);
    EXPECT_THAT(warnings_of(cut), Contains(HasSubstr("The field is curved")));
    EXPECT_THAT(warnings_of(wide_with("-20")), Not(Contains(HasSubstr("The field is curved"))));
}

TEST(Check, TheDemoHasNoWarning) {
    const auto folder = fresh_folder("check_demo");
    const auto result =
        run_program({"--check", std::string(VKFV_SOURCE_DIR) + "/assets/stacks/demo.toml", "--json"}, folder);
    ASSERT_EQ(result.exit_code, 0) << result.standard_error;
    EXPECT_THAT(warnings_of(nlohmann::json::parse(result.standard_output)), ::testing::IsEmpty());
}

// A check that was made before is answered from what it said, and computed again when anything has changed.
class KeptCheck : public ::testing::Test {
  protected:
    KeptCheck() { write_file(folder_ / "c.toml", ideal_configuration()); }

    ProgramResult check(const std::vector<std::string>& more = {}) const {
        std::vector<std::string> arguments = {"check", "c.toml"};
        arguments.insert(arguments.end(), more.begin(), more.end());
        auto result = run_program(arguments, folder_, {{"XDG_CACHE_HOME", (folder_ / "cache").string()}});
        EXPECT_EQ(result.exit_code, 0) << result.standard_error;
        return result;
    }
    // The files of kept figures, with the number that the file system gave each: a file with another number was written
    // anew.
    std::map<std::string, ino_t> kept() const {
        std::map<std::string, ino_t> files;
        for (const auto& entry : std::filesystem::directory_iterator(folder_ / "cache" / "vkfv")) {
            struct stat status {};
            EXPECT_EQ(stat(entry.path().c_str(), &status), 0);
            if (entry.path().filename().string().starts_with("figures-")) {
                files[entry.path().filename().string()] = status.st_ino;
            }
        }
        return files;
    }

    std::filesystem::path folder_ = fresh_folder("kept_check");
};

TEST_F(KeptCheck, SaysTheSameAgain) {
    const auto first = check();
    EXPECT_THAT(first.standard_error, HasSubstr("roughness: Sq"));
    const auto files = kept();
    EXPECT_EQ(files.size(), 1u);
    const auto second = check();
    EXPECT_EQ(second.standard_output, first.standard_output);
    EXPECT_EQ(second.standard_error, first.standard_error);
    const auto without =
        run_program({"check", "c.toml", "--json"}, folder_, {{"XDG_CACHE_HOME", (folder_ / "other_cache").string()}});
    EXPECT_EQ(check({"--json"}).standard_output, without.standard_output);
    EXPECT_THAT(check({"--quiet"}).standard_error, Not(HasSubstr("roughness")));
    EXPECT_EQ(kept(), files);
}

TEST_F(KeptCheck, IsMadeAnewWhereTheConfigurationDiffers) {
    const auto first = check();
    const auto other = check({"--set", "specimen.roughness.seed=3"});
    EXPECT_NE(other.standard_output, first.standard_output);
    EXPECT_EQ(kept().size(), 2u);
    EXPECT_EQ(check().standard_output, first.standard_output);
    EXPECT_EQ(kept().size(), 2u);
}

TEST_F(KeptCheck, IsMadeAnewWhereAFileHasChanged) {
    const auto objective = std::filesystem::path(VKFV_SOURCE_DIR) / "assets" / "objectives" / "10x_0.28.toml";
    const auto own = folder_ / "assets" / "objectives" / "mine.toml";
    const auto points = folder_ / "points.csv";
    const auto square_with_corner = [&](const std::string& height) {
        write_file(points, "x,y,z\n-60,-60,0\n60,-60,0\n60,60,0\n-60,60," + height + "\n");
    };
    std::filesystem::create_directories(own.parent_path());
    write_file(own, read_file(objective));
    square_with_corner("1");
    const std::string text = small_configuration;
    write_file(folder_ / "c.toml", text.substr(0, text.find("[specimen]")) +
                                       "[specimen]\nkind = \"points\"\nfile = \"points.csv\"\nunit = \"um\"\n" +
                                       text.substr(text.find("[scan]")));
    const std::vector<std::string> with_own = {"--set", "objective.prescription=\"mine\""};
    const auto first = check(with_own);
    EXPECT_THAT(first.standard_output, HasSubstr("-0.166667  highest"));
    const auto files = kept();
    EXPECT_EQ(check(with_own).standard_output, first.standard_output);
    EXPECT_EQ(kept(), files);
    square_with_corner("2"); // the file keeps its length
    const auto second = check(with_own);
    EXPECT_THAT(second.standard_output,
                HasSubstr("-0.333333  highest")); // twice the value above: the corner is twice as high
    EXPECT_EQ(kept().size(), 1u);
    EXPECT_NE(kept(), files);
    write_file(own, replaced(read_file(objective), "radius_mm = 21.703026388210155", "radius_mm = 21.703026388210255"));
    EXPECT_EQ(kept().size(), 1u);
    (void)check(with_own);
    EXPECT_EQ(kept().size(), 2u); // another lens
    write_file(own, replaced(read_file(objective), "title", "# ...\ntitle"));
    EXPECT_EQ(check(with_own).standard_output, second.standard_output);
}

TEST_F(KeptCheck, IsMadeAnewWhereWhatWasKeptIsDamaged) {
    const auto first = check();
    const auto files = kept();
    ASSERT_EQ(files.size(), 1u);
    const auto path = folder_ / "cache" / "vkfv" / files.begin()->first;
    write_file(path, replaced(read_file(path), "Lenses", "lenses"));
    EXPECT_EQ(check().standard_output, first.standard_output);
    EXPECT_NE(kept(), files);
}

// A configuration that is named without its folder finds the prescriptions beside it.
TEST(Check, FindsPrescriptionsBesideTheWorkingDirectory) {
    const auto folder = fresh_folder("beside");
    std::filesystem::create_directories(folder / "assets" / "objectives");
    write_file(folder / "assets" / "objectives" / "mine.toml",
               read_file(std::filesystem::path(VKFV_SOURCE_DIR) / "assets" / "objectives" / "10x_0.28.toml"));
    write_file(folder / "c.toml", replaced(small_configuration, "\"10x_0.28\"", "\"mine\""));
    const auto result = run_program({"--check", "c.toml"}, folder);
    EXPECT_EQ(result.exit_code, 0) << result.standard_error;
}

} // namespace
} // namespace vkfv::test
