// [specimen.material] reads the scatter models that take more than numbers: a finish by its Sq, reflectance and index
// by wavelength, and tables of bsdfs.
#include "configuration/configuration.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <unistd.h>

#include <filesystem>
#include <fstream>
#include <string>

namespace vkfv {
namespace {

using testing::AllOf;
using testing::ElementsAre;
using testing::HasSubstr;

class ScatterKeys : public testing::Test {
  protected:
    void SetUp() override {
        folder_ = std::filesystem::temp_directory_path() / ("vkfv-scatter-keys-" + std::to_string(getpid()));
        std::filesystem::create_directories(folder_);
    }
    void TearDown() override { std::filesystem::remove_all(folder_); }

    void write(const std::string& name, const std::string& text) const { std::ofstream(folder_ / name) << text; }

    Configuration read(const std::string& material) const {
        return read_text("[source]\nradius_mm = 0.96\nwavelength_um = 0.5876\n"
                         "[objective]\nprescription = \"10x_0.28\"\n[tube_lens]\nprescription = \"200mm\"\n"
                         "[detector]\nsize_mm = 0.16\npixels = 8\n[specimen]\nkind = \"plane\"\nsize_mm = 0.2\n"
                         "[scan]\nz_start_um = -2\nz_stop_um = 2\nz_step_um = 1\n" +
                         material);
    }
    // Reads a configuration, whose canonical text must read back to the same, and gives its material.
    specimen::Material material(const std::string& text) const {
        const auto configuration = read(text);
        const auto again = read_text(configuration.canonical);
        EXPECT_EQ(again.canonical, configuration.canonical);
        EXPECT_EQ(again.identity, configuration.identity);
        EXPECT_EQ(again.specimen->material, configuration.specimen->material);
        return configuration.specimen->material;
    }
    std::string problem(const std::string& text) const {
        try {
            (void)read(text);
        } catch (const InputError& error) {
            return error.what();
        }
        return "";
    }

