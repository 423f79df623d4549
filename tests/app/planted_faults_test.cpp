// `vkfv check` must find the fault of each configuration of a table, by the code of its warning, and the remedy that
// the warning names must work. An objective turned round is in tests/lenses/lens_files_test.py.
#include "app/program.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include <algorithm>

namespace vkfv::test {
namespace {

using ::testing::Contains;
using ::testing::IsEmpty;
using ::testing::Not;

// The library's 10x objective over a tilted plane with texture, 64 x 64 pixels of 2 um; nothing is wrong with it.
const std::string sound_configuration = R"([source]
radius_mm = 0.96
wavelength_um = 0.5876

[illumination]
prescription = "koehler"
field_stop_radius_mm = 0.8

[objective]
prescription = "10x_0.28"

[tube_lens]
prescription = "200mm"

[detector]
size_mm = 1.28
pixels = 64

[specimen]
kind = "plane"
size_mm = 0.15
tilt_x_deg = 2.0
pitch_um = 0.5

[specimen.roughness]
noise_um = 4.0
kernel_um = 1.0
pitch_um = 0.5
seed = 7

[specimen.material]
g = 0.8

[scan]
z_start_um = -16.0
z_stop_um = 16.0
z_step_um = 1.0

[trace]
rays = 1e6
estimator = "backward"
)";

const std::string without_roughness = [] {
    const auto from = sound_configuration.find("[specimen.roughness]"), to = sound_configuration.find("[specimen.mat");
    return sound_configuration.substr(0, from) + sound_configuration.substr(to);
}();

// A ring light of the same instrument, whose band stands below the objective.
const std::string with_ring =
    replaced(replaced(sound_configuration, "radius_mm = 0.96\nwavelength_um",
                      "kind = \"ring\"\ndistance_mm = 25.0\nelevation_deg = 30.0\nwidth_mm = 0.2\nwavelength_um"),
             "[illumination]\nprescription = \"koehler\"\nfield_stop_radius_mm = 0.8\n",
             "[beam_splitter]\nreflectance = 0.0\ntransmittance = 1.0\n");

struct PlantedFault {
    const char* name;
    const std::string* configuration;
    std::vector<std::string> changes; // --set
    const char* code;
    const char* key;
    const char* measurable;    // as the verdict says; null: it does not matter
    bool works_as_told = true; // a value; of the device's memory, gloss and texture it is words
};

std::ostream& operator<<(std::ostream& stream, const PlantedFault& fault) {
    return stream << fault.name;
}

nlohmann::json checked(const std::string& configuration, const std::vector<std::string>& changes,
                       const std::filesystem::path& folder) {
    write_file(folder / "c.toml", configuration);
    std::vector<std::string> arguments = {"check", "c.toml", "--json"};
    for (const auto& change : changes) {
        arguments.insert(arguments.end(), {"--set", change});
    }
    const auto result = run_program(arguments, folder);
    EXPECT_EQ(result.exit_code, 0) << result.standard_error;
    return nlohmann::json::parse(result.standard_output);
}

std::vector<std::string> codes_of(const nlohmann::json& report) {
    std::vector<std::string> codes;
    for (const auto& warning : report["warnings"]) {
        codes.push_back(warning["code"]);
    }
    return codes;
}

class PlantedFaults : public ::testing::TestWithParam<PlantedFault> {};

TEST_P(PlantedFaults, IsFoundAndWhatIsSaidToWorkWorks) {
    const auto& fault = GetParam();
    const auto folder = fresh_folder(std::string("planted_") + fault.name);
    const auto report = checked(*fault.configuration, fault.changes, folder);
    ASSERT_THAT(codes_of(report), Contains(fault.code)) << report["warnings"].dump(1);
    if (fault.measurable != nullptr) {
        EXPECT_EQ(report["verdict"]["measurable"], fault.measurable) << report["verdict"].dump(1);
    }
    std::vector<std::string> changes = fault.changes;
    for (const auto& warning : report["warnings"]) {
        if (warning["code"] != fault.code) {
            continue;
        }
        EXPECT_EQ(warning["key"], fault.key);
        EXPECT_NE(warning["works"], "");
        EXPECT_NE(warning["sentence"], "");
        const std::string key = warning["key"], works = warning["works"];
        std::erase_if(changes, [&](const std::string& change) { return change.starts_with(key + "="); });
        changes.push_back(key + "=" + works);
    }
    if (fault.works_as_told) {
        EXPECT_THAT(codes_of(checked(*fault.configuration, changes, folder)), Not(Contains(fault.code)));
    }
}

INSTANTIATE_TEST_SUITE_P(
    Check, PlantedFaults,
    ::testing::Values(
        PlantedFault{"ScanInsideTheDepthOfField",
                     &sound_configuration,
                     {"scan.z_start_um=-1", "scan.z_stop_um=2", "specimen.tilt_x_deg=0"},
                     "scan-in-depth-of-field",
                     "scan.z_stop_um",
                     "no"},
        PlantedFault{"AThousandRaysFor16384Pixels",
                     &sound_configuration,
                     {"detector.pixels=128", "trace.rays=1000", "trace.estimator=\"forward\""},
                     "few-rays",
                     "trace.rays",
                     "no"},
        PlantedFault{"ForwardWithARingLight",
                     &with_ring,
                     {"trace.rays=1e6", "trace.estimator=\"forward\""},
                     "forward-wastes-rays",
                     "trace.estimator",
                     "no"},
        PlantedFault{"NoTexture", &without_roughness, {}, "no-texture", "specimen.roughness.noise_um", "no", false},
        PlantedFault{"WindowAsWideAsTheImage",
                     &sound_configuration,
                     {"topography.window_px=63"},
                     "wide-window",
                     "topography.window_px",
                     "no"},
        PlantedFault{"RingLightInTheObjective",
                     &with_ring,
                     {"source.distance_mm=40", "source.elevation_deg=84"},
                     "ring-in-objective",
                     "source.elevation_deg",
                     "partly"},
        PlantedFault{"MemoryThatIsNotThere",
                     &sound_configuration,
                     {"detector.pixels=16384"},
                     "memory",
                     "detector.pixels",
                     "no",
                     false},
        PlantedFault{"RayNoiseWithoutACamera",
                     &sound_configuration,
                     {"trace.rays=2e4"},
                     "ray-noise-without-camera",
                     "trace.rays",
                     nullptr},
        PlantedFault{"PixelsFarTooCoarse",
                     &sound_configuration,
                     {"detector.pixels=24"},
                     "coarse-pixels",
                     "detector.pixels",
                     nullptr},
        PlantedFault{"PixelsFarTooFine",
                     &sound_configuration,
                     {"detector.pixels=1280"},
                     "fine-pixels",
                     "detector.pixels",
                     nullptr},
        PlantedFault{"ScanThatDoesNotHoldTheSpecimen",
                     &sound_configuration,
                     {"scan.z_stop_um=-4"},
                     "scan-misses-specimen",
                     "scan.z_stop_um",
                     "partly"},
        PlantedFault{"GlossWhereWavesDoNotHold",
                     &sound_configuration,
                     {"diffraction.model=\"waves\"", "source.radius_mm=0.3", "specimen.material.g=0.999"},
                     "waves-do-not-hold",
                     "source.radius_mm",
                     nullptr,
                     false}),
    [](const auto& info) { return std::string(info.param.name); });

// The wrong twin of all of them is the sound configuration.
TEST(PlantedFaults, ASoundConfigurationHasNoWarning) {
    const auto folder = fresh_folder("planted_none");
    const auto report = checked(sound_configuration, {}, folder);
    EXPECT_THAT(codes_of(report), IsEmpty()) << report["warnings"].dump(1);
    EXPECT_EQ(report["verdict"]["measurable"], "yes") << report["verdict"].dump(1);
    EXPECT_THAT(codes_of(checked(with_ring, {}, folder)), Not(Contains("ring-in-objective")));
}

TEST(PlantedFaults, TheVerdictComesFirstAndTheRestWithAll) {
    const auto folder = fresh_folder("planted_text");
    write_file(folder / "c.toml", sound_configuration);
    const auto brief = run_program({"check", "c.toml"}, folder),
               all = run_program({"check", "c.toml", "--all"}, folder);
    EXPECT_TRUE(brief.standard_output.starts_with("c.toml: valid, can be measured\n")) << brief.standard_output;
    EXPECT_THAT(brief.standard_output, ::testing::HasSubstr("Expected of a height: noise "));
    EXPECT_THAT(brief.standard_output, Not(::testing::HasSubstr("back_pupil_radius_mm")));
    EXPECT_THAT(all.standard_output, ::testing::HasSubstr("back_pupil_radius_mm"));
}

} // namespace
} // namespace vkfv::test
