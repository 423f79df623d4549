// Gwyddion's own import modules read every file that vkfv writes, with the heights, pitches and gaps that the format
// keeps.
#include "gwyddion/gwyddion.hpp"
#include "support/instrument_files.hpp"
#include "support/surface_files.hpp"
#include "surface_files/surface_file.hpp"

#include <gtest/gtest.h>

#include <unistd.h>

#include <cmath>
#include <limits>
#include <utility>
#include <vector>

namespace vkfv::surface {
namespace {

using test::GwyddionFile, test::gwyddion_field;

class Gwyddion : public testing::Test {
  protected:
    static void SetUpTestSuite() { test::start_gwyddion(); }
    Gwyddion()
        : folder_(std::filesystem::path(testing::TempDir()) /
                  ("vkfv_gwyddion_" + std::to_string(::getpid()) + "_" +
                   testing::UnitTest::GetInstance()->current_test_info()->name())) {
        std::filesystem::create_directories(folder_);
    }
    ~Gwyddion() override { std::filesystem::remove_all(folder_); }

    static GwyddionFile load(const std::filesystem::path& file, const std::string& import) {
        EXPECT_EQ(test::gwyddion_import(file), import);
        return test::load_in_gwyddion(file);
    }

    std::filesystem::path folder_;
};

// The letter F as seen from +z, its first line at the highest y, on a slope that tells every point from the others; in
// um, gaps as "?".
HeightMap letter() {
    const std::vector<std::string> lines = {"######.", "#.....?", "####...", "#......", "#...?..", "?......"};
    HeightMap map;
    map.height = Grid<double>(7, 6);
    map.pitch_x = 0.00228;
    map.pitch_y = 0.0031;
    map.x0 = -0.125;
    map.y0 = 0.5;
    for (int row = 0; row < 6; ++row)
        for (int column = 0; column < 7; ++column) {
            const char c = lines[static_cast<std::size_t>(5 - row)][static_cast<std::size_t>(column)];
            map.height(column, row) = c == '?' ? std::numeric_limits<double>::quiet_NaN()
                                               : (c == '#' ? 5e-3 : -1.25e-3) + 1e-4 * column + 3.1e-5 * row;
        }
    return map;
}

// The precision with which a format keeps a map. Gwyddion shows a field's first row on top.
struct Kept {
    double unit = 1e-3;    // mm in a unit of Gwyddion's heights
    double height = 1e-20; // largest deviation of a height there
    double pitch = 0;      // and of a pitch, relative; infinite: the format's import knows none
    bool mask = true;
};

void expect_same(const GwyddionFile& container, const HeightMap& map, const Kept& kept) {
    GwyDataField* heights = gwyddion_field(container, "/0/data");
    ASSERT_TRUE(heights);
    ASSERT_EQ(gwy_data_field_get_xres(heights), map.columns());
    ASSERT_EQ(gwy_data_field_get_yres(heights), map.rows());
    if (std::isfinite(kept.pitch)) {
        // Gwyddion multiplies by the number of points and divides again.
        const double rounding = kept.pitch + 4 * std::numeric_limits<double>::epsilon();
        EXPECT_NEAR(gwy_data_field_get_dx(heights), map.pitch_x / 1e3, rounding * map.pitch_x / 1e3);
        EXPECT_NEAR(gwy_data_field_get_dy(heights), map.pitch_y / 1e3, rounding * map.pitch_y / 1e3);
        for (GwySIUnit* unit : {gwy_data_field_get_si_unit_xy(heights), gwy_data_field_get_si_unit_z(heights)}) {
            const std::unique_ptr<gchar, decltype(&g_free)> text(gwy_si_unit_get_string(unit, GWY_SI_UNIT_FORMAT_PLAIN),
                                                                 &g_free);
            EXPECT_STREQ(text.get(), "m");
        }
    }
    GwyDataField* mask = gwyddion_field(container, "/0/mask");
    EXPECT_EQ(mask != nullptr, kept.mask);
    for (int row = 0; row < map.rows(); ++row)
        for (int column = 0; column < map.columns(); ++column) {
            const int line = map.rows() - 1 - row;
            const bool measured = std::isfinite(map.height(column, row));
            if (mask) {
                EXPECT_EQ(gwy_data_field_get_val(mask, column, line) > 0, !measured) << column << " " << row;
            }
            if (measured) {
                EXPECT_NEAR(gwy_data_field_get_val(heights, column, line), map.height(column, row) * kept.unit,
                            kept.height)
                    << column << " " << row;
            }
        }
}

TEST_F(Gwyddion, X3p) {
    write_surface(folder_ / "letter.x3p", letter());
    expect_same(load(folder_ / "letter.x3p", "opengps"), letter(), {});
}

// Heights are below 2^-7 mm, in steps of 2^-37 mm; pitches are float32. The import of 2.62 knows no special points: a
// gap is as high as the format says, two steps below the lowest point.
TEST_F(Gwyddion, Sur) {
    write_surface(folder_ / "letter.sur", letter());
    const GwyddionFile container = load(folder_ / "letter.sur", "surffile");
    const double step = std::ldexp(1, -37) / 1e3;
    expect_same(container, letter(), {.height = 0.51 * step, .pitch = std::ldexp(1, -24), .mask = false});
    const double lowest = -1.25e-6 + 1e-7; // at column 1, row 0
    EXPECT_NEAR(gwy_data_field_get_val(gwyddion_field(container, "/0/data"), 0, 5), lowest - 2 * step, 0.51 * step);
}

TEST_F(Gwyddion, Sdf) {
    write_surface(folder_ / "letter.sdf", letter());
    expect_same(load(folder_ / "letter.sdf", "sdfile-bin"), letter(), {});
}

// The import of texts makes no mask: a gap is NaN in the field itself.
TEST_F(Gwyddion, SdfText) {
    write_surface(folder_ / "letter.asc.sdf", letter());
    const GwyddionFile container = load(folder_ / "letter.asc.sdf", "sdfile-txt");
    expect_same(container, letter(), {.mask = false});
    EXPECT_TRUE(std::isnan(gwy_data_field_get_val(gwyddion_field(container, "/0/data"), 0, 5)));
}

// The file holds um in float32. Gwyddion asks its user for the scale of a plain image.
TEST_F(Gwyddion, Tiff) {
    write_surface(folder_ / "letter.tif", letter());
    expect_same(load(folder_ / "letter.tif", "tiffbig"), letter(),
                {.unit = 1e3, .height = 8 * std::ldexp(1, -24), .pitch = std::numeric_limits<double>::infinity()});
}

TEST_F(Gwyddion, Gwy) {
    write_surface(folder_ / "letter.gwy", letter());
    expect_same(load(folder_ / "letter.gwy", "gwyfile"), letter(), {});
}

// The file holds metres in float32.
TEST_F(Gwyddion, Gsf) {
    write_surface(folder_ / "letter.gsf", letter());
    const GwyddionFile container = load(folder_ / "letter.gsf", "gsffile");
    expect_same(container, letter(), {.height = 6e-6 * std::ldexp(1, -24)});
}

// Gwyddion's own export of what it read comes back the same.
TEST_F(Gwyddion, GwyAsGwyddionWritesIt) {
    write_surface(folder_ / "letter.x3p", letter());
    const GwyddionFile container = test::load_in_gwyddion(folder_ / "letter.x3p");
    GError* error = nullptr;
    ASSERT_NE(gwy_file_save(container.get(), (folder_ / "saved.gwy").c_str(), GWY_RUN_NONINTERACTIVE, &error), 0)
        << (error ? error->message : "");
    const HeightMap map = read_surface(folder_ / "saved.gwy").map;
    for (std::size_t k = 0; k < map.height.values.size(); ++k)
        if (const double z = letter().height.values[k]; std::isnan(z))
            EXPECT_TRUE(std::isnan(map.height.values[k])) << k;
        else
            EXPECT_NEAR(map.height.values[k], z, 1e-17) << k;
    EXPECT_NEAR(map.pitch_x, letter().pitch_x, 1e-17);
    EXPECT_NEAR(map.pitch_y, letter().pitch_y, 1e-17);
}

// Files of instruments are formats that vkfv reads alone: it and Gwyddion must find the same heights.
TEST_F(Gwyddion, FilesOfInstruments) {
    for (const auto& [ending, import] : {std::pair{"plu", "sensofar"}, {"opd", "opdfile"}, {"dat", "metropro"}}) {
        const auto file = folder_ / (std::string("a.") + ending);
        write_file(file, test::instrument_file(ending));
        const HeightMap map = read_surface(file).map;
        SCOPED_TRACE(ending);
        expect_same(load(file, import), map, {.height = 1e-14, .pitch = 1e-7});
    }
}

} // namespace
} // namespace vkfv::surface
