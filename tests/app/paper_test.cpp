// The reference paper's experiments hold in small: assets/stacks/paper_*_small.toml.
#include "app/program.hpp"

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>
#include <pugixml.hpp>

#include <cmath>
#include <filesystem>
#include <fstream>
#include <map>
#include <sstream>

namespace vkfv::test {
namespace {

namespace fs = std::filesystem;

std::string stack(const std::string& name) {
    return (fs::path(VKFV_SOURCE_DIR) / "assets/stacks" / name).string();
}

TEST(Paper, LogoUnderFullFactorialVariation) {
    const auto folder = fresh_folder("logo");
    const auto result = run_program({"--sweep", stack("paper_logo_small.toml"), "--out", "out", "--quiet"}, folder);
    ASSERT_EQ(result.exit_code, 0) << result.standard_error;
    std::map<std::string, std::map<std::string, double>> ratio, share; // by g and N
    std::ifstream table(folder / "out/sweep.csv");
    std::string line;
    std::getline(table, line);
    ASSERT_TRUE(line.starts_with("g,N,signal to noise,contrast,share collected")) << line;
    while (std::getline(table, line)) {
        std::istringstream cells(line);
        std::string g, n, cell;
        std::getline(cells, g, ',');
        std::getline(cells, n, ',');
        std::getline(cells, cell, ',');
        ratio[g][n] = std::stod(cell);
        std::getline(cells, cell, ',');
        std::getline(cells, cell, ',');
        share[g][n] = std::stod(cell);
    }
    ASSERT_EQ(ratio.size(), 3u);
    for (const auto& [g, of_rays] : ratio) {
        ASSERT_EQ(of_rays.size(), 4u);
        // A hundred times the rays give ten times the ratio of signal to noise. n detected rays leave it a relative
        // error of 1 / (2 sqrt(n)); at N = 1e5 at least 3500 are detected: five of these errors are 4 %.
        EXPECT_NEAR(of_rays.at("1e7") / of_rays.at("1e5"), 10, 0.42) << g;
    }
    // A sharper lobe sends more into the pupil; a level mirror would send all.
    EXPECT_LT(1.5 * share.at("0.3").at("1e7"), share.at("0.65").at("1e7"));
    EXPECT_LT(1.5 * share.at("0.65").at("1e7"), share.at("1").at("1e7"));
    EXPECT_LT(share.at("1").at("1e7"), 1);
    pugi::xml_document sheet;
    ASSERT_TRUE(sheet.load_file((folder / "out/sweep.svg").c_str()));
    EXPECT_EQ(sheet.select_nodes("//image").size(), 12u);
}

// The stack has half of its light and every other image. The wrong twin is the stack in a random order.
TEST(Paper, TopographyOfTypeAir) {
    const auto folder = fresh_folder("air");
    const auto result = run_program({"--stack", stack("paper_air_small.toml"), "--out", "out", "--quiet", "--rays",
                                     "2.6e5", "--set", "scan.z_step_um=0.8"},
                                    folder);
    ASSERT_EQ(result.exit_code, 0) << result.standard_error;
    const auto figures = [&](const fs::path& file) { return nlohmann::json::parse(read_file(folder / file)); };
    const auto found = figures("out/results.json");
    EXPECT_GT(found["correlation"].get<double>(), 0.7);
    EXPECT_NEAR(found["sq_ratio"].get<double>(), 0.95, 0.15);
    EXPECT_GT(found["measured_share"].get<double>(), 0.95);
    EXPECT_TRUE(fs::exists(folder / "out/topography.svg"));
    const auto control = run_program({"--topography", "out", "--shuffle", "3", "--out", "control", "--quiet"}, folder);
    ASSERT_EQ(control.exit_code, 0) << control.standard_error;
    EXPECT_LT(figures("control/results.json")["measured_share"].get<double>(), 0.05);
}

} // namespace
} // namespace vkfv::test
