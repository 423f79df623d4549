// Configurations in process: values, units, canonical text and identity.
#include "app/configuration.hpp"
#include "app/program.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>

namespace vkfv::app {
namespace {

using test::fresh_folder;
using test::replaced;
using test::small_configuration;
using test::write_file;
using testing::HasSubstr;

Configuration load(const std::string& name, const std::string& text,
                   const std::vector<TomlOverride>& overrides = {}, Needs needs = Needs::stack) {
    const auto file = fresh_folder(name) / "c.toml";
    write_file(file, text);
    return load_configuration(file, overrides, needs);
}

TEST(Configuration, ConvertsUnitsOnceAtTheBorder) {
    const auto configuration = load("units", small_configuration);
    EXPECT_EQ(configuration.instrument.source_radius, 0.96);
    EXPECT_EQ(configuration.instrument.spectrum.reference_um, 0.5876);
    EXPECT_EQ(configuration.instrument.detector_pixels, 8);
    EXPECT_EQ(configuration.specimen->height, 0.002);
    EXPECT_EQ(configuration.specimen->roughness->noise, 0.0001);
    EXPECT_EQ(configuration.specimen->material.lobes[0].parameters[0], 0.8);
    EXPECT_EQ(configuration.scan->z_start, -0.002);
    EXPECT_EQ(configuration.scan->positions().size(), 5u);
    EXPECT_EQ(configuration.trace.rays, 2000u);
    EXPECT_EQ(configuration.instrument.directed_emission, true);
    const auto tilted = load("tilt", replaced(replaced(small_configuration, "\"step\"", "\"plane\""),
                                              "height_um = 2.0", "tilt_x_deg = 45"));
    EXPECT_NEAR(std::tan(tilted.specimen->tilt_x), 1.0, 1e-15); // one rounding of the angle
}

TEST(Configuration, PathsAreRelativeToTheFile) {
    const auto configuration = load("paths", small_configuration);
    EXPECT_EQ(configuration.output_directory, configuration.file.parent_path() / "out");
    const auto overridden =
        load("paths", small_configuration, {{"output.directory", "\"elsewhere\"", "--out"}});
    EXPECT_EQ(overridden.output_directory, "elsewhere");
}

TEST(Configuration, OverridesWin) {
    const auto configuration = load("overrides", small_configuration,
                                    {{"trace.rays", "1e9", "--rays"},
                                     {"trace.traversal", "\"quadtree\"", "--traversal"},
                                     {"specimen.material.g", "0.65", "--set"}});
    EXPECT_EQ(configuration.trace.rays, 1'000'000'000u);
    EXPECT_EQ(configuration.trace.traversal, trace::Traversal::quadtree);
    EXPECT_EQ(configuration.specimen->material.lobes[0].parameters[0], 0.65);
}

TEST(Configuration, CanonicalTextReadsBackToItself) {
    // 0.1 um, 0.7 um, 1/3: numbers whose conversion to mm and back would not be exact.
    const auto text = replaced(replaced(small_configuration, "z_step_um = 1.0", "z_step_um = 0.7"),
                               "pitch_um = 1.0", "pitch_um = 0.3333333333333333");
    const auto first = load("canonical", text);
    const auto second = load("canonical_again", first.canonical);
    EXPECT_EQ(first.canonical, second.canonical);
    EXPECT_EQ(first.identity, second.identity);
    EXPECT_EQ(first.scan->z_step, second.scan->z_step);
    // As stack.toml in the output folder, it continues the stack there.
    EXPECT_EQ(second.output_directory, second.file.parent_path());
    // Defaults are written out.
    EXPECT_THAT(first.canonical, HasSubstr("max_bounces = 2\n"));
    EXPECT_THAT(first.canonical, HasSubstr("distance_mm = 100.0\n"));
}

TEST(Configuration, IdentityHoldsWhatChangesImagesAndNothingElse) {
    const auto reference = load("identity", small_configuration).identity;
    const std::vector<TomlOverride> neutral = {
        {"trace.batch", "4096", ""},       {"trace.traversal", "\"quadtree\"", ""},
        {"trace.device", "\"host\"", ""},  {"output.directory", "\"other\"", ""},
        {"topography.window_px", "5", ""}, {"topography.l_filter_um", "80", ""},
    };
    for (const auto& change : neutral) {
        EXPECT_EQ(load("identity", small_configuration, {change}).identity, reference) << change.key;
    }
    const std::vector<TomlOverride> influential = {
        {"trace.rays", "2001", ""},
        {"trace.seed", "2", ""},
        {"trace.max_bounces", "3", ""},
        {"trace.emission", "\"analog\"", ""},
        {"specimen.material.g", "0.81", ""},
        {"specimen.material.reflectance", "0.9", ""},
        {"specimen.representation", "\"analytic\"", ""},
        {"specimen.roughness.seed", "8", ""},
        {"scan.z_step_um", "0.5", ""},
        {"source.radius_mm", "0.97", ""},
        {"source.distance_mm", "18", ""},
        {"detector.pixels", "9", ""},
        {"objective.prescription", "\"5x_0.15\"", ""},
        {"tube_lens.distance_mm", "101", ""},
        {"beam_splitter.reflectance", "0.4", ""},
        {"illumination.field_stop_radius_mm", "3", ""},
    };
    for (const auto& change : influential) {
        EXPECT_NE(load("identity", small_configuration, {change}).identity, reference) << change.key;
    }
}

TEST(Configuration, IdentityFollowsAPrescriptionsContentNotItsPlace) {
    const auto asset = std::filesystem::path(VKFV_SOURCE_DIR) / "assets/objectives/10x_0.28.toml";
    const auto reference = load("content", small_configuration).identity;
    const auto text = replaced(small_configuration, "\"10x_0.28\"", "\"copy.toml\"");
    const auto load_copy = [&](const std::string& content) {
        const auto folder = fresh_folder("content");
        write_file(folder / "copy.toml", content);
        write_file(folder / "c.toml", text);
        return load_configuration(folder / "c.toml").identity;
    };
    const auto content = test::read_file(asset);
    EXPECT_EQ(load_copy(content), reference);
    const auto thickness = content.find("thickness_mm = ") + 15;
    EXPECT_NE(load_copy(content.substr(0, thickness) + "1" + content.substr(thickness)), reference);
}

TEST(Configuration, IdentityFollowsTheContentOfACataloguesGlass) {
    const auto asset = std::filesystem::path(VKFV_SOURCE_DIR) / "assets/objectives/10x_0.28.toml";
    const auto lens = replaced(test::read_file(asset), "medium = \"622632\"", "medium = \"mine\"");
    const auto text = replaced(small_configuration, "\"10x_0.28\"", "\"lens.toml\"");
    const auto load_with = [&](const std::string& catalogue, const std::string& content) {
        const auto folder = fresh_folder("catalogue");
        write_file(folder / "lens.toml", lens);
        write_file(folder / catalogue, content);
        write_file(folder / "c.toml", "glass_catalogs = [\"" + catalogue + "\"]\n" + text);
        return load_configuration(folder / "c.toml");
    };
    const std::string glass = "NM MINE 5\nCD 1.6225\nLD 0.4 0.7\n";
    const auto reference = load_with("a.agf", glass);
    EXPECT_THAT(reference.canonical,
                HasSubstr("glass_catalogs = [\"" +
                          (std::filesystem::absolute(reference.file.parent_path()) / "a.agf").string() +
                          "\"]\n"));
    EXPECT_EQ(load("catalogue_again", reference.canonical).canonical, reference.canonical);
    EXPECT_EQ(load_with("b.agf", glass + "NM OTHER 5\nCD 1.5\nLD 0.4 0.7\n").identity, reference.identity);
    EXPECT_NE(load_with("a.agf", "NM MINE 5\nCD 1.6226\nLD 0.4 0.7\n").identity, reference.identity);
    EXPECT_THROW(load_with("a.agf", "NM YOURS 5\nCD 1.6225\nLD 0.4 0.7\n"), InputError);
}

TEST(Configuration, CommandsThatNeedNoSpecimenDoWithoutIt) {
    const auto text = small_configuration.substr(0, small_configuration.find("[specimen]"));
    EXPECT_FALSE(load("instrument", text, {}, Needs::instrument).specimen);
    EXPECT_THROW((void)load("instrument", text, {}, Needs::exposure), InputError);
    EXPECT_THROW((void)load("instrument", text, {}, Needs::stack), InputError);
}

TEST(Configuration, EveryKindOfSpecimenIsRead) {
    const auto start = small_configuration.find("kind = ");
    const auto end = small_configuration.find("[scan]");
    const std::map<std::string, std::string> kinds = {
        {"plane", "size_mm = 0.2\ntilt_y_deg = 3\n"},
        {"step", "size_mm = 0.2\nheight_um = 1\nwall_um = 2\n"},
        {"sphere", "size_mm = 0.2\nradius_um = 50\nheight_um = -3\n"},
        {"sinusoid", "size_mm = 0.2\namplitude_um = 1\nperiod_um = 30\nrepresentation = \"analytic\"\n"},
        {"chirp", "size_mm = 0.2\namplitude_um = 1\nperiod_um = 30\nperiod_stop_um = 10\n"},
        {"rough", "size_mm = 0.2\nsq_um = 1\ncorrelation_length_um = 5\nseed = 3\n"},
        {"image", "file = \"a.png\"\npitch_um = 1\nheight_um = 4\n"},
        {"stl", "file = \"a.stl\"\nunit = \"um\"\ncentre = false\n"},
        {"gltf", "file = \"a.glb\"\n"},
    };
    for (const auto& [kind, keys] : kinds) {
        const auto text = small_configuration.substr(0, start) + "kind = \"" + kind + "\"\n" + keys +
                          small_configuration.substr(end);
        const auto configuration = load("kind_" + kind, text);
        ASSERT_TRUE(configuration.specimen) << kind;
        EXPECT_EQ(load("kind_again", configuration.canonical).canonical, configuration.canonical) << kind;
    }
}

TEST(Configuration, MaterialsAreReadAndWrittenOut) {
    const auto with = [](const std::string& lines) {
        return replaced(small_configuration, "[specimen.material]\ng = 0.8\n", lines);
    };
    const auto reads_back = [](const Configuration& configuration) {
        const auto again = load("material_again", configuration.canonical);
        EXPECT_EQ(again.canonical, configuration.canonical);
        EXPECT_EQ(again.identity, configuration.identity);
    };
    const auto plain = load("material", with(""));
    ASSERT_EQ(plain.specimen->material.lobes.size(), 1u);
    EXPECT_EQ(plain.specimen->material.lobes[0].model, "henyey-greenstein");
    EXPECT_THAT(plain.specimen->material.lobes[0].parameters, testing::ElementsAre(0.0));
    EXPECT_EQ(plain.specimen->material.lobes[0].weight, 1);
    reads_back(plain);
    const auto grey = load("material", with("[specimen.material]\nscatter = \"lambertian\"\nreflectance = 0.8\n"));
    EXPECT_EQ(grey.specimen->material.lobes[0].model, "lambertian");
    EXPECT_EQ(grey.specimen->material.lobes[0].weight, 0.8);
    EXPECT_TRUE(grey.specimen->material.lobes[0].parameters.empty());
    reads_back(grey);
    const auto black = load("material", with("[specimen.material]\nreflectance = 0\n"));
    EXPECT_TRUE(black.specimen->material.lobes.empty());
    reads_back(black);
    const std::string two = "[[specimen.material.lobe]]\nscatter = \"henyey-greenstein\"\ng = 0.95\nweight = 0.3\n"
                            "[[specimen.material.lobe]]\nscatter = \"mirror\"\nweight = 0.5\n";
    const auto sum = load("material", with(two));
    ASSERT_EQ(sum.specimen->material.lobes.size(), 2u);
    EXPECT_THAT(sum.specimen->material.lobes[0].parameters, testing::ElementsAre(0.95));
    EXPECT_EQ(sum.specimen->material.lobes[0].weight, 0.3);
    EXPECT_EQ(sum.specimen->material.lobes[1].model, "mirror");
    EXPECT_EQ(sum.specimen->material.lobes[1].weight, 0.5);
    reads_back(sum);
    for (const auto& [from, to] : std::map<std::string, std::string>{
             {"g = 0.95", "g = 0.94"}, {"weight = 0.3", "weight = 0.31"}, {"\"mirror\"", "\"lambertian\""}}) {
        EXPECT_NE(load("material", with(replaced(two, from, to))).identity, sum.identity) << to;
    }
}

TEST(Configuration, GeometryDigestSeesOneBitOfOneHeight) {
    specimen::Specimen one;
    one.geometry = specimen::HeightField{Grid<float>(3, 3, 1.0f), 0, 0, 1, 1};
    auto other = one;
    EXPECT_EQ(geometry_digest(one), geometry_digest(other));
    auto& height = std::get<specimen::HeightField>(other.geometry).heights(1, 1);
    height = std::nextafter(height, 2.0f);
    EXPECT_NE(geometry_digest(one), geometry_digest(other));
}

} // namespace
} // namespace vkfv::app
