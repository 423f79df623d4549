// Every shipped microscope works with light as it is sold: with lines from blue to red, with a white diode, and with an
// illuminator that needs no prescription.
#include "app/program.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include <filesystem>
#include <string>
#include <vector>

namespace vkfv::test {
namespace {

using ::testing::Contains;
using ::testing::HasSubstr;
using ::testing::Not;

namespace fs = std::filesystem;

const std::vector<std::string> magnifications = {"5x", "10x", "20x", "50x", "100x"};

constexpr const char* white_led = R"([source.spectrum]
kind = "table"
wavelengths_um = [0.40, 0.43, 0.45, 0.47, 0.50, 0.55, 0.60, 0.65, 0.70]
densities = [0.0, 0.2, 1.0, 0.3, 0.3, 0.6, 0.5, 0.2, 0.0]
)";

std::string microscope(const std::string& magnification) {
    return read_file(fs::path(VKFV_SOURCE_DIR) / ("assets/stacks/microscope_" + magnification + ".toml"));
}

void replace_text(std::string& text, const std::string& found, const std::string& by) {
    const auto at = text.find(found);
    ASSERT_NE(at, std::string::npos) << found;
    text.replace(at, found.size(), by);
}

nlohmann::json checked(const std::string& configuration, const std::vector<std::string>& more = {}) {
    const auto folder = fresh_folder("light_colours");
    write_file(folder / "c.toml", configuration);
    // The rays that foretell the noise of forward images are no more than those of the configuration, and those that
    // foretell the noise of heights are of so many pixels.
    std::vector<std::string> arguments = {
        "check", "c.toml", "--json", "--rays", "10000", "--set", "detector.pixels=16"};
    arguments.insert(arguments.end(), more.begin(), more.end());
    const auto result = run_program(arguments, folder);
    EXPECT_EQ(result.exit_code, 0) << result.standard_error;
    return result.exit_code == 0 ? nlohmann::json::parse(result.standard_output) : nlohmann::json{};
}

} // namespace

TEST(LightColours, EveryMicroscopeTakesLinesFromBlueToRed) {
    const auto estimated = Contains(HasSubstr("known at the F, d and C lines alone"));
    for (const std::string& magnification : magnifications) {
        for (const std::string um : {"0.40", "0.46", "0.55", "0.63", "0.70"}) {
            SCOPED_TRACE(magnification + " at " + um + " um");
            const auto report = checked(microscope(magnification), {"--set", "source.wavelength_um=" + um});
            ASSERT_TRUE(report.contains("warnings"));
            std::vector<std::string> warnings;
            for (const auto& warning : report["warnings"]) {
                warnings.push_back(warning["sentence"]);
            }
            if (um == "0.55" || um == "0.63") {
                EXPECT_THAT(warnings, Not(estimated));
            } else {
                EXPECT_THAT(warnings, estimated);
            }
        }
    }
}

TEST(LightColours, EveryMicroscopeTakesAWhiteDiode) {
    for (const std::string& magnification : magnifications) {
        SCOPED_TRACE(magnification);
        auto text = microscope(magnification);
        replace_text(text, "wavelength_um = 0.5876", "");
        checked(text + "\n" + white_led);
    }
}

TEST(LightColours, AnIdealIlluminatorReplacesAPrescription) {
    auto text = microscope("10x");
    replace_text(text, "prescription = \"koehler\"", "kind = \"ideal\"\ncondenser_focal_length_mm = 30.0");
    const auto report = checked(text);
    // The field lens has 150 mm by default, so the source is imaged five times larger.
    EXPECT_NEAR(report["back_pupil_radius_mm"].get<double>() / report["pupil_radius_in_source_mm"].get<double>(), 5,
                1e-5);
}

} // namespace vkfv::test
