#include "optics/prescriptions/prescription.hpp"

#include "core/files/assets.hpp"
#include "core/messages/error.hpp"
#include "optics/media/agf.hpp"
#include "optics/train/first_order.hpp"
#include "parts.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <cstdlib>
#include <cstring>
#include <fstream>

namespace vkfv::optics {
namespace {

using ::testing::HasSubstr;

std::vector<PlacedSurface> placed(const Prescription& lens) {
    Pose end;
    return place_prescription(lens, Spectrum::line(test::d_line_um), {}, {}, end);
}

// Surfaces and their frames come back to the bit.
TEST(Prescription, ReversedTwiceIsItself) {
    const auto lens = placed(test::microscope().illumination);
    const auto once = reversed(lens);
    const auto twice = reversed(once);
    ASSERT_EQ(twice.size(), lens.size());
    for (std::size_t i = 0; i < lens.size(); ++i) {
        EXPECT_EQ(std::memcmp(&lens[i].surface, &twice[i].surface, sizeof lens[i].surface), 0) << i;
        EXPECT_EQ(lens[i].pose.origin, twice[i].pose.origin);
        EXPECT_EQ(lens[i].pose.axes, twice[i].pose.axes);
        EXPECT_EQ(lens[i].name, twice[i].name);
        EXPECT_EQ(lens[i].surface.curvature, -once[lens.size() - 1 - i].surface.curvature);
        EXPECT_EQ(lens[i].surface.index_before, once[lens.size() - 1 - i].surface.index_after);
    }
}

std::vector<physics::f64::Surface> surfaces_of(const Prescription& lens) {
    std::vector<physics::f64::Surface> train;
    double index = lens.medium_before.index(test::d_line_um);
    double distance = 0;
    for (const auto& prescribed : lens.surfaces) {
        auto surface = test::surface(prescribed.curvature, distance, index,
                                     prescribed.medium_after.index(test::d_line_um), prescribed.conic);
        surface.a4 = prescribed.aspheric[0];
        surface.flags = surface.a4 != 0 ? physics::f64::SURFACE_ASPHERIC : 0u;
        train.push_back(surface);
        index = surface.index_after;
        distance = prescribed.thickness;
    }
    return train;
}

// The truth is the focal lengths at the d line, as two other programs print them (nine decimals).
TEST(Prescription, AssetsHaveTheirFocalLengths) {
    struct Row {
        const char* folder;
        const char* name;
        double efl;
        double bfd;
    };
    // The bfd of an objective is on the side of the specimen: the front focal distance in imaging order.
    for (const Row& row : {Row{"objectives", "5x_0.15", 39.999999808, 65.90129633},
                           {"objectives", "10x_0.28", 20.000007181, 16.144167633},
                           {"objectives", "20x_0.41", 10.000000444, 7.383296607},
                           {"objectives", "50x_0.66", 4.000000381, 3.368174177},
                           {"objectives", "100x_0.83", 2.000000281, 0.719523246},
                           {"tube_lenses", "200mm", 199.985758388, 168.442195294},
                           {"tube_lenses", "180mm", 180.000154058, 157.042910143},
                           {"tube_lenses", "200mm_kurata", 199.998528216, 71.579623418},
                           {"tube_lenses", "200mm_achromat", 199.817607117, 193.741076841},
                           {"illuminators", "condenser_acl2520", 20.003059273, 12.123873456},
                           {"illuminators", "condenser_acl3026u", 25.910325048, 18.096799112}}) {
        const auto lens = load_prescription(row.name, row.folder, test::source_folder());
        EXPECT_FALSE(lens.title.empty() || lens.source.empty() || lens.licence.empty()) << row.name;
        const auto transfer = transfer_of_train(surfaces_of(lens));
        const bool tube = std::string(row.folder) == "tube_lenses";
        EXPECT_NEAR(focal_length(transfer), row.efl, 1e-9) << row.name;
        EXPECT_NEAR(tube ? back_focal_distance(transfer) : front_focal_distance(transfer), row.bfd, 1e-9) << row.name;
        EXPECT_LT(std::abs(lens.source_distance.value_or(row.bfd) - row.bfd), 1e-9) << row.name;
    }
}

// Rays of two other programs (double precision) are the truth for conic and asphere.
TEST(Prescription, CondenserAgreesWithReferenceRays) {
    const auto folder = test::source_folder() / "tests" / "data" / "rays";
    const auto in = test::read_rows(folder / "condenser_acl2520.in.csv");
    const auto out = test::read_rows(folder / "condenser_acl2520.out.csv");
    ASSERT_EQ(in.size(), out.size());
    ASSERT_GE(in.size(), 500u);
    // The condenser is passed backward: collimated light comes in, the source's plane is the focal plane.
    auto part = reversed(placed(load_prescription("condenser_acl2520", "illuminators", test::source_folder())));
    link(part, part.front().pose);
    auto train = surfaces_of(part);
    const auto worst_with = [&](const std::vector<physics::f64::Surface>& lens) {
        double worst = 0;
        for (std::size_t i = 0; i < in.size(); ++i) {
            const auto result = test::trace(lens, {in[i][0], in[i][1], in[i][2]}, {in[i][3], in[i][4], in[i][5]});
            const auto focal = physics::f64::fly_to_plane(result.ray, 12.123873456, 1.0);
            worst = std::max({worst, std::abs(focal.position.x - out[i][0]), std::abs(focal.position.y - out[i][1]),
                              std::abs(focal.direction.x - out[i][3]), std::abs(focal.direction.y - out[i][4]),
                              std::abs(focal.direction.z - out[i][5])});
        }
        return worst;
    };
    // The plane is given to 1e-9 mm, and slopes reach 0.6.
    EXPECT_LT(worst_with(train), 1e-9);
    train.front().a4 = -train.front().a4;
    EXPECT_GT(worst_with(train), 1e-3);
}

// Collimated light in glass meets a hyperboloid of k = -n^2 and comes to one point (Fermat's principle).
TEST(Prescription, HyperboloidFocusesPerfectly) {
    const double n = 1.5168;
    const double radius = -20;
    const auto worst_with = [&](double conic) {
        const std::vector train = {test::surface(0, 0, 1, n), test::surface(1 / radius, 15, n, 1, conic)};
        const double focus = -radius / (n - 1);
        double worst = 0;
        for (double height = 0.5; height <= 12; height += 0.5) {
            const auto result = test::trace(train, {height, 0, -5}, {0, 0, 1});
            EXPECT_EQ(result.status, physics::f64::PATH_ALIVE);
            worst = std::max(worst, std::abs(physics::f64::fly_to_plane(result.ray, focus, 1.0).position.x));
        }
        return worst;
    };
    EXPECT_LT(worst_with(-n * n), 1e-13);
    EXPECT_GT(worst_with(-n * n + 0.01), 1e-4);
}

class WrittenPrescription : public ::testing::Test {
  protected:
    void SetUp() override {
        const auto* test = ::testing::UnitTest::GetInstance()->current_test_info();
        folder_ = std::filesystem::temp_directory_path() / (std::string("vkfv_optics_") + test->name());
        std::filesystem::remove_all(folder_);
        std::filesystem::create_directories(folder_ / "assets" / "objectives");
        std::filesystem::create_directories(folder_ / "stacks" / "deep");
    }
    void TearDown() override { std::filesystem::remove_all(folder_); }

