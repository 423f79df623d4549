// vkfv capability measures sinusoids in place of the specimen, goes on where it ended, and writes a map.
#include "app/program.hpp"
#include "core/files/file.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

namespace vkfv::test {
namespace {
namespace of_capability { // files of a unity build share the unnamed namespace

namespace fs = std::filesystem;
using testing::HasSubstr;

const std::vector<std::string> command = {"capability", "c.toml", "--small", "--wavelengths", "2",    "--amplitudes",
                                          "2",          "--out",  "out",     "--device",      "host", "--quiet"};

// Pixels of 2 um and a window of 6 um: the wavelengths are 6 um and, with a field of 32 um, 16 um.
std::string rough_configuration() {
    std::string text = replaced(small_configuration, "size_mm = 0.16\npixels = 8", "size_mm = 0.32\npixels = 16");
    text = replaced(text, "kind = \"step\"\nsize_mm = 0.2\nheight_um = 2.0",
                    "kind = \"air\"\ntiles = 1\ntile_size_mm = 0.2\npitch_um = 0.5\nsq_um = 1.0\n"
                    "roll_off_wavelength_um = 8.0\nshortest_wavelength_um = 2.0\nhurst_exponent = 0.8");
    text = replaced(text, "z_start_um = -2.0\nz_stop_um = 2.0\nz_step_um = 1.0",
                    "z_start_um = -40.0\nz_stop_um = 40.0\nz_step_um = 8.0");
    return text + "[diffraction]\nmodel = \"none\"\n";
}

TEST(Capability, WritesAMapAndGoesOnWhereItEnded) {
    const auto folder = fresh_folder("capability");
    write_file(folder / "c.toml", rough_configuration());
    const auto first = run_program(command, folder);
    ASSERT_EQ(first.exit_code, 0) << first.standard_error;
    EXPECT_THAT(first.standard_output, HasSubstr("The specimen of the configuration has an Sq of"));
    EXPECT_THAT(first.standard_output, HasSubstr("not traceable"));
    const auto map = nlohmann::json::parse(read_file(folder / "out/capability.json"));
    ASSERT_EQ(map.at("nodes").size(), 4u);
    EXPECT_NEAR(map.at("nodes").at(0).at("wavelength_um").get<double>(), 6, 0.01);
    EXPECT_NEAR(map.at("nodes").at(3).at("wavelength_um").get<double>(), 16, 0.05);
    EXPECT_NEAR(map.at("nodes").at(3).at("amplitude_um").get<double>(), 20, 0.1); // a quarter of the scan
    // A window is shorter than 1.66 of them, and the highest waves of this length are steeper than the aperture.
    EXPECT_THAT(map.at("nodes").at(1).at("beyond_limits").get<std::vector<std::string>>(),
                testing::ElementsAre("window", "slope", "relief"));
    // The field holds few waves of the roughness, whose Sq is 1 um over its whole tile.
    EXPECT_NEAR(map.at("specimen").at("sq_um").get<double>(), 1, 0.4);
    EXPECT_EQ(map.at("specimen").at("beyond_limits").at(0).at("limit"), "window");
    EXPECT_EQ(map.at("first_seed"), 1);
    EXPECT_TRUE(map.at("small").get<bool>());
    const auto page = read_file(folder / "out/capability.html");
    EXPECT_THAT(page, HasSubstr("not traceable"));
    EXPECT_THAT(page, HasSubstr("The instrument to scale"));

    // A second run traces only the stack whose folder was removed, and writes the same map.
    const auto stack = [&](std::size_t node) {
        return folder / "out" / map.at("nodes").at(node).at("stack").get<std::string>();
    };
    const auto kept = fs::last_write_time(stack(1) / "images/z_0002.tif");
    fs::remove_all(stack(2));
    const auto bytes = read_file(folder / "out/capability.json");
    fs::remove(folder / "out/capability.json");
    const auto again = run_program(command, folder);
    ASSERT_EQ(again.exit_code, 0) << again.standard_error;
    EXPECT_EQ(fs::last_write_time(stack(1) / "images/z_0002.tif"), kept);
    EXPECT_EQ(read_file(folder / "out/capability.json"), bytes);
    EXPECT_EQ(run_program({"verify", "out"}, folder).exit_code, 0);
    EXPECT_EQ(run_program({"verify", stack(2).string()}, folder).exit_code, 0);
}

} // namespace of_capability
} // namespace
} // namespace vkfv::test
