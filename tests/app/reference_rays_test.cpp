// --trace-rays agrees with rays of another program (tests/data/rays) through the whole command: CSV in, CSV out.
#include "app/program.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <sstream>

namespace vkfv::test {
namespace {

struct Scope {
    const char* objective;
    const char* rays;
};

std::vector<std::vector<std::string>> rows_of(const std::string& csv) {
    std::vector<std::vector<std::string>> rows;
    std::istringstream stream(csv);
    for (std::string line; std::getline(stream, line);) {
        std::istringstream fields(line);
        auto& row = rows.emplace_back();
        for (std::string field; std::getline(fields, field, ',');) {
            row.push_back(field);
        }
    }
    rows.erase(rows.begin()); // the header
    return rows;
}

// Greatest differences from the reference, and the number of rays that one program calls vignetted and the other does
// not.
struct Differences {
    double position = 0;  // mm
    double direction = 0; // largest difference of a direction cosine
    double path = 0;      // mm
    int apertures = 0;
    int rays = 0;
};

Differences compare_with_reference(const Scope& scope, const std::vector<std::string>& options) {
    const auto folder = fresh_folder(std::string("reference_") + scope.objective);
    write_file(folder / "c.toml",
               replaced(small_configuration, "\"10x_0.28\"", "\"" + std::string(scope.objective) + "\""));
    // Columns of the reference: x0 y0 z0 L0 M0 N0 xs ys Ls Ms Ns opl inside_semi_diameters.
    const auto reference = rows_of(read_file(std::filesystem::path(VKFV_SOURCE_DIR) / "tests/data/rays" / scope.rays));
    std::string input = "x_mm,y_mm,z_mm,l,m,n\n";
    for (const auto& row : reference) {
        input += row[0] + "," + row[1] + "," + row[2] + "," + row[3] + "," + row[4] + "," + row[5] + "\n";
    }
    write_file(folder / "rays.csv", input);
    std::vector<std::string> arguments = {"--trace-rays", "c.toml", "rays.csv", "--set",
                                          "source.wavelength_um=0.587562"};
    arguments.insert(arguments.end(), options.begin(), options.end());
    const auto result = run_program(arguments, folder);
    EXPECT_EQ(result.exit_code, 0) << result.standard_error;
    const auto traced = rows_of(result.standard_output);
    Differences differences;
    EXPECT_EQ(traced.size(), reference.size());
    for (std::size_t i = 0; i < std::min(traced.size(), reference.size()); ++i) {
        const bool arrived = traced[i][6] == "ok";
        differences.apertures += arrived == (reference[i][12] == "1") ? 0 : 1;
        if (!arrived) {
            continue;
        }
        const auto difference = [&](int column) {
            return std::abs(std::stod(traced[i][static_cast<std::size_t>(column)]) -
                            std::stod(reference[i][static_cast<std::size_t>(column + 6)]));
        };
        differences.position = std::max({differences.position, difference(0), difference(1)});
        differences.direction = std::max({differences.direction, difference(2), difference(3), difference(4)});
        differences.path = std::max(differences.path, difference(5));
        ++differences.rays;
    }
    return differences;
}

class ReferenceRays : public testing::TestWithParam<Scope> {};

// Two programs in double that order their sums differently may differ by rounding after some 350 mm of path and thirty
// surfaces; the limits leave a margin of a thousand.
TEST_P(ReferenceRays, AgreeInDouble) {
    const auto found = compare_with_reference(GetParam(), {});
    EXPECT_GT(found.rays, 1900);
    EXPECT_LT(found.position, 1e-9);
    EXPECT_LT(found.direction, 1e-12);
    EXPECT_LT(found.path, 1e-8);
    EXPECT_EQ(found.apertures, 0);
}

TEST_P(ReferenceRays, AgreeInFloatOnTheDevice) {
    const auto found = compare_with_reference(GetParam(), {"--precision", "float"});
    EXPECT_GT(found.rays, 1900);
    EXPECT_LT(found.position, 0.5e-3);
    EXPECT_EQ(found.apertures, 0); // none of the 2000 rays passes within float's 1e-6 mm of an edge
}

TEST_P(ReferenceRays, AllArriveWithoutApertures) {
    const auto found = compare_with_reference(GetParam(), {"--apertures", "off"});
    EXPECT_EQ(found.rays, 2000);
    EXPECT_GT(found.apertures, 0);
    EXPECT_LT(found.position, 1e-9);
}

// The wrong twin: a tube lens a tenth of a millimetre off is seen.
TEST_P(ReferenceRays, WrongDistanceIsSeen) {
    const auto found = compare_with_reference(GetParam(), {"--set", "tube_lens.distance_mm=100.1"});
    EXPECT_GT(std::max(found.position, found.path), 1e-6);
}

INSTANTIATE_TEST_SUITE_P(Scopes, ReferenceRays,
                         testing::Values(Scope{"10x_0.28", "scope_obj10x_028_tube200_nikon.csv"},
                                         Scope{"5x_0.15", "scope_obj5x_015_tube200_nikon.csv"}),
                         [](const auto& info) { return std::string(info.index == 0 ? "Tenfold" : "Fivefold"); });

} // namespace
} // namespace vkfv::test
