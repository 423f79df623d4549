// The program's commands from end to end, on the device at hand.
#include "app/program.hpp"
#include "core/mathematics/units.hpp"
#include "images/image_file.hpp"
#include "surface_files/surface_file.hpp"

#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <nlohmann/json.hpp>
#include <pugixml.hpp>

#include <algorithm>
#include <cmath>
#include <sstream>

namespace vkfv::test {
namespace {

using testing::AllOf;
using testing::HasSubstr;

const std::filesystem::path source_folder = VKFV_SOURCE_DIR;

std::vector<std::filesystem::path> example_stacks() {
    std::vector<std::filesystem::path> files;
    for (const auto& entry : std::filesystem::directory_iterator(source_folder / "assets/stacks")) {
        if (entry.path().extension() == ".toml") {
            files.push_back(entry.path());
        }
    }
    std::sort(files.begin(), files.end());
    return files;
}

class ExampleStack : public testing::TestWithParam<std::filesystem::path> {};

// Few rays, few pixels, three positions: whether it runs, not what comes out.
TEST_P(ExampleStack, RunsWithFewRays) {
    const auto folder = fresh_folder("example_" + GetParam().stem().string());
    std::vector<std::string> arguments = {"--stack", GetParam().string(), "--out", "out", "--rays", "2000"};
    std::vector<std::string> settings = {"detector.pixels=8", "topography.window_px=3", "scan.z_start_um=-1",
                                         "scan.z_stop_um=1", "scan.z_step_um=1"};
    if (read_file(GetParam()).find("model = \"waves\"") != std::string::npos) {
        settings.emplace_back("diffraction.parts_per_pixel=2"); // waves would ask for 139 parts of such large pixels
    }
    for (const auto& setting : settings) {
        arguments.insert(arguments.end(), {"--set", setting});
    }
    const auto result = run_program(arguments, folder);
    ASSERT_EQ(result.exit_code, 0) << result.standard_error;
    for (const char* name : {"stack.toml", "images/z_0000.tif", "images/z_0002.tif", "ledger.csv", "topography.tif",
                             "truth.tif", "deviation.tif", "results.json"}) {
        EXPECT_TRUE(std::filesystem::exists(folder / "out" / name)) << name;
    }
    EXPECT_FALSE(std::filesystem::exists(folder / "out/images/z_0003.tif"));
    // Where the pixels look is known to a hundredth of the finest pixel.
    const auto results = nlohmann::json::parse(read_file(folder / "out/results.json"));
    EXPECT_LT(results.at("mapping").at("interpolation_error_um"), 2e-3);
}

INSTANTIATE_TEST_SUITE_P(Assets, ExampleStack, testing::ValuesIn(example_stacks()),
                         [](const auto& info) { return info.param.stem().string(); });

// One for every kind of specimen and the demo; an empty folder would leave ExampleStack without a case.
TEST(ExampleStacks, CoverEveryKindOfSpecimen) {
    std::string all;
    for (const auto& file : example_stacks()) {
        all += read_file(file);
    }
    for (const char* kind :
         {"plane", "step", "sphere", "sinusoid", "chirp", "rough", "image", "stl", "gltf", "points"}) {
        EXPECT_THAT(all, HasSubstr(std::string("kind = \"") + kind + "\""));
    }
    EXPECT_THAT(all, HasSubstr("representation = \"analytic\""));
}

TEST(Program, CheckReportsTheInstrument) {
    const auto folder = fresh_folder("check");
    write_file(folder / "c.toml", small_configuration);
    const auto result = run_program({"--check", "c.toml", "--json"}, folder);
    ASSERT_EQ(result.exit_code, 0) << result.standard_error;
    const auto report = nlohmann::json::parse(result.standard_output);
    for (const char* name : {"efl_objective_mm", "numerical_aperture", "working_distance_mm", "magnification",
                             "depth_of_field_um", "pixel_pitch_um", "best_focus_offset_um", "field_curvature_um"}) {
        ASSERT_TRUE(report.contains(name)) << name;
        EXPECT_TRUE(report[name].is_number()) << name;
    }
    // 20 mm and 200 mm nominal: the prescriptions are re-engineered to a percent or two.
    EXPECT_NEAR(std::abs(report["magnification"].get<double>()), 10, 0.2);
    EXPECT_NEAR(report["numerical_aperture"].get<double>(), 0.28, 0.01);
    // 0.16 mm over 8 pixels and 10x.
    EXPECT_NEAR(report["pixel_pitch_um"].get<double>(), 2.0, 0.04);
    const double aperture = report["numerical_aperture"];
    EXPECT_NEAR(report["depth_of_field_um"].get<double>(), 0.5876 / (aperture * aperture), 1e-6);
}

TEST(Program, CheckWarnsOfASpecimenBeyondTheScan) {
    const auto folder = fresh_folder("check_warns");
    write_file(folder / "c.toml", replaced(small_configuration, "height_um = 2.0", "height_um = 20.0"));
    const auto result = run_program({"--check", "c.toml"}, folder);
    EXPECT_EQ(result.exit_code, 0) << result.standard_error;
    EXPECT_THAT(result.standard_output, HasSubstr("beyond the scan"));
    write_file(folder / "c.toml", small_configuration);
    EXPECT_THAT(run_program({"--check", "c.toml"}, folder).standard_output, testing::Not(HasSubstr("beyond the scan")));
}

TEST(Program, DevicesAreListedAsTextAndJson) {
    const auto folder = fresh_folder("devices");
    const auto text = run_program({"--devices"}, folder);
    ASSERT_EQ(text.exit_code, 0) << text.standard_error;
    const auto json = run_program({"--devices", "--json"}, folder);
    ASSERT_EQ(json.exit_code, 0) << json.standard_error;
    const auto devices = nlohmann::json::parse(json.standard_output);
    ASSERT_GE(devices.size(), 1u);
    EXPECT_EQ(std::count_if(devices.begin(), devices.end(), [](const auto& device) { return device["preferred"]; }), 1);
    EXPECT_THAT(text.standard_output, HasSubstr(devices[0]["name"].get<std::string>()));
}

TEST(Program, HelpAndVersion) {
    const auto folder = fresh_folder("help");
    const auto help = run_program({"--help"}, folder);
    EXPECT_EQ(help.exit_code, 0);
    EXPECT_THAT(help.standard_output, AllOf(HasSubstr("--stack"), HasSubstr("--trace-rays"), HasSubstr("Exit codes")));
    for (const char* option : {"--version", "-v"}) {
        const auto version = run_program({option}, folder);
        EXPECT_EQ(version.exit_code, 0);
        EXPECT_THAT(version.standard_output, testing::MatchesRegex("vkfv [0-9.]+\n"
                                                                   "commit:        (unknown|[0-9a-f]+( and changes)?)\n"
                                                                   "compiler:      [A-Za-z]+ [0-9.]+, [A-Za-z]+\n"
                                                                   "SPIR-V digest: [0-9a-f]+\n"
                                                                   "Vulkan loader: [0-9]+[.][0-9]+[.][0-9]+\n"));
    }
}

// As `cmake --install` lays it out, in a folder that knows nothing of the sources.
TEST(Program, RunsWhereItWasInstalled) {
    const auto folder = fresh_folder("installed");
    const std::string install =
        fmt::format("cmake --install '{}' --prefix '{}/usr' >/dev/null", VKFV_BINARY_DIR, folder.string());
    ASSERT_EQ(std::system(install.c_str()), 0);
    for (const char* file :
         {"share/man/man1/vkfv.1.gz", "share/bash-completion/completions/vkfv", "share/doc/vkfv/README.md",
          "share/doc/vkfv/docs/tutorial.md", "share/doc/vkfv/assets/star.png"}) {
        EXPECT_TRUE(std::filesystem::file_size(folder / "usr" / file) > 0) << file;
    }
    std::filesystem::create_directories(folder / "elsewhere");
    // A letter in a PNG is read by the module, the lenses are assets, results go to the working directory.
    const std::string image =
        fmt::format("cd '{0}/elsewhere' && ../usr/bin/vkfv image assets/stacks/image_letter.toml --z 0 "
                    "--rays 1e3 --set diffraction.model=none --quiet >/dev/null",
                    folder.string());
    EXPECT_EQ(std::system(image.c_str()), 0);
    EXPECT_TRUE(std::filesystem::exists(folder / "elsewhere/vkfv-out/image_+0.000um.tif"));
    EXPECT_EQ(read_file(folder / "usr/bin/vkfv").find(VKFV_SOURCE_DIR "/assets"), std::string::npos);
    const std::string lost = fmt::format(
        "rm -r '{0}/usr/share' && cd '{0}/elsewhere' && ../usr/bin/vkfv check c.toml 2>said", folder.string());
    write_file(folder / "elsewhere/c.toml", small_configuration);
    EXPECT_NE(std::system(lost.c_str()), 0);
    EXPECT_THAT(read_file(folder / "elsewhere/said"), HasSubstr("install vkfv again"));
}

std::vector<std::string> lines_of(const std::string& text) {
    std::vector<std::string> lines;
    std::istringstream stream(text);
    for (std::string line; std::getline(stream, line);) {
        lines.push_back(line);
    }
    return lines;
}

TEST(Program, TraceRaysWritesOneLineARay) {
    const auto folder = fresh_folder("trace_rays");
    write_file(folder / "c.toml", small_configuration);
    // Along the axis; and 60 degrees off it, beyond the aperture of 0.28.
    write_file(folder / "rays.csv", "x_mm,y_mm,z_mm,l,m,n\n0,0,0,0,0,1\n0,0,0,0.8660254037844386,0,0.5\n");
    const auto result = run_program({"--trace-rays", "c.toml", "rays.csv"}, folder);
    ASSERT_EQ(result.exit_code, 0) << result.standard_error;
    const auto lines = lines_of(result.standard_output);
    ASSERT_EQ(lines.size(), 3u);
    EXPECT_EQ(lines[0], "x_mm,y_mm,l,m,n,opl_mm,status,z_origin");
    EXPECT_THAT(lines[1], testing::MatchesRegex("-?0,-?0,-?0,-?0,1,[0-9.]+,ok,paraxial"));
    EXPECT_THAT(lines[2],
                testing::AnyOf(testing::EndsWith(",vignetted,paraxial"), testing::EndsWith(",missed,paraxial")));
}

TEST(Program, TraceRaysCountsFromThePlaneThatIsNamed) {
    const auto folder = fresh_folder("trace_rays_origin");
    write_file(folder / "c.toml", small_configuration); // its best focus is 6 um from the paraxial plane
    const auto figures = nlohmann::json::parse(run_program({"check", "c.toml", "--json"}, folder).standard_output);
    const double offset = 1e-3 * figures.at("best_focus_offset_um").get<double>();
    ASSERT_GT(std::abs(offset), 1e-3);
    const auto path_of = [&](double z, const std::string& origin) {
        write_file(folder / "rays.csv", fmt::format("x_mm,y_mm,z_mm,l,m,n\n0.01,0,{},0.1,0,{}\n", z, std::sqrt(0.99)));
        const auto result = run_program({"trace-rays", "c.toml", "rays.csv", "--origin", origin}, folder);
        const std::string line = lines_of(result.standard_output).at(1);
        EXPECT_THAT(line, testing::EndsWith(",ok," + origin)) << result.standard_error;
        const auto end = line.find(",ok");
        return std::stod(line.substr(line.rfind(',', end - 1) + 1, end));
    };
    EXPECT_NEAR(path_of(0, "best-focus"), path_of(offset, "paraxial"), 1e-9);
    // The ray's path is shorter by what its start is nearer, but for the aberrations.
    EXPECT_NEAR(path_of(0, "best-focus") - path_of(0, "paraxial"), -offset / std::sqrt(0.99), 0.01 * std::abs(offset));
}

// 32 x 32 cells of 16384 x 16384 pixels take 2 TB, more than any machine of today has. Without a word the system would
// end the program.
TEST(Program, WavesBeyondTheMachinesMemoryAreRefused) {
    const auto folder = fresh_folder("beyond_memory");
    const std::string stack = (source_folder / "assets/stacks/microscope_10x.toml").string();
    const auto result = run_program({"image", stack, "--z", "0", "--device", "host", "--rays", "1000", "--set",
                                     "detector.pixels=16384", "--set", "diffraction.cells=32"},
                                    folder);
    EXPECT_EQ(result.exit_code, 2);
    EXPECT_THAT(result.standard_error, HasSubstr("the memory of this machine"));
}

// Before any image of it is traced; check warns of the same.
TEST(Program, AnEvaluationBeyondTheMachinesMemoryIsRefused) {
    const auto folder = fresh_folder("evaluation_beyond_memory");
    write_file(folder / "c.toml", ideal_configuration());
    const std::vector<std::string> settings = {"--device", "host",
                                               "--rays",   "1000",
                                               "--set",    "detector.pixels=16384",
                                               "--set",    "topography.smoothing_steps=100"};
    const auto with = [&](std::vector<std::string> command) {
        command.insert(command.end(), settings.begin(), settings.end());
        return run_program(command, folder);
    };
    const auto stack = with({"stack", "c.toml"});
    EXPECT_EQ(stack.exit_code, 2);
    EXPECT_THAT(stack.standard_error, AllOf(HasSubstr("of memory"), HasSubstr("the memory of this machine")));
    EXPECT_FALSE(std::filesystem::exists(folder / "out"));
    const auto check = with({"check", "c.toml"});
    EXPECT_THAT(check.standard_output, HasSubstr("The evaluation of 16384 x 16384 pixels takes"));
}

TEST(Program, ImageOfAScanPositionIsThatImageOfTheStack) {
    const auto folder = fresh_folder("image");
    write_file(folder / "c.toml", ideal_configuration());
    const auto stack = run_program({"--stack", "c.toml", "--rays", "1e5"}, folder);
    ASSERT_EQ(stack.exit_code, 0) << stack.standard_error;
    const auto image = run_program({"--image", "c.toml", "--rays", "1e5", "--z", "1", "--out", "one.tif"}, folder);
    ASSERT_EQ(image.exit_code, 0) << image.standard_error;
    EXPECT_THAT(image.standard_output, AllOf(HasSubstr("detected"), HasSubstr("residual")));
    // z = 1 um is the fourth position of five.
    const auto pixels = images::read_image(folder / "one.tif").values;
    EXPECT_EQ(pixels, images::read_image(folder / "out/images/z_0003.tif").values);
    EXPECT_NE(pixels, images::read_image(folder / "out/images/z_0002.tif").values);
    EXPECT_GT(*std::max_element(pixels.begin(), pixels.end()), 0);
}

TEST(Program, TopographyEvaluatesAStackAnew) {
    const auto folder = fresh_folder("topography");
    write_file(folder / "c.toml", ideal_configuration());
    // So few rays over so short a scan measure nothing; peaks of the noise are taken too, so that there are
    // heights.
    const auto stack =
        run_program({"--stack", "c.toml", "--rays", "2e5", "--set", "topography.smoothing_steps=0", "--set",
                     "topography.false_peak_rate=1", "--set", "topography.focus_measure=standard-deviation"},
                    folder);
    ASSERT_EQ(stack.exit_code, 0) << stack.standard_error;
    const auto results = nlohmann::json::parse(read_file(folder / "out/results.json"));
    for (const char* name : {"sq_measured_um", "sq_true_um", "rms_deviation_um", "correlation", "measured_share",
                             "rays_per_image", "device", "seed"}) {
        EXPECT_TRUE(results.contains(name)) << name;
    }
    EXPECT_GT(results["measured_share"].get<double>(), 0);
    // Parameters and comparison take the same levelled points, so their Sq agrees.
    EXPECT_NEAR(results["parameters"]["Sq_um"]["measured"].get<double>(), results["sq_measured_um"].get<double>(),
                1e-9);
    EXPECT_NEAR(results["parameters"]["Sq_um"]["true"].get<double>(), results["sq_true_um"].get<double>(), 1e-9);
    const auto page = read_file(folder / "out/report.html");
    EXPECT_TRUE(pugi::xml_document().load_string(page.c_str()));
    EXPECT_THAT(page, HasSubstr(fmt::format("<td>{:.4g}</td>", results["rms_deviation_um"].get<double>())));
    EXPECT_THAT(page, HasSubstr(results["device"].get<std::string>()));
    const auto height_map = read_file(folder / "out/topography.tif");
    const auto again = run_program({"--topography", "out"}, folder);
    ASSERT_EQ(again.exit_code, 0) << again.standard_error;
    EXPECT_EQ(read_file(folder / "out/topography.tif"), height_map);
    EXPECT_EQ(read_file(folder / "out/report.html"), page);
    EXPECT_EQ(nlohmann::json::parse(read_file(folder / "out/results.json"))["device"], results["device"]);
    // Evaluated otherwise, it is another map.
    const auto other = run_program(
        {"--topography", "out", "--set", "topography.window_px=5", "--set", "topography.l_filter_um=10"}, folder);
    ASSERT_EQ(other.exit_code, 0) << other.standard_error;
    EXPECT_NE(read_file(folder / "out/topography.tif"), height_map);
    EXPECT_EQ(nlohmann::json::parse(read_file(folder / "out/results.json"))["filtered"]["l_filter_um"], 10.0);
    EXPECT_THAT(read_file(folder / "out/report.html"), HasSubstr("L-filter 10 µm"));
    // A key that the images depend on cannot be changed afterwards.
    for (const char* setting : {"detector.size_mm=2.5", "specimen.material.g=0.1", "trace.seed=99"}) {
        const auto changed = run_program({"--topography", "out", "--set", setting}, folder);
        EXPECT_EQ(changed.exit_code, 2) << setting;
        EXPECT_THAT(changed.standard_error, HasSubstr("traced with"));
    }
}

TEST(Program, HeightsAreWrittenInEveryFormatAndAllMapsInOneFile) {
    const auto folder = fresh_folder("formats");
    write_file(folder / "c.toml", ideal_configuration() + "[diffraction]\nmodel = \"none\"\n");
    const auto stack = run_program({"stack", "c.toml", "--rays", "2e5", "--quiet", "--set",
                                    "topography.false_peak_rate=1", "--set", "topography.smoothing_steps=0", "--set",
                                    "output.surfaces=[\"tiff\", \"gwy\", \"gsf\", \"npy\", \"csv\", \"sdf\"]"},
                                   folder);
    ASSERT_EQ(stack.exit_code, 0) << stack.standard_error;
    const auto expected = surface::read_surface(folder / "out/topography.tif").map;
    const surface::ImageScale scale{.pitch = expected.pitch_x, .unit = mm_per_um};
    for (const char* name : {"gwy", "gsf", "npy", "csv", "sdf"}) {
        const auto file = folder / (std::string("out/topography.") + name);
        const auto map = surface::read_surface(file, name == std::string("npy") ? scale : surface::ImageScale{}).map;
        ASSERT_EQ(map.height.values.size(), expected.height.values.size()) << name;
        for (std::size_t k = 0; k < map.height.values.size(); ++k) {
            const double here = map.height.values[k], there = expected.height.values[k];
            EXPECT_TRUE(std::isnan(here) ? std::isnan(there) : std::abs(here - there) < 1e-9) << name; // floats of mm
        }
    }
    const auto all = read_file(folder / "out/topography.gwy");
    for (const char* title :
         {"Height", "True height", "Deviation", "Noise of the height", "Contrast", "All in focus"}) {
        EXPECT_THAT(all, HasSubstr(title));
    }
    EXPECT_THAT(all, HasSubstr(std::string("unitstr\0sW\0", 11))); // the unit of the all-in-focus image
}

TEST(Program, AStackOfAnotherConfigurationIsRefusedWithTheDifference) {
    const auto folder = fresh_folder("refused");
    write_file(folder / "c.toml", ideal_configuration() + "[diffraction]\nmodel = \"none\"\n");
    ASSERT_EQ(run_program({"--stack", "c.toml"}, folder).exit_code, 0);
    const auto refused = run_program({"--stack", "c.toml", "--seed", "2"}, folder);
    EXPECT_EQ(refused.exit_code, 2);
    EXPECT_THAT(refused.standard_error, AllOf(HasSubstr("trace.seed: 1 there, 2 here"), HasSubstr("--out")));
    // The same again, also from stack.toml and with another batch size, finds all images.
    for (const auto& arguments : {std::vector<std::string>{"--stack", "c.toml", "--set", "trace.batch=512"},
                                  std::vector<std::string>{"--stack", "out/stack.toml"}}) {
        const auto same = run_program(arguments, folder);
        EXPECT_EQ(same.exit_code, 0) << same.standard_error;
        EXPECT_THAT(same.standard_error, HasSubstr("0 images traced, 5 kept"));
    }
}

} // namespace
} // namespace vkfv::test
