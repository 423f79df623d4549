// vkfv optics, through the real program, writes wavefronts, transfer and point spread that closed forms and other
// programs know.
#include "app/program.hpp"

#include "core/mathematics/units.hpp"

#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include <array>
#include <cmath>
#include <map>
#include <sstream>

namespace vkfv::test {
namespace {

using testing::HasSubstr;
using testing::StartsWith;

const std::string stacks = VKFV_SOURCE_DIR "/assets/stacks/";

// The numbers of a table's rows, by the text of the columns before them.
using Rows = std::map<std::string, std::vector<double>>;
Rows rows_of(const std::filesystem::path& file, int key_columns) {
    std::istringstream lines(read_file(file));
    std::string line;
    std::getline(lines, line);
    Rows rows;
    while (std::getline(lines, line)) {
        std::istringstream cells(line);
        std::string cell, key;
        for (int i = 0; i < key_columns && std::getline(cells, cell, ','); ++i) {
            key += (i > 0 ? "," : "") + cell;
        }
        while (std::getline(cells, cell, ',')) {
            rows[key].push_back(std::stod(cell));
        }
    }
    return rows;
}

// An ideal lens of NA 0.28, a quarter of a wave out of focus at the rim, has the figures of the scalar Debye integral.
TEST(OpticsCommand, IntegratesThePupilOfAnIdealLens) {
    const auto folder = fresh_folder("optics_ideal");
    constexpr double aperture = 0.28, wavelength_um = 0.55;
    const std::string reach = fmt::format("{:.17g}", 0.5 * wavelength_um / (aperture * aperture));
    const auto result = run_program({"optics", stacks + "ideal_lenses.toml", "--out", "out", "--set",
                                     "source.wavelength_um=0.55", "--z_range_um", reach},
                                    folder);
    ASSERT_EQ(result.exit_code, 0) << result.standard_error;
    const auto report = nlohmann::json::parse(read_file(folder / "out/optics.json"));
    ASSERT_EQ(report["points"].size(), 3u);
    const auto& axis = report["points"][0];
    EXPECT_EQ(axis["point"], "axis");
    EXPECT_NEAR(axis["strehl"].get<double>(), 1, 1e-6);
    EXPECT_NEAR(axis["through_focus"].front()["strehl"].get<double>(), 0.803, 1e-3);
    EXPECT_NEAR(axis["through_focus"].back()["strehl"].get<double>(), 0.803, 1e-3);
    // The dark rings are the zeros of J1 over 2 pi, and the shares of light within them are Rayleigh's.
    const double unit = wavelength_um / aperture;
    const std::array radii = {0.609835, 1.116565, 1.619157};
    const std::array light = {0.8378, 0.9099, 0.9376};
    ASSERT_EQ(axis["dark_rings"].size(), 3u);
    for (std::size_t i = 0; i < radii.size(); ++i) {
        EXPECT_NEAR(axis["dark_rings"][i]["radius_um"].get<double>(), radii[i] * unit, 1e-3 * unit);
        EXPECT_NEAR(axis["dark_rings"][i]["light"].get<double>(), light[i], 2e-4);
    }
    const double cutoff = report["cutoff_per_mm"].get<double>();
    EXPECT_NEAR(cutoff, 2 * aperture / wavelength_um * um_per_mm, 1e-6 * cutoff);
    const Rows transfer = rows_of(folder / "out/transfer.csv", 4);
    const auto contrast = [&](const char* direction, double s) {
        return transfer.at(fmt::format("axis,{},{:.6g},{:.6g}", direction, std::stod(reach), s * cutoff)).front();
    };
    EXPECT_NEAR(contrast("radial", 0.25), 0.572, 1e-3);
    EXPECT_NEAR(contrast("tangential", 0.5), 0.284, 1e-3);
    EXPECT_NEAR(contrast("radial", 0.75), 0.121, 1e-3);
}

// tests/references/wavefront_reference.py, which shares no code, gives the coefficients of the 10x at its best focus.
TEST(OpticsCommand, TellsAShippedObjectivesWavefront) {
    const auto folder = fresh_folder("optics_demo");
    const auto result = run_program({"optics", stacks + "demo.toml", "--out", "out"}, folder);
    ASSERT_EQ(result.exit_code, 0) << result.standard_error;
    EXPECT_THAT(result.standard_output, HasSubstr("Strehl ratio"));
    EXPECT_THAT(result.standard_output, HasSubstr("corner"));
    const Rows zernike = rows_of(folder / "out/zernike.csv", 3);
    EXPECT_NEAR(zernike.at("axis,4,defocus").back(), 0, 1e-3);
    EXPECT_NEAR(zernike.at("axis,11,spherical aberration").back(), -0.0106, 1e-3);
    EXPECT_NEAR(zernike.at("axis,37,").back(), 0.0124, 1e-3);
    EXPECT_NEAR(zernike.at("axis,8,coma x").back(), 0, 1e-6);
    EXPECT_GT(std::abs(zernike.at("corner,8,coma x").back()), 1e-3); // coma
    for (const char* picture : {"transfer.svg", "point_spread.svg", "wavefront.svg"}) {
        EXPECT_THAT(read_file(folder / "out" / picture), StartsWith("<svg "));
        EXPECT_THAT(read_file(folder / "out" / picture), HasSubstr("<title>demo: "));
    }
    EXPECT_GT(rows_of(folder / "out/wavefront.csv", 3).size(), 10000u);
    EXPECT_EQ(run_program({"verify", "out"}, folder).exit_code, 0);
}

// Zernike coefficients are means over the disc: the piston of W, the tilts of W 2 x and W 2 y.
TEST(OpticsCommand, TellsOneWavefrontInBothTables) {
    const auto folder = fresh_folder("optics_tables");
    const auto result = run_program({"optics", stacks + "bench_paper_chain.toml", "--out", "out"}, folder);
    ASSERT_EQ(result.exit_code, 0) << result.standard_error;
    const Rows zernike = rows_of(folder / "out/zernike.csv", 3);
    std::istringstream lines(read_file(folder / "out/wavefront.csv"));
    std::string line;
    std::getline(lines, line);
    struct Sums {
        double rim = 0, count = 0, piston = 0, tilt_x = 0, tilt_y = 0, square = 0;
    };
    std::map<std::string, Sums> points;
    while (std::getline(lines, line)) {
        std::istringstream cells(line);
        std::string point, x, y, waves;
        std::getline(std::getline(std::getline(std::getline(cells, point, ','), x, ','), y, ','), waves);
        const double value = std::stod(waves);
        Sums& sums = points[point];
        sums.rim = std::max(sums.rim, std::hypot(std::stod(x), std::stod(y)));
        sums.count += 1;
        sums.piston += value;
        sums.tilt_x += value * 2 * std::stod(x);
        sums.tilt_y += value * 2 * std::stod(y);
        sums.square += value * value;
    }
    ASSERT_EQ(points.size(), 3u);
    for (const std::string point : {"axis", "edge"}) { // the corner's pupil is clipped, and the disc is part of it
        const Sums& sums = points.at(point);
        EXPECT_NEAR(zernike.at(point + ",1,piston").back(), sums.piston / sums.count, 3e-3) << point;
        EXPECT_NEAR(zernike.at(point + ",2,tilt x").back(), sums.tilt_x / sums.rim / sums.count, 3e-3) << point;
        EXPECT_NEAR(zernike.at(point + ",3,tilt y").back(), sums.tilt_y / sums.rim / sums.count, 3e-3) << point;
    }
    EXPECT_NEAR(std::sqrt(points["corner"].square / points["corner"].count), 0.1995, 2e-3);
    // vkfv check reports the root of the mean square of the same wavefronts: the map's 129 x 129 points against a
    // quadrature.
    const auto check = run_program({"check", stacks + "bench_paper_chain.toml", "--json"}, folder);
    ASSERT_EQ(check.exit_code, 0) << check.standard_error;
    const auto told = nlohmann::json::parse(check.standard_output);
    for (const std::string point : {"axis", "edge", "corner"}) {
        const Sums& sums = points.at(point);
        EXPECT_NEAR(told["wavefront_rms_" + point + "_waves"].get<double>(), std::sqrt(sums.square / sums.count), 2e-3);
        if (point != "corner") { // which check takes along x, as the train is symmetric
            const auto printed = fmt::format("{:16.4f}", told["wavefront_rms_" + point + "_waves"].get<double>());
            EXPECT_THAT(result.standard_output, HasSubstr(printed)) << point;
        }
    }
}

TEST(OpticsCommand, SaysWhatIsWrong) {
    const auto folder = fresh_folder("optics_wrong");
    write_file(folder / "file", "");
    const auto range = run_program({"optics", stacks + "demo.toml", "--out", "out", "--z_range_um", "-3"}, folder);
    EXPECT_EQ(range.exit_code, 2);
    EXPECT_THAT(range.standard_error, HasSubstr("--z_range_um -3"));
    const auto place = run_program({"optics", stacks + "demo.toml", "--out", "file/out"}, folder);
    EXPECT_EQ(place.exit_code, 4);
    EXPECT_THAT(place.standard_error, HasSubstr("file"));
    EXPECT_EQ(run_program({"optics", "missing.toml"}, folder).exit_code, 2);
}

} // namespace
} // namespace vkfv::test