    void write(const std::filesystem::path& file, const std::string& text) const {
        std::ofstream(folder_ / file) << text;
    }
    // The problem that is reported for a lens.toml of this text.
    InputProblem problem_of(const std::string& text) const {
        write("lens.toml", "source = \"a test\"\nlicence = \"none\"\n" + text);
        try {
            load_prescription("lens.toml", "objectives", folder_);
        } catch (const InputError& error) {
            return error.problem();
        }
        ADD_FAILURE() << "accepted:\n" << text;
        return {};
    }

    std::filesystem::path folder_;
};

constexpr const char* a_lens = "source = \"a test\"\nlicence = \"none\"\n[[surface]]\nradius_mm = 10.0\n";

TEST_F(WrittenPrescription, IsFoundBesideTheConfigurationAndAboveIt) {
    write("assets/objectives/mine.toml", a_lens);
    const auto expected = std::filesystem::absolute(folder_ / "assets/objectives/mine.toml").lexically_normal();
    for (const char* base : {".", "stacks", "stacks/deep"}) {
        const auto found = find_asset("mine", "objectives", folder_ / base);
        ASSERT_TRUE(found.has_value()) << base;
        EXPECT_EQ(*found, expected) << base;
    }
    EXPECT_EQ(load_prescription("../assets/objectives/mine.toml", "objectives", folder_ / "stacks").name, "mine");
    EXPECT_TRUE(find_asset("10x_0.28", "objectives", folder_)) << "comes with the program";
    EXPECT_FALSE(find_asset("mine", "tube_lenses", folder_));
    EXPECT_THROW(load_prescription("11x", "objectives", folder_), InputError);
    EXPECT_THROW(load_prescription("missing.toml", "objectives", folder_), InputError);
}

// Sets VKFV_ASSETS for a test.
class ChosenAssets {
  public:
    explicit ChosenAssets(const std::filesystem::path& folder) { setenv("VKFV_ASSETS", folder.c_str(), 1); }
    ~ChosenAssets() { unsetenv("VKFV_ASSETS"); }
    ChosenAssets(const ChosenAssets&) = delete;
    ChosenAssets& operator=(const ChosenAssets&) = delete;
    ChosenAssets(ChosenAssets&&) = delete;
    ChosenAssets& operator=(ChosenAssets&&) = delete;
};

TEST_F(WrittenPrescription, IsThatOfTheVariableThenThatBesideThenTheInstalledOne) {
    const auto found = [&] { return find_asset("10x_0.28", "objectives", folder_ / "stacks").value(); };
    const auto installed = found();
    EXPECT_TRUE(comes_with_program(installed, "objectives"));
    write("assets/objectives/10x_0.28.toml", a_lens);
    const auto beside = folder_ / "assets/objectives/10x_0.28.toml";
    EXPECT_EQ(found(), beside);
    EXPECT_FALSE(comes_with_program(beside, "objectives"));
    std::filesystem::create_directories(folder_ / "chosen/objectives");
    const ChosenAssets chosen(folder_ / "chosen");
    EXPECT_EQ(found(), beside) << "the chosen folder lacks it";
    write("chosen/objectives/10x_0.28.toml", a_lens);
    EXPECT_EQ(found(), folder_ / "chosen/objectives/10x_0.28.toml");
    EXPECT_EQ(find_asset("20x_0.41", "objectives", folder_ / "stacks")->parent_path(), installed.parent_path());
    const ChosenAssets missing(folder_ / "missing");
    EXPECT_THROW(found(), InputError);
}

TEST_F(WrittenPrescription, ReadsEveryKey) {
    write("lens.toml", std::string("title = \"lens\"\nsource_distance_mm = 7\nmedium_before = \"oil\"\n") + a_lens +
                           "conic = -1.5\naspheric = [1e-5, -2e-7]\nthickness_mm = 3\nmedium = \"glass\"\n"
                           "semi_diameter_mm = 4\nrole = \"aperture stop\"\n"
                           "[[surface]]\ncurvature_per_mm = -0.02\n[[surface]]\nrole = \"field stop\"\n"
                           "[media.oil]\nwavelengths_um = [0.5876]\nindices = [1.518]\n"
                           "[media.glass]\nwavelengths_um = [0.4861, 0.6563]\nindices = [1.52, 1.51]\n");
    // The second surface lacks its thickness.
    EXPECT_THROW(load_prescription("lens.toml", "objectives", folder_), InputError);
    std::ifstream stream(folder_ / "lens.toml");
    std::string text{std::istreambuf_iterator<char>(stream), {}};
    const std::string curvature = "curvature_per_mm = -0.02\n";
    text.insert(text.find(curvature) + curvature.size(), "thickness_mm = 0\n");
    write("lens.toml", text);
    const auto lens = load_prescription("lens.toml", "objectives", folder_);
    ASSERT_EQ(lens.surfaces.size(), 3u);
    EXPECT_EQ(lens.medium_before.index(0.5876), 1.518);
    EXPECT_EQ(lens.source_distance, 7);
    EXPECT_EQ(lens.surfaces[0].curvature, 0.1);
    EXPECT_EQ(lens.surfaces[0].conic, -1.5);
    EXPECT_EQ(lens.surfaces[0].aspheric[1], -2e-7);
    EXPECT_EQ(lens.surfaces[0].thickness, 3);
    EXPECT_EQ(lens.surfaces[0].semi_diameter, 4);
    EXPECT_EQ(lens.surfaces[0].role, PrescribedSurface::Role::aperture_stop);
    EXPECT_EQ(lens.surfaces[0].medium_after.index(0.6563), 1.51);
    EXPECT_EQ(lens.surfaces[1].curvature, -0.02);
    EXPECT_EQ(lens.surfaces[1].medium_after.name, "air");
    EXPECT_EQ(lens.surfaces[2].role, PrescribedSurface::Role::field_stop);
    EXPECT_FALSE(lens.surfaces[2].ideal_power);
    write("ideal.toml", "source = \"s\"\nlicence = \"l\"\n[[surface]]\nideal_focal_length_mm = -8\n");
    EXPECT_EQ(load_prescription("ideal.toml", "objectives", folder_).surfaces[0].ideal_power, -0.125);
}

TEST(ParsedPrescription, MediaHaveEveryForm) {
    const auto lens = parse_prescription("source = \"mine\"\nlicence = \"none\"\n"
                                         "[[surface]]\nmedium = \"a\"\nthickness_mm = 1\n"
                                         "[[surface]]\nmedium = \"b\"\nthickness_mm = 1\n"
                                         "[[surface]]\nmedium = \"c\"\nthickness_mm = 1\n"
                                         "[[surface]]\nmedium = \"d\"\n"
                                         "[media.a]\nindex = 1.25\n"
                                         "[media.b]\nnd = 1.5\nvd = 60\nsource = \"yours\"\n"
                                         "[media.c]\nformula = \"conrady\"\ncoefficients = [1.5, 0.01]\n"
                                         "range_um = [0.4, 0.7]\n"
                                         "[media.d]\nwavelengths_um = [0.5]\nindices = [1.75]\n",
                                         "lens.toml");
    const std::vector<Medium> expected = {Medium::constant("a", 1.25), Medium::model("b", 1.5, 60),
                                          Medium::formula("c", DispersionFormula::conrady, {1.5, 0.01}, 0.4, 0.7),
                                          Medium::tabulated("d", {0.5}, {1.75})};
    ASSERT_EQ(lens.surfaces.size(), expected.size());
    for (std::size_t i = 0; i < expected.size(); ++i) {
        EXPECT_EQ(lens.surfaces[i].medium_after.name, expected[i].name);
        EXPECT_EQ(lens.surfaces[i].medium_after.dispersion, expected[i].dispersion);
        EXPECT_EQ(lens.surfaces[i].medium_after.source, i == 1 ? "yours" : "mine");
    }
}

// A medium is looked for among the lens's own media first, then in the user's catalogues, then in the built-in table.
TEST(ParsedPrescription, MediaAreLookedForFromTheNearest) {
    const std::string text = "source = \"s\"\nlicence = \"l\"\n[[surface]]\nmedium = \"N-BK7\"\n";
    const auto index = [](const std::string& lens, const GlassCatalog& glasses) {
        return parse_prescription(lens, "lens.toml", glasses).surfaces[0].medium_after.index(0.5875618);
    };
    auto glasses = GlassCatalog::builtin();
    EXPECT_NEAR(index(text, glasses), 1.5168, 1e-6);
    glasses.add(AgfGlasses{.media = {Medium::constant("N-BK7", 1.25)}, .unusable = {}}, "mine.agf");
    EXPECT_EQ(index(text, glasses), 1.25);
    EXPECT_EQ(index(text + "[media.N-BK7]\nindex = 1.75\n", glasses), 1.75);
}

TEST_F(WrittenPrescription, UnknownMediumNamesTheNearestOfTheFileAndNoGlass) {
    EXPECT_THAT(problem_of("[[surface]]\nmedium = \"N-BK8\"\n").remedy, ::testing::Not(HasSubstr("Did you mean")));
    EXPECT_THAT(problem_of("[[surface]]\nmedium = \"glas\"\n[media.glass]\nindex = 1.5\n").remedy,
                HasSubstr("\"glass\""));
    EXPECT_THAT(problem_of("[[surface]]\nmedium = \"516640\"\n").remedy, HasSubstr("nd = 1.516 and vd = 64.0"));
}

TEST_F(WrittenPrescription, FaultsNamePlaceAndKey) {
    struct Fault {
        const char* text;
        const char* key;
        int line;
    };
    for (const Fault& fault : {
             Fault{"", "surface", 1},
             {"[[surface]]\nradius_mm = \"x\"\n", "radius_mm", 4},
             {"[[surface]]\nradius_mm = nan\n", "radius_mm", 4},
             {"[[surface]]\nradius_mm = 5\ncurvature_per_mm = 0.2\n", "curvature_per_mm", 5},
             {"[[surface]]\n[[surface]]\nthickness_mm = 1\n", "thickness_mm", 3},
             {"[[surface]]\nthickness_mm = -1\n[[surface]]\n", "thickness_mm", 4},
             {"[[surface]]\nsemi_diameter_mm = 0\n", "semi_diameter_mm", 4},
             {"[[surface]]\naspheric = [1,2,3,4,5,6,7,8]\n", "aspheric", 4},
             {"[[surface]]\nmedium = \"N-BK8\"\n", "medium", 4},
             {"[[surface]]\nrole = \"mirror\"\n", "role", 4},
             {"[[surface]]\nradius = 5\n", "radius", 4},
             {"[[surface]]\nideal_focal_length_mm = 0\n", "ideal_focal_length_mm", 4},
             {"[[surface]]\nideal_focal_length_mm = 5\nconic = -1\n", "conic", 5},
             {"[[surface]]\n[media.g]\nwavelengths_um = [0.6, 0.5]\nindices = [1.5, 1.5]\n", "wavelengths_um", 5},
             {"[[surface]]\n[media.g]\nwavelengths_um = [0.5, 0.6]\nindices = [1.5]\n", "indices", 6},
             {"[[surface]]\n[media.g]\nwavelengths_um = [0.5]\nindices = [0.5]\n", "indices", 6},
             {"[[surface]]\n[media.g]\n", "wavelengths_um", 4},
             {"[[surface]]\n[media.g]\nnd = 1.5\n", "vd", 4},
             {"[[surface]]\n[media.g]\nnd = 1.5\nvd = 0\n", "vd", 6},
             {"[[surface]]\n[media.g]\nnd = 0.5\nvd = 50\n", "nd", 5},
             {"[[surface]]\n[media.g]\nindex = 0.5\n", "index", 5},
             {"[[surface]]\n[media.g]\nindex = 1.5\nnd = 1.5\nvd = 50\n", "index", 5},
             {"[[surface]]\n[media.g]\nformula = \"sellmeier\"\n", "formula", 5},
             {"[[surface]]\n[media.g]\nformula = \"conrady\"\ncoefficients = [1, 2, 3, 4]\n", "coefficients", 6},
             {"[[surface]]\n[media.g]\nformula = \"conrady\"\ncoefficients = []\n", "coefficients", 6},
             {"[[surface]]\n[media.g]\nformula = \"conrady\"\ncoefficients = [1]\n", "range_um", 4},
             {"[[surface]]\n[media.g]\nformula = \"conrady\"\ncoefficients = [1]\nrange_um = [2, 1]\n", "range_um", 7},
             {"[[surface]]\nrole = \"field stop\"\nthickness_mm = 1\n[[surface]]\nrole = \"field stop\"\n", "role", 7},
         }) {
        const InputProblem problem = problem_of(fault.text);
        EXPECT_THAT(problem.key, HasSubstr(fault.key)) << fault.text;
        EXPECT_EQ(problem.where.file.filename(), "lens.toml") << fault.text;
        EXPECT_EQ(problem.where.line, fault.line) << fault.text;
        EXPECT_FALSE(problem.expected.empty() || problem.remedy.empty()) << fault.text;
    }
}

} // namespace
} // namespace vkfv::optics
