// Configurations are read in this process: their values, units, canonical text and identity.
#include "app/program.hpp"
#include "configuration/configuration.hpp"
#include "configuration/key_documents.hpp"
#include "measurement/scene/assembly.hpp"
#include "specimen/geometry_digest.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <map>
#include <set>
#include <tuple>

namespace vkfv::measurement {

using specimen::geometry_digest;
namespace {

using test::fresh_folder;
using test::replaced;
using test::small_configuration;
using test::write_file;
using testing::HasSubstr;

Configuration load(const std::string& name, const std::string& text, const std::vector<TomlOverride>& overrides = {},
                   Needs needs = Needs::stack) {
    const auto file = fresh_folder(name) / "c.toml";
    write_file(file, text);
    return load_configuration(file, overrides, needs);
}

TEST(Configuration, ConvertsUnitsOnceAtTheBorder) {
    const auto configuration = load("units", small_configuration);
    EXPECT_EQ(configuration.instrument.source.radius, 0.96);
    EXPECT_EQ(configuration.instrument.spectrum.reference_um, 0.5876);
    EXPECT_EQ(configuration.instrument.detector_pixels, ImageSize::square(8));
    EXPECT_EQ(std::get<specimen::Step>(configuration.specimen->shape).height, 0.002);
    EXPECT_EQ(configuration.specimen->roughness->noise, 0.0001);
    EXPECT_EQ(configuration.specimen->material.lobes[0].parameters[0], 0.8);
    EXPECT_EQ(configuration.scan->z_start, -0.002);
    EXPECT_EQ(configuration.scan->positions().size(), 5u);
    EXPECT_EQ(configuration.trace.rays, 2000u);
    EXPECT_EQ(configuration.instrument.directed_emission, true);
    EXPECT_EQ(configuration.trace.directed_scatter, false);
    const auto tilted = load(
        "tilt", replaced(replaced(small_configuration, "\"step\"", "\"plane\""), "height_um = 2.0", "tilt_x_deg = 45"));
    EXPECT_NEAR(std::tan(std::get<specimen::Plane>(tilted.specimen->shape).tilt_x), 1.0,
                1e-15); // one rounding of the angle
}

TEST(Configuration, PathsAreRelativeToTheFile) {
    const auto configuration = load("paths", small_configuration);
    EXPECT_EQ(configuration.output_directory, configuration.file.parent_path() / "out");
    const auto overridden = load("paths", small_configuration, {{"output.directory", "\"elsewhere\"", "--out"}});
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
    // Converted to mm and back, 0.1 um, 0.7 um and 1/3 would not be exact.
    const auto text = replaced(replaced(small_configuration, "z_step_um = 1.0", "z_step_um = 0.7"), "pitch_um = 1.0",
                               "pitch_um = 0.3333333333333333");
    const auto first = load("canonical", text);
    const auto second = load("canonical_again", first.canonical);
    EXPECT_EQ(first.canonical, second.canonical);
    EXPECT_EQ(first.identity, second.identity);
    EXPECT_EQ(first.scan->z_step, second.scan->z_step);
    // The canonical text is kept as stack.toml in the output folder; read from there, it continues the stack there.
    EXPECT_EQ(second.output_directory, second.file.parent_path());
    // Defaults are written out.
    EXPECT_THAT(first.canonical, HasSubstr("max_bounces = 2\n"));
    EXPECT_THAT(first.canonical, HasSubstr("distance_mm = 100.0\n"));
}

TEST(Configuration, IdentityHoldsWhatChangesImagesAndNothingElse) {
    const auto reference = load("identity", small_configuration).identity;
    const std::vector<TomlOverride> neutral = {
        {"trace.batch", "4096", ""},
        {"trace.traversal", "\"quadtree\"", ""},
        {"trace.device", "\"host\"", ""},
        {"output.directory", "\"other\"", ""},
        {"output.surfaces", "[\"sur\"]", ""},
        {"topography.focus_measure", "\"brenner\"", ""},
        {"topography.window_px", "5", ""},
        {"topography.window_shape", "\"gaussian\"", ""},
        {"topography.smoothing_steps", "1.5", ""},
        {"topography.false_peak_rate", "0.01", ""},
        {"topography.peak", "\"parabola\"", ""},
        {"topography.peak_range_steps", "2", ""},
        {"topography.least_contrast", "3", ""},
        {"topography.most_fit_residual", "0.5", ""},
        {"topography.most_peaks", "2", ""},
        {"topography.place_by_texture", "false", ""},
        {"topography.repair_outliers", "true", ""},
        {"topography.evaluate_on", "\"host\"", ""},
        {"topography.flatness_file", "\"flat.tif\"", ""},
        {"topography.s_filter_um", "5", ""},
        {"topography.l_filter_um", "80", ""},
        {"topography.filter", "\"spline\"", ""},
    };
    for (const auto& change : neutral) {
        EXPECT_EQ(load("identity", small_configuration, {change}).identity, reference) << change.key;
    }
    // A blur comes after the trace and changes no identity; waves do.
    const auto of_rays = load("identity", small_configuration, {{"diffraction.model", "\"none\"", ""}}).identity;
    EXPECT_NE(of_rays, reference);
    EXPECT_EQ(load("identity", small_configuration, {{"diffraction.model", "\"airy\"", ""}}).identity, of_rays);
    EXPECT_EQ(load("identity", small_configuration, {{"diffraction.point_spread", "\"airy\"", ""}}).identity, of_rays);
    const std::vector<TomlOverride> influential = {
        {"diffraction.cells", "6", ""},
        {"diffraction.parts_per_pixel", "1", ""},
        {"trace.rays", "2001", ""},
        {"trace.seed", "2", ""},
        {"trace.max_bounces", "3", ""},
        {"trace.emission", "\"analog\"", ""},
        {"trace.scattering", "\"directed\"", ""},
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

// A preset read out with fewer bits ends at the same charge.
TEST(Configuration, PresetsOfOtherBitsKeepTheirRange) {
    const auto text = replaced(small_configuration, "[output]\n", "[camera]\npreset = \"IMX900\"\n[output]\n");
    EXPECT_DOUBLE_EQ(load("bits", text).camera->gain, 0.399);
    const auto eight = load("bits", text, {{"camera.bit_depth", "8", ""}}).camera.value();
    EXPECT_DOUBLE_EQ(eight.gain, 0.399 / 16);
    EXPECT_DOUBLE_EQ(eight.offset, 60.0 / 16);
    const auto own = load("bits", text, {{"camera.bit_depth", "8", ""}, {"camera.gain_dn_per_e", "0.02", ""}}).camera;
    EXPECT_DOUBLE_EQ(own->gain, 0.02);
}

// The time in which a vibration blurs is the camera's, unless the stage has one of its own.
TEST(Configuration, TheCamerasTimeIsTheStages) {
    const auto text =
        replaced(small_configuration, "[output]\n",
                 "[camera]\npreset = \"IMX900\"\nexposure = \"time\"\nexposure_ms = 5\n[stage]\n[output]\n");
    EXPECT_DOUBLE_EQ(load("time", text).stage->exposure_time, 0.005);
    EXPECT_DOUBLE_EQ(load("time", text, {{"stage.exposure_s", "0.02", ""}}).stage->exposure_time, 0.02);
    const auto by_the_stack =
        replaced(small_configuration, "[output]\n", "[camera]\npreset = \"IMX900\"\n[stage]\n[output]\n");
    EXPECT_DOUBLE_EQ(load("stack", by_the_stack).stage->exposure_time, 0);
}

// Another value of any key of [stage] and [camera] makes other images, except for keys that are declared to influence
// none.
TEST(Configuration, IdentityHoldsWhatStageAndCameraDoToImages) {
    const auto stage =
        replaced(small_configuration, "[output]\n",
                 "[stage]\nlinearity_at_um = [0, 1]\nlinearity_um = [0, 0]\nvibration_um = [0.1]\n"
                 "vibration_hz = [203]\nvibration_spectrum_hz = [10, 20]\nvibration_spectrum_um2_per_hz = [1, 1]\n"
                 "lateral_drift_um_per_s = [0, 0]\ntilt_deg = [0, 0]\n[output]\n");
    const auto camera =
        replaced(small_configuration, "[output]\n", "[camera]\npreset = \"IMX900\"\nfull_well_e = 9000\n[output]\n");
    const auto timed = replaced(small_configuration, "[output]\n",
                                "[camera]\npreset = \"IMX900\"\nexposure = \"time\"\nexposure_ms = 1\n[output]\n");
    const auto curve = replaced(small_configuration, "[output]\n",
                                "[camera]\npreset = \"IMX900\"\nefficiency_wavelengths_um = [0.4, 0.7]\n"
                                "quantum_efficiencies = [0.5, 0.6]\n[output]\n");
    const std::vector<std::tuple<std::string, std::string, std::string>> changes = {
        {stage, "stage.scale_error", "0.01"},
        {stage, "stage.linearity_at_um", "[0, 2]"},
        {stage, "stage.linearity_um", "[0, 0.1]"},
        {stage, "stage.periodic_um", "0.1"},
        {stage, "stage.period_um", "21"},
        {stage, "stage.phase_deg", "10"},
        {stage, "stage.jitter_um", "0.1"},
        {stage, "stage.backlash_um", "0.1"},
        {stage, "stage.drift_um_per_s", "0.1"},
        {stage, "stage.vibration_um", "[0.2]"},
        {stage, "stage.vibration_hz", "[204]"},
        {stage, "stage.vibration_spectrum_hz", "[10, 21]"},
        {stage, "stage.vibration_spectrum_um2_per_hz", "[1, 2]"},
        {stage, "stage.lateral_drift_um_per_s", "[0, 1]"},
        {stage, "stage.tilt_deg", "[0, 1]"},
        {stage, "stage.runout_um", "1"},
        {stage, "stage.runout_period_um", "400"},
        {stage, "stage.light_noise", "0.01"},
        {stage, "stage.direction", "\"down\""},
        {stage, "stage.interval_s", "0.2"},
        {stage, "stage.exposure_s", "0.01"},
        {stage, "stage.moments", "9"},
        {stage, "stage.seed", "2"},
        {stage, "stage.reading_noise_um", "0.1"},
        {stage, "stage.evaluate", "\"read\""},
        {camera, "camera.preset", "\"IMX250\""},
        {camera, "camera.quantum_efficiency", "0.5"},
        {camera, "camera.full_well_e", "9001"},
        {camera, "camera.read_noise_e", "6"},
        {camera, "camera.dark_current_e_per_s", "1"},
        {camera, "camera.gain_dn_per_e", "0.3"},
        {camera, "camera.offset_dn", "61"},
        {camera, "camera.bit_depth", "11"},
        {camera, "camera.dsnu_e", "3"},
        {camera, "camera.prnu_percent", "0.8"},
        {camera, "camera.exposure", "\"first\""},
        {camera, "camera.saturation", "0.7"},
        {camera, "camera.frames", "2"},
        {camera, "camera.seed", "2"},
        {camera, "camera.noise_seed", "2"},
        {timed, "camera.exposure_ms", "2"},
        {curve, "camera.efficiency_wavelengths_um", "[0.4, 0.8]"},
        {curve, "camera.quantum_efficiencies", "[0.5, 0.7]"},
    };
    std::map<std::string, std::string> references; // identities
    std::set<std::string> tried;
    for (const auto& [text, key, value] : changes) {
        auto& reference = references[text];
        if (reference.empty()) {
            reference = load("identity", text).identity;
        }
        const bool influences = key != "stage.reading_noise_um" && key != "stage.evaluate";
        EXPECT_EQ(load("identity", text, {{key, value, ""}}).identity != reference, influences) << key;
        tried.insert(key);
    }
    for (const KeyTable* table : key_tables()) { // a new key has its line above
        if (table->path == "stage" || table->path == "camera") {
            for (const Key* key : table->keys) {
                EXPECT_TRUE(tried.contains(table->path + "." + key->name)) << table->path << "." << key->name;
            }
        }
    }
}

TEST(Configuration, TopographyIsWrittenInTheFormatsAskedFor) {
    EXPECT_THAT(load("surfaces", small_configuration).topography_files,
                testing::ElementsAre("topography.tif", "topography.x3p"));
    const auto load_with = [](const std::string& value) {
        return load("surfaces", small_configuration, {{"output.surfaces", value, ""}});
    };
    const auto all = load_with("[\"ply\", \"sdf\", \"sur\"]");
    EXPECT_THAT(all.topography_files, testing::ElementsAre("topography.ply", "topography.sdf", "topography.sur"));
    EXPECT_EQ(load("surfaces_again", all.canonical).topography_files, all.topography_files);
    EXPECT_THROW((void)load_with("[\"stl\"]"), InputError);
    EXPECT_THROW((void)load_with("\"x3p\""), InputError);
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
                          (std::filesystem::absolute(reference.file.parent_path()) / "a.agf").string() + "\"]\n"));
    EXPECT_EQ(load("catalogue_again", reference.canonical).canonical, reference.canonical);
    EXPECT_EQ(load_with("b.agf", glass + "NM OTHER 5\nCD 1.5\nLD 0.4 0.7\n").identity, reference.identity);
    EXPECT_NE(load_with("a.agf", "NM MINE 5\nCD 1.6226\nLD 0.4 0.7\n").identity, reference.identity);
    EXPECT_THROW(load_with("a.agf", "NM YOURS 5\nCD 1.6225\nLD 0.4 0.7\n"), InputError);
}

// The description that `to` in place of `from` makes; the canonical text reads back to itself.
optics::InstrumentDescription described(const std::string& from, const std::string& to) {
    const auto configuration = load("described", replaced(small_configuration, from, to));
    const auto again = load("described_again", configuration.canonical);
    EXPECT_EQ(again.canonical, configuration.canonical) << to;
    EXPECT_EQ(again.identity, configuration.identity) << to;
    EXPECT_NE(configuration.identity, load("described", small_configuration).identity) << to;
    return configuration.instrument;
}

const std::string wavelength_line = "wavelength_um = 0.5876\n";
const std::string disc_lines = "radius_mm = 0.96\nflux_W = 1.0\nwavelength_um = 0.5876\n\n[illumination]\n"
                               "prescription = \"koehler\"\nfield_stop_radius_mm = 0.2\n";

TEST(Configuration, SeveralSourcesAreRead) {
    const std::string rings = "[[source]]\nkind = \"ring\"\nflux_W = 2\ndistance_mm = 12\nelevation_deg = 30\n"
                              "width_mm = 2\nwavelength_um = 0.5876\n";
    const std::string disc = "[[source]]\nkind = \"rectangle\"\nwidth_mm = 1.5\nheight_mm = 1\nflux_W = 3\n";
    // The order in the file decides nothing but the names: what stands behind the illuminator is the first.
    const auto one = described("[source]\nradius_mm = 0.96\nflux_W = 1.0\nwavelength_um = 0.5876\n",
                               rings + disc + "wavelength_um = 0.5876\n");
    EXPECT_EQ(one.source.key, "source[1]");
    EXPECT_EQ(one.source.flux, 3);
    ASSERT_TRUE(one.source.rectangle);
    EXPECT_EQ(*one.source.rectangle, glm::dvec2(1.5, 1));
    EXPECT_EQ(one.source.inner_radius(), 0.5);
    EXPECT_NEAR(one.source.outer_radius(), std::hypot(0.75, 0.5), 1e-15);
    ASSERT_EQ(one.further_sources.size(), 1u);
    EXPECT_EQ(one.further_sources[0].key, "source[0]");
    EXPECT_EQ(one.further_sources[0].flux, 2);
    EXPECT_EQ(one.further_sources[0].ring->distance, 12);
    EXPECT_FALSE(one.source.spectrum); // all the same
    EXPECT_TRUE(one.spectrum.monochromatic());
    const auto coloured = described("[source]\nradius_mm = 0.96\nflux_W = 1.0\nwavelength_um = 0.5876\n",
                                    rings + disc +
                                        "[source.spectrum]\nkind = \"gaussian\"\ncentre_um = 0.52\n"
                                        "full_width_um = 0.02\n");
    ASSERT_TRUE(coloured.source.spectrum);
    ASSERT_TRUE(coloured.further_sources[0].spectrum);
    EXPECT_EQ(coloured.source.spectrum->reference_um, 0.52);
    EXPECT_EQ(coloured.further_sources[0].spectrum->reference_um, 0.5876);
    EXPECT_NEAR(coloured.spectrum.reference_um, (3 * 0.52 + 2 * 0.5876) / 5, 1e-12);
}

// An override changes one of several sources by its number.
TEST(Configuration, OverridesReachOneOfSeveralSources) {
    const auto folder = fresh_folder("overridden_sources");
    write_file(folder / "c.toml", replaced(small_configuration, "[source]\n", "[[source]]\n"));
    const auto configuration =
        load_configuration(folder / "c.toml", {{"source.0.flux_W", "2.5", "--set"}, {"trace.seed", "4", "--set"}});
    EXPECT_EQ(configuration.instrument.source.flux, 2.5);
    EXPECT_EQ(configuration.instrument.source.radius, 0.96);
}

TEST(Configuration, RingLightsAreRead) {
    const std::string keys = "kind = \"ring\"\ndistance_mm = 12\nelevation_deg = 30\nwidth_mm = 2\n";
    const auto plain = described(disc_lines, keys);
    ASSERT_TRUE(plain.source.ring);
    EXPECT_EQ(plain.source.ring->distance, 12);
    EXPECT_NEAR(std::sin(plain.source.ring->elevation), 0.5, 1e-15); // one rounding of the angle
    EXPECT_EQ(plain.source.ring->width, 2);
    EXPECT_EQ(plain.source.ring->segments, 1);
    EXPECT_EQ(plain.source.ring->fill, 1);
    EXPECT_EQ(plain.source.ring->on, std::vector<bool>{true});
    EXPECT_FALSE(plain.source.ring->lit_radius);
    EXPECT_FALSE(plain.source.distance);
    EXPECT_TRUE(plain.illumination.surfaces.empty());
    const auto switched = described(disc_lines, keys + "segments = 3\nfill = 0.8\non = [true, false, true]\n");
    EXPECT_EQ(switched.source.ring->segments, 3);
    EXPECT_EQ(switched.source.ring->fill, 0.8);
    EXPECT_EQ(switched.source.ring->on, (std::vector<bool>{true, false, true}));
    EXPECT_EQ(described(disc_lines, keys + "segments = 4\n").source.ring->on, std::vector<bool>(4, true));
    EXPECT_EQ(
        described(disc_lines + "\n[beam_splitter]\nreflectance = 0.5", keys + "[beam_splitter]\nreflectance = 0\n")
            .splitter.transmittance,
        1);
}

// Every point of the specimen must be lit, whatever its size and wherever it stands: the aim is the cone about the
// band's normal that holds the ball through the footprint's farthest corner at its farthest height.
TEST(Configuration, RingLightsAimAtTheWholeSpecimen) {
    const auto configuration =
        load("aim", replaced(small_configuration, disc_lines,
                             "kind = \"ring\"\ndistance_mm = 12\nelevation_deg = 30\nwidth_mm = 2\n"));
    specimen::Specimen specimen;
    specimen.geometry = specimen::HeightField{Grid<float>(3, 3, 0.0f), -1, -1, 1.5, 2.5}; // to x = 2 and y = 4
    const std::vector<double> heights = {0};
    const double lit = std::hypot(2.0, 4.0);
    const double reach = lit + 1; // half the width of the band is added
    // The surface is flat: the 1e-9 leave room for the rounding alone that the specimen's top is raised by.
    EXPECT_NEAR(assemble_instrument(configuration, specimen, heights).constants.emission_sine,
                reach / std::hypot(reach, 12 - lit), 1e-9);
    // A focal height of 1 mm widens the aim.
    const std::vector<double> raised = {1.0};
    EXPECT_GT(assemble_instrument(configuration, specimen, raised).constants.emission_sine,
              reach / std::hypot(reach, 12 - lit) + 1e-3);
    // Without a specimen the aim holds the detector's field, with half of it more around, and 0.2 mm above and below
    // the focus.
    const auto alone = assemble_instrument(configuration);
    const double field = std::hypot(1.5 * std::sqrt(0.5) * 0.16 / std::abs(alone.first_order.magnification), 0.2);
    EXPECT_NEAR(alone.constants.emission_sine, (field + 1) / std::hypot(field + 1, 12 - field), 1e-15);
}

TEST(Configuration, SpectraAreRead) {
    const auto spectrum = [](const std::string& lines) {
        return described(wavelength_line, "[source.spectrum]\n" + lines).spectrum;
    };
    EXPECT_EQ(spectrum("kind = \"monochromatic\"\nwavelength_um = 0.55\n").reference_um, 0.55);
    const auto lines = spectrum("kind = \"lines\"\nwavelengths_um = [0.5, 0.6]\nweights = [3, 1]\n");
    ASSERT_EQ(lines.bins.size(), 2u);
    EXPECT_EQ(lines.bins[0].cumulative, 0.75);
    EXPECT_EQ(lines.shortest_um, 0.5);
    EXPECT_EQ(lines.longest_um, 0.6);
    const auto led = spectrum("kind = \"gaussian\"\ncentre_um = 0.55\nfull_width_um = 0.03\n");
    EXPECT_EQ(led.reference_um, 0.55);
    EXPECT_NEAR(led.longest_um, 0.55 + 4 * 0.03 / std::sqrt(8 * std::log(2)), 1e-15); // four standard deviations
    const auto table = spectrum("kind = \"table\"\nwavelengths_um = [0.5, 0.52]\ndensities = [1, 1]\n");
    EXPECT_EQ(table.bins.size(), 1u);
    EXPECT_NEAR(table.reference_um, 0.51, 1e-15);
}

TEST(Configuration, ASpectrumsFileCountsByItsContent) {
    const auto text =
        replaced(small_configuration, wavelength_line, "[source.spectrum]\nkind = \"table\"\nfile = \"led.csv\"\n");
    const auto load_with = [&](const std::string& points) {
        const auto folder = fresh_folder("spectrum_file");
        write_file(folder / "led.csv", "wavelength_um,density\n" + points);
        write_file(folder / "c.toml", text);
        return load_configuration(folder / "c.toml");
    };
    const auto reference = load_with("0.50,1\n0.52,3\n");
    const auto& spectrum = reference.instrument.spectrum;
    EXPECT_EQ(spectrum.shortest_um, 0.5);
    EXPECT_NEAR(spectrum.reference_um, 0.5 + 0.02 * 7 / 12, 1e-15); // centroid of a trapezium of 1 and 3
    EXPECT_EQ(load("spectrum_again", reference.canonical).canonical, reference.canonical);
    EXPECT_EQ(load_with("0.5, 1.0\r\n0.52,3\n").identity, reference.identity);
    EXPECT_NE(load_with("0.5,1\n0.52,3.1\n").identity, reference.identity);
}

TEST(Configuration, SplittersAndFoldMirrorsAreRead) {
    using Kind = optics::BeamSplitter::Kind;
    using Path = optics::FoldMirror::Path;
    const std::string given = "reflectance = 0.5\n";
    const auto ideal = described(given, "reflectance = 0.3\ntransmittance = 0.6\ndistance_mm = 40\n").splitter;
    EXPECT_EQ(ideal.kind, Kind::ideal);
    EXPECT_EQ(ideal.reflectance, 0.3);
    EXPECT_EQ(ideal.transmittance, 0.6);
    EXPECT_EQ(ideal.distance, 40);
    EXPECT_EQ(described(given, "reflectance = 0.3\n").splitter.transmittance, 0.7);
    const auto plate = described(given, "kind = \"plate\"\nthickness_mm = 2\nglass = \"F2\"\n").splitter;
    EXPECT_EQ(plate.kind, Kind::plate);
    EXPECT_EQ(plate.size, 2);
    EXPECT_EQ(plate.glass.name, "F2");
    EXPECT_FALSE(plate.semi_diameter);
    const auto cube = described(given, "kind = \"cube\"\nedge_mm = 25\nsemi_diameter_mm = 12\n").splitter;
    EXPECT_EQ(cube.kind, Kind::cube);
    EXPECT_EQ(cube.size, 25);
    EXPECT_EQ(cube.glass.name, "N-BK7");
    EXPECT_EQ(cube.semi_diameter, 12);
    const auto folds = described("[objective]\n", "[[fold_mirror]]\npath = \"imaging\"\ndistance_mm = 80\n"
                                                  "semi_diameter_mm = 20\n[[fold_mirror]]\n"
                                                  "path = \"illumination\"\ndistance_mm = 30\n"
                                                  "semi_diameter_mm = 15\nincidence_deg = 30\n"
                                                  "azimuth_deg = -90\nreflectance = 0.9\n[objective]\n")
                           .fold_mirrors;
    ASSERT_EQ(folds.size(), 2u);
    EXPECT_EQ(folds[0].path, Path::imaging);
    EXPECT_EQ(folds[0].distance, 80);
    EXPECT_NEAR(std::tan(folds[0].incidence), 1, 1e-15);
    EXPECT_EQ(folds[0].azimuth, 0);
    EXPECT_EQ(folds[0].reflectance, 1);
    EXPECT_EQ(folds[1].path, Path::illumination);
    EXPECT_NEAR(std::sin(folds[1].incidence), 0.5, 1e-15);
    EXPECT_NEAR(std::sin(folds[1].azimuth), -1, 1e-15);
    EXPECT_EQ(folds[1].semi_diameter, 15);
    EXPECT_EQ(folds[1].reflectance, 0.9);
}

TEST(Configuration, InterfacesAndMediaAreRead) {
    using Model = optics::Interfaces::Model;
    const auto with = [](const std::string& tables) { return described("[objective]\n", tables + "[objective]\n"); };
    EXPECT_EQ(with("[interfaces]\nmodel = \"fresnel\"\n").interfaces.model, Model::fresnel);
    const auto coated =
        with("[interfaces]\nmodel = \"quarter-wave\"\nlayer = \"CaF2\"\ndesign_wavelength_um = 0.6\n").interfaces;
    EXPECT_EQ(coated.model, Model::quarter_wave);
    EXPECT_EQ(coated.layer.name, optics::GlassCatalog::builtin().get("CaF2").name);
    EXPECT_EQ(coated.design_wavelength_um, 0.6);
    EXPECT_EQ(with("[interfaces]\nmodel = \"quarter-wave\"\n").interfaces.layer.name,
              optics::GlassCatalog::builtin().get("MgF2").name);
    const auto covered = with("[cover_glass]\nthickness_mm = 0.17\n").cover_glass;
    ASSERT_TRUE(covered);
    EXPECT_EQ(covered->thickness, 0.17);
    EXPECT_EQ(covered->glass.name, "N-BK7");
    EXPECT_FALSE(covered->distance);
    EXPECT_EQ(
        with("[cover_glass]\nthickness_mm = 0.1\nglass = \"fused silica\"\ndistance_mm = 1\n").cover_glass->distance,
        1);
}

TEST(Configuration, LensesStopsAndPlacementsAreRead) {
    const auto ideal = described("prescription = \"10x_0.28\"", "kind = \"ideal\"\nfocal_length_mm = 8\n"
                                                                "numerical_aperture = 1.2\nimmersion = \"water\"\n");
    ASSERT_EQ(ideal.objective.surfaces.size(), 2u);
    EXPECT_EQ(ideal.objective.surfaces[0].ideal_power, 0.125);
    EXPECT_EQ(ideal.objective.surfaces[0].thickness, 8);
    EXPECT_EQ(ideal.objective.surfaces[1].semi_diameter, 8 * 1.2);
    EXPECT_EQ(ideal.objective.surfaces[1].role, optics::PrescribedSurface::Role::aperture_stop);
    ASSERT_TRUE(ideal.immersion);
    EXPECT_NEAR(ideal.immersion->index(0.5876), 1.333, 1e-3); // water's, to the digits that need no temperature
    // By Abbe's sine condition the cone is the one asked for.
    EXPECT_NEAR(optics::assemble(ideal).first_order.numerical_aperture, 1.2, 1e-3);
    const auto tube_lens = described("prescription = \"200mm\"", "kind = \"ideal\"\nfocal_length_mm = 160\n");
    ASSERT_EQ(tube_lens.tube_lens.surfaces.size(), 1u);
    EXPECT_NEAR(optics::assemble(tube_lens).first_order.efl_tube_lens, 160, 1e-12);
    EXPECT_EQ(described("field_stop_radius_mm = 0.2", "aperture_radius_mm = 0.5\nobjective_distance_mm = 130")
                  .illumination_aperture_radius,
              0.5);
    const auto stopped = described("\"10x_0.28\"", "\"10x_0.28\"\naperture_stop_radius_mm = 2");
    EXPECT_EQ(stopped.aperture_stop_radius, 2);
    const std::string keys = "\ndecentre_x_mm = 0.1\ndecentre_y_mm = -0.2\ntilt_x_deg = 30\ntilt_y_deg = -30\n"
                             "tilt_z_deg = 90\ntilt_first = true\n";
    const auto expect_placement = [](const optics::Placement& placement) {
        EXPECT_EQ(placement.change.decentre_x, 0.1);
        EXPECT_EQ(placement.change.decentre_y, -0.2);
        EXPECT_NEAR(std::sin(placement.change.tilt_x), 0.5, 1e-15);
        EXPECT_NEAR(std::sin(placement.change.tilt_y), -0.5, 1e-15);
        EXPECT_NEAR(std::sin(placement.change.tilt_z), 1, 1e-15);
        EXPECT_TRUE(placement.change.tilt_first);
        EXPECT_FALSE(placement.global);
    };
    expect_placement(described("\"10x_0.28\"", "\"10x_0.28\"" + keys).objective_placement);
    expect_placement(described("\"200mm\"", "\"200mm\"" + keys).tube_lens_placement);
    expect_placement(described("pixels = 8", "pixels = 8" + keys).detector_placement);
    const auto global = described("pixels = 8", "pixels = 8\nglobal_mm = [1, -2, 333.25]").detector_placement.global;
    ASSERT_TRUE(global);
    EXPECT_EQ(*global, glm::dvec3(1, -2, 333.25));
}

TEST(Configuration, IdentityFollowsTheContentOfAGlassByName) {
    const auto text = replaced(small_configuration, "[objective]\n",
                               "[cover_glass]\nthickness_mm = 0.17\nglass = \"mine\"\n[objective]\n");
    const auto load_with = [&](const std::string& index) {
        const auto folder = fresh_folder("glass_by_name");
        write_file(folder / "a.agf", "NM MINE 5\nCD " + index + "\nLD 0.4 0.7\n");
        write_file(folder / "c.toml", "glass_catalogs = [\"a.agf\"]\n" + text);
        return load_configuration(folder / "c.toml").identity;
    };
    EXPECT_EQ(load_with("1.5"), load_with("1.5"));
    EXPECT_NE(load_with("1.5"), load_with("1.6"));
}

TEST(Configuration, ParsedTextIsReadLikeAFile) {
    const auto folder = fresh_folder("parsed");
    write_file(folder / "c.toml", small_configuration);
    const auto parsed = read_configuration(TomlTable::parse(small_configuration, folder / "c.toml"));
    EXPECT_EQ(parsed.canonical, load_configuration(folder / "c.toml").canonical);
    EXPECT_EQ(parsed.output_directory, folder / "out");
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
        {"surface", "file = \"a.tif\"\npitch_um = 2\nunit = \"um\"\nsize_mm = 0.1\nlevel = false\n"},
        {"stl", "file = \"a.stl\"\nunit = \"um\"\ncentre = false\n"},
        {"gltf", "file = \"a.glb\"\n"},
        {"points", "file = \"a.xyz\"\nunit = \"mm\"\nheight_unit = \"um\"\nlongest_edge_um = 5\n"},
    };
    for (const auto& [kind, keys] : kinds) {
        const auto text =
            small_configuration.substr(0, start) + "kind = \"" + kind + "\"\n" + keys + small_configuration.substr(end);
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

// A path that begins with assets/ and is not in the working directory names a file that came with the program; its
// results still go where they are asked for.
TEST(Configuration, ResultsOfAnInstalledExampleGoWhereTheyAreAskedFor) {
    const auto before = std::filesystem::current_path();
    const auto folder = fresh_folder("installed_example");
    std::filesystem::current_path(folder);
    const auto place = [](const std::vector<TomlOverride>& overrides) {
        return load_configuration("assets/stacks/demo.toml", overrides).output_directory;
    };
    const auto usual = place({});
    const auto named = place({{"output.directory", "\"demo\"", "--out"}});
    const auto elsewhere = place({{"output.directory", "\"/tmp/demo\"", "--out"}});
    std::filesystem::current_path(before);
    EXPECT_EQ(usual, "demo-out"); // the example's value, relative to this folder
    EXPECT_EQ(named, "demo");     // not empty: such a folder could not be made
    EXPECT_EQ(elsewhere, "/tmp/demo");
}

} // namespace
} // namespace vkfv::measurement
