// Specimens that no careful hand wrote go through the real program: one that would fill the memory or run for minutes
// is refused before anything is made, and light that goes astray is told of.
#include "app/program.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <chrono>

namespace vkfv::test {
namespace {

using testing::AllOf;
using testing::HasSubstr;
using testing::Not;

constexpr const char* step = "kind = \"step\"\nsize_mm = 0.2\nheight_um = 2.0\n";
const std::string roughness = "[specimen.roughness]\nnoise_um = 0.1\nkernel_um = 1.0\npitch_um = 1.0\nseed = 7\n";

ProgramResult checked_program(const std::string& configuration,
                              const std::vector<std::string>& arguments = {"--check", "c.toml"}) {
    const auto folder = fresh_folder("hostile");
    write_file(folder / "c.toml", configuration);
    return run_program(arguments, folder);
}

struct Refused {
    std::string from, to;
    std::vector<std::string> message;
};

TEST(HostileSpecimen, GridsAreBoundedBeforeTheyAreMade) {
    const std::vector<Refused> cases = {
        {"pitch_um = 1.0", "pitch_um = 1e-300", {"c.toml:33:12", "specimen.roughness.pitch_um = 1e-300"}},
        {"pitch_um = 1.0",
         "pitch_um = 1e-5",
         {"c.toml:33:12", "fewer points than", "Choose roughness.pitch_um >= 0.0382"}},
        {"pitch_um = 1.0",
         "pitch_um = 1.3e-2",
         {"c.toml:33:12", "specimen.roughness.pitch_um = 0.013", "fewer points than",
          "Choose roughness.pitch_um >= 0.0382"}},
        {"height_um = 2.0",
         "height_um = 2.0\npitch_um = 1e-3",
         {"c.toml:28:12", "specimen.pitch_um = 0.001", "at most 16383 facets along the specimen's 0.2 mm"}},
        {"kernel_um = 1.0", "kernel_um = 1e300", {"c.toml:32:13", "specimen.roughness.kernel_um"}},
        {"height_um = 2.0", "height_um = 1e11", {"c.toml", "specimen", "Correct the lengths"}},
        {"height_um = 2.0",
         "height_um = 1e300",
         {"c.toml:27:13", "specimen.height_um = 1e+300", "0 or from 1e-06 (1 pm) to 1e+12 um (1000 km)"}},
        {"height_um = 2.0", "height_um = 2.0\nwall_um = 1e-300", {"c.toml:28:11", "specimen.wall_um = 1e-300"}},
        {"size_mm = 0.2", "size_mm = 1e8", {"c.toml:26:11", "specimen.size_mm", "from 1e-10 to 1e+06 mm"}},
        {"size_mm = 0.2",
         "size_mm = 1e300",
         {"c.toml:26:11", "specimen.size_mm", "0 or from 1e-09 (1 pm) to 1e+09 mm (1000 km)"}},
        {"size_mm = 0.16", "size_mm = 1e-310", {"detector.size_mm = 1e-310", "from 1e-09 (1 pm)"}},
        {"size_mm = 0.2", "size_mm = 1e-300", {"c.toml:26:11", "specimen.size_mm"}},
        {step,
         "kind = \"rough\"\nsize_mm = 5\nsq_um = 1\ncorrelation_length_um = 1000\n",
         {"specimen.pitch_um = 0.5", "fewer points than", "Choose pitch_um >="}},
        {step,
         "kind = \"air\"\ntiles = 1\ntile_size_mm = 5\npitch_um = 0.5\nsq_um = 1\nroll_off_wavelength_um = 100\n"
         "shortest_wavelength_um = 10\nhurst_exponent = 0.8\n",
         {"specimen.pitch_um = 0.5", "at most 8192 points along a sub-surface"}},
        {step,
         "kind = \"image\"\nfile = \"map.pgm\"\npitch_um = 1\nheight_um = 1\n",
         {"map.pgm", "16384 x 16384 pixels in 2 bytes"}},
        {"flux_W = 1.0", "flux_W = 1e45", {"c.toml:4:10", "source.flux_W = 1e+45"}},
        {"flux_W = 1.0", "flux_W = 1e-45", {"c.toml:4:10", "source.flux_W = 1e-45"}},
    };
    for (const Refused& refused : cases) {
        const auto folder = fresh_folder("hostile");
        const bool bare = refused.from == step; // without the roughness that belongs to it
        write_file(folder / "c.toml",
                   replaced(bare ? replaced(small_configuration, roughness, "") : small_configuration, refused.from,
                            refused.to));
        write_file(folder / "map.pgm", "P5 16384 16384 255\n ");
        const auto begin = std::chrono::steady_clock::now();
        const auto result = run_program({"--check", "c.toml"}, folder);
        EXPECT_LT(std::chrono::steady_clock::now() - begin, std::chrono::seconds(20)) << refused.to;
        EXPECT_EQ(result.exit_code, 2) << refused.to << result.standard_error;
        for (const auto& part : refused.message) {
            EXPECT_THAT(result.standard_error, HasSubstr(part)) << refused.to;
        }
    }
}

TEST(HostileSpecimen, SurfacesWithoutFacetsNeedNoPitch) {
    const std::string bare = replaced(ideal_configuration(), roughness, "");
    const auto with = [&](const std::string& specimen) { return checked_program(replaced(bare, step, specimen)); };
    EXPECT_EQ(with("kind = \"plane\"\nsize_mm = 20\nrepresentation = \"analytic\"\n").exit_code, 0);
    const auto facets = with("kind = \"plane\"\nsize_mm = 20\n");
    EXPECT_EQ(facets.exit_code, 2);
    EXPECT_THAT(facets.standard_error,
                HasSubstr("specimen.pitch_um = 0.5: expected at most 16383 facets along the specimen's 20 mm"));
    EXPECT_THAT(facets.standard_error,
                HasSubstr("Choose pitch_um >= 1.22 (0.5 if not given), or a smaller specimen, or representation = "
                          "\"analytic\"."));
}

TEST(HostileSpecimen, LightThatGoesAstrayIsToldOf) {
    // The part is a square from `low` to `high` along x and y.
    const auto run = [&](const std::string& low, const std::string& high, const std::string& keys,
                         const std::vector<std::string>& arguments) {
        const auto folder = fresh_folder("light");
        const auto facet = [&](const std::string& x, const std::string& y) {
            return "facet normal 0 0 1\nouter loop\nvertex " + low + " " + low + " 0\nvertex " + high + " " + high +
                   " 0\nvertex " + x + " " + y + " 0\nendloop\nendfacet\n";
        };
        write_file(folder / "part.stl", "solid s\n" + facet(low, high) + facet(high, low) + "endsolid s\n");
        write_file(folder / "c.toml", replaced(replaced(ideal_configuration(), roughness, ""), step,
                                               "kind = \"stl\"\nfile = \"part.stl\"\n" + keys));
        return run_program(arguments, folder);
    };
    const std::vector<std::string> check = {"--check", "c.toml"};
    const auto unseen = run("9", "10", "centre = false\n", check);
    EXPECT_THAT(unseen.standard_output,
                HasSubstr("The detector does not see the specimen: it is 1000 x 1000 um across, from x = "
                          "9000 and y = 9000 um on. Correct specimen.unit"));
    // Centred, the square fills the field, but not in another unit.
    EXPECT_THAT(run("9", "10", "", check).standard_output, Not(HasSubstr("of the field of view: it is")));
    EXPECT_THAT(run("9", "15", "unit = \"um\"\n", check).standard_output,
                AllOf(HasSubstr("The specimen fills "), HasSubstr("of the field of view: it is 6 x 6 um across")));
    const auto dark = run("9", "10", "centre = false\n", {"--image", "c.toml", "--z", "0", "--device", "host"});
    EXPECT_EQ(dark.exit_code, 0) << dark.standard_error;
    EXPECT_THAT(dark.standard_error, HasSubstr("The detector does not see the specimen"));
    EXPECT_THAT(dark.standard_error, HasSubstr("No ray of 2000 arrived at the detector: at most "));
    EXPECT_THAT(dark.standard_error, HasSubstr(" Most of it ends as \""));
    EXPECT_THAT(dark.standard_error, HasSubstr("source.radius_mm, specimen.size_mm, specimen.unit"));
    const auto stack = run("9", "10", "centre = false\n", {"--stack", "c.toml", "--device", "host", "--rays", "200"});
    EXPECT_THAT(stack.standard_error, HasSubstr("No ray of 1000 arrived at the detector: at most "));
}

// The wrong twin: a specimen in its place is not warned of.
TEST(HostileSpecimen, LightInItsPlaceIsNotToldOf) {
    for (const std::vector<std::string>& arguments :
         {std::vector<std::string>{"--check", "c.toml"}, {"--image", "c.toml", "--z", "0", "--device", "host"}}) {
        const auto result = checked_program(ideal_configuration(), arguments);
        EXPECT_EQ(result.exit_code, 0) << result.standard_error;
        EXPECT_THAT(result.standard_output + result.standard_error, Not(HasSubstr("arrived at the detector")));
        EXPECT_THAT(result.standard_output + result.standard_error, Not(HasSubstr("falls beside the specimen")));
        EXPECT_THAT(result.standard_output + result.standard_error, Not(HasSubstr("of the field of view: it is")));
    }
}

} // namespace
} // namespace vkfv::test
