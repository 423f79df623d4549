// Seen from +z with x to the right, y points up in every file that is written.
#include "app/program.hpp"
#include "images/image_file.hpp"
#include "support/surface_files.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

namespace vkfv::test {

static const std::filesystem::path source_folder = VKFV_SOURCE_DIR;

// The letter F of assets/specimens is raised: shown by a viewer (the file's first row on top) it has its stem on the
// left and its bars to the right, the upper one at the top, in the topography's truth for each of its makers.
TEST(Handedness, ALetterReadsCorrectlyFromEveryKindOfFile) {
    for (const char* name : {"image_letter", "stl_letter", "gltf_letter", "surface_letter", "points_letter"}) {
        const auto folder = fresh_folder(std::string("hand_") + name);
        std::vector<std::string> arguments = {"--stack",
                                              (source_folder / "assets/stacks" / name).string() + ".toml",
                                              "--out",
                                              "out",
                                              "--rays",
                                              "2e6",
                                              "--quiet",
                                              "--set",
                                              "scan.z_start_um=-12",
                                              "--set",
                                              "scan.z_stop_um=12",
                                              "--set",
                                              "scan.z_step_um=12"};
        if (name == std::string("image_letter") || name == std::string("surface_letter")) {
            arguments.insert(arguments.end(), {"--set", "specimen.roughness.noise_um=0.01"}); // the relief alone
        }
        const auto result = run_program(arguments, folder);
        ASSERT_EQ(result.exit_code, 0) << result.standard_error;
        // Grid rows ascend with y; a viewer's top row is the last.
        const auto truth = surface::read_height_map(folder / "out/truth.tif");
        const int side = truth.columns();
        double highest = -1e9, lowest = 1e9;
        for (const double h : truth.height.values) {
            highest = std::max(highest, h);
            lowest = std::min(lowest, h);
        }
        // The share of raised points in a part of the letter's bounding box, u to the right and v up, both 0 to 1. A
        // row or a column belongs to the letter from a tenth of the side on: single points on the flanks are of
        // neither.
        int left = side, right = 0, bottom = side, top = 0;
        const auto raised = [&](int i, int j) { return truth.height(i, j) > 0.5 * (highest + lowest); };
        for (int k = 0; k < side; ++k) {
            int in_column = 0, in_row = 0;
            for (int other = 0; other < side; ++other) {
                in_column += raised(k, other) ? 1 : 0;
                in_row += raised(other, k) ? 1 : 0;
            }
            if (10 * in_column >= side) {
                left = std::min(left, k);
                right = std::max(right, k);
            }
            if (10 * in_row >= side) {
                bottom = std::min(bottom, k);
                top = std::max(top, k);
            }
        }
        const auto share = [&](double u0, double u1, double v0, double v1) {
            int inside = 0, up = 0;
            for (int j = bottom; j <= top; ++j) {
                for (int i = left; i <= right; ++i) {
                    const double u = (i - left + 0.5) / (right - left + 1), v = (j - bottom + 0.5) / (top - bottom + 1);
                    if (u > u0 && u < u1 && v > v0 && v < v1) {
                        ++inside;
                        up += raised(i, j) ? 1 : 0;
                    }
                }
            }
            return double(up) / std::max(inside, 1);
        };
        EXPECT_GT(share(0, 0.15, 0, 1), 0.8) << name << ": stem on the left";
        EXPECT_GT(share(0.3, 0.9, 0.87, 1), 0.8) << name << ": bar at the top";
        EXPECT_LT(share(0.5, 1, 0, 0.3), 0.1) << name << ": nothing at the lower right";

        // The walls of the letter scatter light away: the image is darker where the truth has edges, and is not where
        // the truth turned left to right, up to down or both has them.
        const auto image = images::read_image(folder / "out/images/z_0001.tif");
        const auto darkness_at_edges = [&](bool turn_x, bool turn_y) {
            double dark = 0, weight = 0, mean = 0, points = 0;
            for (int j = 1; j + 1 < side; ++j) {
                for (int i = 1; i + 1 < side; ++i) {
                    const int u = turn_x ? side - 1 - i : i, v = turn_y ? side - 1 - j : j;
                    const double edge = std::abs(truth.height(u + 1, v) - truth.height(u - 1, v)) +
                                        std::abs(truth.height(u, v + 1) - truth.height(u, v - 1));
                    if (std::isfinite(edge)) {
                        dark += edge * image(i, j);
                        weight += edge;
                        mean += image(i, j);
                        points += 1;
                    }
                }
            }
            return 1 - (dark / weight) / (mean / points);
        };
        const double upright = darkness_at_edges(false, false);
        EXPECT_GT(upright, 0.04) << name;
        // Stem and middle bar of an F nearly coincide with themselves turned up to down: about half its edges.
        for (const auto& [turn_x, turn_y] : {std::pair{true, false}, {false, true}, {true, true}}) {
            EXPECT_LT(darkness_at_edges(turn_x, turn_y), 0.75 * upright) << name << " " << turn_x << turn_y;
        }
    }
}

} // namespace vkfv::test
