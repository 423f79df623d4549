// A camera's stack through the real program has the same bytes however it was taken, and grey values all the way.
#include "app/program.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <map>
#include <set>
#include <sstream>
#include <utility>
#include <vector>

namespace vkfv::test {
namespace {

namespace fs = std::filesystem;
using testing::HasSubstr;
using testing::Not;

std::string with_camera() {
    return replaced(small_configuration, "[output]\n",
                    "[camera]\npreset = \"IMX900\"\n[output]\nimages = \"uint16\"\n");
}

// All files except for those in which the folder's name or a time stands.
std::map<std::string, std::string> files_of(const fs::path& folder) {
    std::map<std::string, std::string> files;
    for (const auto& entry : fs::recursive_directory_iterator(folder)) {
        const auto name = entry.path().filename().string();
        if (entry.is_regular_file() && !name.starts_with("timings") && name != "report.html" &&
            name != "topography.svg" && name != "checksums.sha256") {
            files[fs::relative(entry.path(), folder).string()] = read_file(entry.path());
        }
    }
    return files;
}

void expect_success(const ProgramResult& result) {
    ASSERT_EQ(result.exit_code, 0) << result.standard_error;
}

TEST(CameraStack, HasTheSameBytesInOneRunResumedAndInShards) {
    const auto folder = fresh_folder("camera_stack");
    write_file(folder / "c.toml", with_camera());
    expect_success(run_program({"stack", "c.toml", "--out", "a", "--device", "host"}, folder));
    expect_success(run_program({"stack", "c.toml", "--out", "b", "--device", "host", "--shard", "2/2"}, folder));
    expect_success(run_program({"stack", "c.toml", "--out", "b", "--device", "host", "--shard", "1/2"}, folder));
    expect_success(run_program({"merge", "b"}, folder));
    fs::copy(folder / "a", folder / "d", fs::copy_options::recursive);
    fs::remove(folder / "d/images/z_0000.tif");
    fs::remove(folder / "d/images/z_0003.tif");
    expect_success(run_program({"stack", "c.toml", "--out", "d", "--device", "host"}, folder));
    const auto one = files_of(folder / "a");
    EXPECT_EQ(files_of(folder / "d"), one);
    for (const char* file : {"images/z_0000.tif", "images/z_0004.tif", "results.json", "topography.tif"}) {
        EXPECT_EQ(read_file(folder / "b" / file), one.at(file)) << file;
    }
    const auto results = nlohmann::json::parse(one.at("results.json"));
    const auto& camera = results.at("camera");
    EXPECT_GT(camera.at("exposure_s"), 0);
    EXPECT_GT(camera.at("ray_noise_e"), camera.at("camera_noise_e")); // of 2000 rays
    EXPECT_THAT(results.at("warnings").dump(), HasSubstr("--rays"));
    EXPECT_THAT(read_file(folder / "a/report.html"), HasSubstr("camera noise / e⁻"));
    EXPECT_THAT(one.at("images/z_0000.tif"), HasSubstr("values=grey values in DN"));

    // An image of the same height is the stack's.
    expect_success(run_program({"image", "c.toml", "--z", "-1", "--out", "i.tif", "--device", "host"}, folder));
    const auto pixels = [](const std::string& bytes) { return bytes.substr(bytes.size() - 2 * 8 * 8); };
    const auto single = read_file(folder / "i.tif");
    EXPECT_NE(single.find(pixels(one.at("images/z_0001.tif"))), std::string::npos);
}

TEST(CameraStack, OtherSeedsMakeOtherImagesAndNoCameraMakesLight) {
    const auto folder = fresh_folder("camera_seeds");
    write_file(folder / "c.toml", with_camera());
    write_file(folder / "light.toml", small_configuration);
    const auto image = [&](const std::string& name, std::vector<std::string> settings) {
        settings.insert(settings.begin(), {"image", name, "--z", "0", "--out", "i.tif", "--device", "host"});
        expect_success(run_program(settings, folder));
        return read_file(folder / "i.tif");
    };
    const auto first = image("c.toml", {});
    EXPECT_EQ(image("c.toml", {}), first);
    EXPECT_NE(image("c.toml", {"--set", "camera.seed=2"}), first);
    EXPECT_THAT(image("light.toml", {}), Not(HasSubstr("DN")));
    EXPECT_THAT(image("c.toml", {"--set", "camera.bit_depth=8", "--set", "camera.gain_dn_per_e=0.02", "--set",
                                 "camera.offset_dn=8", "--set", "output.images=\"uint8\""}),
                HasSubstr("grey values in DN"));
}

// The tutorial's microscope: ring light, rectangular chip, camera, ideal 20x/0.45. A piece of 8 um across the step, its
// texture as rough as in the tutorial's table, by a window that fits into it. The error may be 4 standard errors, and
// no more than a third of the depth of field of 2.6 um.
TEST(CameraStack, ThePieceOfOnesOwnMicroscopeHasItsStep) {
    const auto folder = fresh_folder("own_microscope");
    const auto example = (fs::path(VKFV_SOURCE_DIR) / "assets/stacks/own_microscope.toml").string();
    std::vector<std::string> words = {"stack", example, "--out", "out", "--quiet", "--rays", "184320"};
    for (const char* setting :
         {"detector.pixels=[48,40]", "specimen.size_mm=0.012", "scan.z_step_um=1", "specimen.roughness.ra_um=0.1",
          "specimen.roughness.kernel_um=0.4", "topography.window_px=15", "topography.focus_measure=wavelet"}) {
        words.insert(words.end(), {"--set", setting});
    }
    expect_success(run_program(words, folder));
    const auto results = nlohmann::json::parse(read_file(folder / "out/results.json"));
    const auto& step = results.at("dimensions").at(1);
    EXPECT_EQ(step.at("name"), "step height, areal");
    EXPECT_EQ(step.at("nominal"), 10);
    EXPECT_NEAR(step.at("true"), 10, 0.05);
    const double error = step.at("error"), standard_error = step.at("standard_error");
    EXPECT_LT(std::abs(error), std::min(4 * standard_error, 0.9));
    EXPECT_LT(standard_error, 0.3);
    EXPECT_GT(results.at("measured_share"), 0.7);
    EXPECT_THAT(read_file(folder / "out/images/z_0000.tif"), HasSubstr("values=grey values in DN"));
}

// Heights depend neither on the type of the files' pixels, since whole grey values are the same in float32, nor on
// where the images are evaluated.
TEST(CameraStack, IsEvaluatedToTheSameBitsOfAnyPixelTypeOnHostAndDevice) {
    const auto folder = fresh_folder("camera_types");
    write_file(folder / "c.toml", with_camera());
    std::string first;
    for (const char* where : {"host", "device"}) {
        for (const char* type : {"float32", "uint16", "uint8"}) {
            const std::string out = std::string(where) + type;
            expect_success(run_program({"stack",    "c.toml",
                                        "--out",    out,
                                        "--device", "host",
                                        "--set",    "camera.bit_depth=8",
                                        "--set",    "camera.gain_dn_per_e=0.02",
                                        "--set",    "camera.offset_dn=8",
                                        "--set",    "camera.read_noise_e=60",
                                        "--set",    std::string("topography.evaluate_on=\"") + where + "\"",
                                        "--set",    std::string("output.images=\"") + type + "\"",
                                        "--set",    "output.surfaces=[\"npy\"]"},
                                       folder));
            const auto heights = read_file(folder / out / "topography.npy") + read_file(folder / out / "quality.tif");
            first = first.empty() ? heights : first;
            EXPECT_EQ(heights, first) << where << " " << type;
        }
    }
}

TEST(CameraCheck, TellsOfTheCamera) {
    const auto folder = fresh_folder("camera_check");
    write_file(folder / "c.toml", with_camera());
    const auto check = run_program({"check", "c.toml", "--json", "--forecast", "--device", "host"}, folder);
    expect_success(check);
    const auto json = nlohmann::json::parse(check.standard_output);
    EXPECT_NEAR(json.at("camera_clip_e"), 9796, 2);
    EXPECT_NEAR(json.at("camera_dynamic_range_db"), 63.80, 0.01);
    EXPECT_GT(json.at("forecast").at("camera").at("ray_over_camera_noise"), 1.0 / 3);
    EXPECT_FALSE(json.at("forecast").at("warnings").empty());
}

TEST(CameraCommand, WritesFiguresChartsAndImages) {
    const auto folder = fresh_folder("camera_command");
    write_file(folder / "c.toml", with_camera());
    const auto camera =
        run_program({"camera", "c.toml", "--out", "m", "--pixels", "48", "--averaged", "8", "--images"}, folder);
    expect_success(camera);
    EXPECT_THAT(camera.standard_output, HasSubstr("saturation capacity / e-"));
    const auto json = nlohmann::json::parse(read_file(folder / "m/camera.json"));
    EXPECT_NEAR(json.at("gain_dn_per_e").at("measured"), 0.399, 0.02);
    for (const char* file : {"photon_transfer.svg", "signal_to_noise.svg", "linearity.svg", "transfer.csv",
                             "images.csv", "images/transfer_000_a.tif"}) {
        EXPECT_TRUE(fs::exists(folder / "m" / file)) << file;
    }
    // The descriptor has the images of the list by their light and time (s there, ns here), without those about the
    // largest variance. The EMVA 1288 reference implementation takes sets of two images for pairs, refuses a second
    // pair or stack of the same numbers, so that the first of them stands for the others, and stops its search of
    // saturation at the last of many close steps.
    std::map<std::string, std::pair<double, double>> listed; // photons and exposure time by file
    std::set<std::string> close_steps;                       // files of the close steps about the largest variance
    std::istringstream list(read_file(folder / "m/images.csv"));
    std::string line;
    std::getline(list, line);
    while (std::getline(list, line)) {
        std::istringstream cells(line);
        std::string file, series, photons, exposure;
        std::getline(std::getline(std::getline(std::getline(cells, file, ','), series, ','), photons, ','), exposure);
        listed[file] = {std::stod(photons), std::stod(exposure)};
        if (series == "search" || series == "middle" || series == "peak")
            close_steps.insert(file);
    }
    std::istringstream descriptor(read_file(folder / "m/emva1288.txt"));
    std::getline(descriptor, line);
    EXPECT_TRUE(line.starts_with('#'));
    std::string word;
    EXPECT_TRUE(std::getline(descriptor, line) && line == "v 3.0");
    EXPECT_TRUE(std::getline(descriptor, line) && line == "n 12 48 48");
    double exposure_ns = 0, photons = 0;
    struct Set {
        std::pair<double, double> light; // photons and exposure time in ns
        int images = 0;
    };
    std::vector<Set> sets;
    std::set<std::string> described;
    while (descriptor >> word) {
        if (word == "i") {
            std::string file;
            descriptor >> file;
            ASSERT_TRUE(listed.contains(file)) << file;
            EXPECT_NEAR(listed[file].first, photons, 1e-6 + 1e-9 * photons) << file;
            EXPECT_NEAR(1e9 * listed[file].second, exposure_ns, 0.1) << file;
            EXPECT_TRUE(fs::exists(folder / "m" / file)) << file;
            described.insert(file);
            ++sets.back().images;
        } else {
            ASSERT_TRUE(word == "b" || word == "d") << word;
            descriptor >> exposure_ns;
            photons = 0;
            if (word == "b") {
                descriptor >> photons;
                EXPECT_GT(photons, 0);
            }
            sets.push_back({.light = {photons, exposure_ns}});
        }
    }
    std::set<std::pair<bool, std::pair<double, double>>> kinds;
    for (const Set& set : sets) {
        EXPECT_GE(set.images, 2);
        EXPECT_TRUE(kinds.emplace(set.images == 2, set.light).second) << set.light.first << " photons twice";
    }
    for (const auto& [file, light] : listed) {
        const bool pair = file.ends_with("_a.tif") || file.ends_with("_b.tif");
        const auto same = [&, &light = light](const Set& set) {
            return (set.images == 2) == pair && std::abs(set.light.first - light.first) <= 1e-6 &&
                   std::abs(set.light.second - 1e9 * light.second) <= 0.1;
        };
        if (close_steps.contains(file))
            EXPECT_FALSE(described.contains(file)) << file;
        else
            EXPECT_TRUE(described.contains(file) || std::ranges::any_of(sets, same)) << file;
    }
    EXPECT_FALSE(close_steps.empty());
    const auto without = run_program({"camera", "absent.toml"}, folder);
    EXPECT_EQ(without.exit_code, 2);
}

} // namespace
} // namespace vkfv::test