  private:
    Configuration read_text(const std::string& text) const {
        return read_configuration(TomlTable::parse(text, folder_ / "c.toml"));
    }
    std::filesystem::path folder_;
};

const std::string table = "[specimen.material]\nscatter = ";

TEST_F(ScatterKeys, AFinishIsALobeAndAMirror) {
    const auto finish = material(table + "\"harvey-shack\"\nshoulder = 0.02\nslope = -1.7\nsq_um = 0.02\n"
                                         "sq_wavelength_um = 0.5\nreflectance = 0.8\n");
    ASSERT_EQ(finish.lobes.size(), 2u);
    // The total integrated scatter of the finish is 1 - exp(-x) = 0.223270 with x = (4 pi 0.02 / 0.5)^2 = 0.252662.
    EXPECT_EQ(finish.lobes[0].model, "mirror");
    EXPECT_NEAR(finish.lobes[0].weight, 0.8 * (1 - 0.223270), 1e-6);
    EXPECT_EQ(finish.lobes[1].model, "harvey-shack");
    EXPECT_THAT(finish.lobes[1].parameters, ElementsAre(0.02, -1.7));
    EXPECT_NEAR(finish.lobes[1].weight, 0.8 * 0.223270, 1e-6);
    const auto alone = material(table + "\"abg\"\nabg_b = 0.01\nreflectance = 0.3\n");
    ASSERT_EQ(alone.lobes.size(), 1u);
    EXPECT_EQ(alone.lobes[0].weight, 0.3);
    EXPECT_THAT(alone.lobes[0].parameters, ElementsAre(0.01, 1.5));
    EXPECT_THAT(problem(table + "\"abg\"\nsq_um = 0.01\n"), HasSubstr("sq_um and sq_wavelength_um together"));
    EXPECT_THAT(problem(table + "\"ggx\"\nsq_um = 0.01\n"),
                HasSubstr("belongs to scatter = \"abg\" or \"harvey-shack\""));
    std::string three;
    for (int k = 0; k < 3; ++k) {
        three += "[[specimen.material.lobe]]\nscatter = \"abg\"\nweight = 0.2\nsq_um = 0.02\nsq_wavelength_um = 0.5\n";
    }
    EXPECT_THAT(problem(three), HasSubstr("one with sq_um is two"));
}

TEST_F(ScatterKeys, ReflectanceAndIndexAreFunctionsOfTheWavelength) {
    const auto by_keys = material(table + "\"ggx-conductor\"\nalpha = 0.2\nindex_wavelengths_um = [0.5, 0.6]\n"
                                          "refractive_indices = [0.9, 0.2]\nextinction_coefficients = [1.8, 3.2]\n"
                                          "reflectance_wavelengths_um = [0.4, 0.7]\nreflectances = [1, 0.5]\n");
    ASSERT_EQ(by_keys.lobes.size(), 1u);
    EXPECT_THAT(by_keys.lobes[0].parameters, ElementsAre(0.22, 3.05, 0.2));
    write("metal.csv", "wavelength_um,refractive_index,extinction_coefficient\n0.5,0.9,1.8\n0.6,0.2,3.2\n");
    write("colour.csv", "wavelength_um,reflectance\n0.4,1\n0.7,0.5\n");
    const auto by_files = material(table + "\"ggx-conductor\"\nalpha = 0.2\nindex_file = \"metal.csv\"\n"
                                           "reflectance_file = \"colour.csv\"\n");
    EXPECT_EQ(by_files, by_keys);
    const auto& lobe = by_keys.lobes[0];
    EXPECT_NEAR(lobe.refractive_index.at(0.55), 0.55, 1e-12);
    EXPECT_NEAR(lobe.extinction_coefficient.at(0.4), 1.8, 1e-12); // held
    EXPECT_NEAR(lobe.reflectance.at(0.5), 1 - 0.5 / 3, 1e-12);
    // A file counts by its content, not by its name.
    const std::string coloured = table + "\"lambertian\"\nreflectance_file = \"colour.csv\"\n";
    const auto before = read(coloured);
    write("colour.csv", "wavelength_um,reflectance\n0.4,1\n0.7,0.6\n");
    EXPECT_NE(read(coloured).identity, before.identity);
    EXPECT_EQ(read(coloured).canonical, before.canonical);

    write("colour.csv", "wavelength_um,reflectance\n0.4,1\n0.4,0.6\n");
    EXPECT_THAT(problem(coloured), AllOf(HasSubstr("colour.csv:3"), HasSubstr("wavelengths that ascend")));
    write("colour.csv", "wavelength_um,reflectance\n0.4,1.2\n");
    EXPECT_THAT(problem(coloured), AllOf(HasSubstr("colour.csv:2"), HasSubstr("reflectance = 1.2")));
    const std::string two = table + "\"lambertian\"\nreflectance_wavelengths_um = [0.4, 0.5]\n";
    EXPECT_THAT(problem(two + "reflectances = [0.5]\n"), HasSubstr("as many numbers as reflectance_wavelengths_um, 2"));
    EXPECT_THAT(problem(two + "reflectances = [0.5, 0.5]\nreflectance_file = \"colour.csv\"\n"), HasSubstr("not both"));
}

TEST_F(ScatterKeys, ATableIsReadFromItsFile) {
    const std::string lambertian = "incidence_deg,scatter_deg,bsdf_per_sr\n0,0,0.2\n0,80,0.2\n60,0,0.2\n60,80,0.2\n";
    write("bsdf.csv", lambertian);
    const std::string text = table + "\"tabulated\"\nfile = \"bsdf.csv\"\n";
    const auto read_back = material(text);
    ASSERT_EQ(read_back.lobes.size(), 1u);
    ASSERT_TRUE(read_back.lobes[0].bsdf);
    EXPECT_NEAR(read_back.lobes[0].bsdf->kept(1), 0.2 * 3.14159265, 1e-6);
    const auto before = read(text);
    write("bsdf.csv", "incidence_deg,scatter_deg,bsdf_per_sr\n0,0,0.2\n0,80,0.2\n60,0,0.21\n60,80,0.21\n");
    EXPECT_NE(read(text).identity, before.identity);
    // The deviation from reciprocity that is allowed changes no image.
    EXPECT_EQ(read(text + "reciprocity_limit = 0.5\n").identity, read(text).identity);
    EXPECT_THAT(problem(text + "reciprocity_limit = 0\n"), HasSubstr("a deviation from reciprocity"));
    EXPECT_THAT(problem(table + "\"tabulated\"\n"), HasSubstr("specimen.material.file"));
    EXPECT_THAT(problem(table + "\"tabulated\"\nfile = \"no.csv\"\n"), HasSubstr("no such file"));
    EXPECT_THAT(problem(table + "\"lambertian\"\nfile = \"bsdf.csv\"\n"),
                HasSubstr("belongs to scatter = \"tabulated\""));
}

} // namespace
} // namespace vkfv
