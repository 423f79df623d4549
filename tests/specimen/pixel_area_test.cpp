// Pixels that look beside a regular grid, turned, distorted, or apart by jumps, have the truth of where they look.
#include "specimen/description.hpp"
#include "specimen/specimen.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <functional>
#include <random>

namespace vkfv::specimen {
namespace {

constexpr double pitch = 0.001;
constexpr PixelGrid grid{.columns = 41, .rows = 37, .x0 = -0.02, .y0 = -0.018, .pitch_x = pitch, .pitch_y = pitch};

// Small and large triangles, many of which lie above each other, over more than the field or a part of it.
Mesh heap_of_triangles() {
    std::mt19937 random(3);
    std::uniform_real_distribution<float> place(-0.03f, 0.03f), height(0, 0.005f), size(-1, 1);
    Mesh mesh;
    for (unsigned k = 0; k < 300; ++k) {
        const glm::vec3 middle(place(random), place(random), height(random));
        const float reach = k % 10 == 0 ? 0.02f : 0.003f;
        for (int corner = 0; corner < 3; ++corner) {
            const float x = reach * size(random), y = reach * size(random);
            mesh.vertices.push_back(middle + glm::vec3(x, y, 0.1f * reach * size(random)));
        }
        mesh.triangles.emplace_back(3 * k, 3 * k + 1, 3 * k + 2);
    }
    return mesh;
}

using AreaOf = std::function<PixelArea(int column, int row)>;

PixelArea regular(int column, int row) {
    return {.middle = {grid.x0 + column * pitch, grid.y0 + row * pitch},
            .along_row = {pitch, 0},
            .along_column = {0, pitch}};
}

PixelArea turned(int column, int row) {
    const double cosine = std::cos(0.1), sine = std::sin(0.1);
    const glm::dmat2 turn(cosine, sine, -sine, cosine);
    const PixelArea area = regular(column, row);
    return {.middle = turn * area.middle + glm::dvec2(0.004, -0.003),
            .along_row = turn * area.along_row,
            .along_column = turn * area.along_column};
}

PixelArea distorted(int column, int row) {
    const PixelArea area = regular(column, row);
    const double share = 100 * glm::dot(area.middle, area.middle); // 7 % in the corners
    return {.middle = (1 + share) * area.middle, .along_row = area.along_row, .along_column = area.along_column};
}

PixelArea scattered(int column, int row) {
    PixelArea area = regular(column, row);
    area.middle += pitch * glm::dvec2((column * 7 + row * 3) % 5 - 2, (column * 2 + row * 11) % 7 - 3);
    return area;
}

// The heights of all pixels together are those of single pixels, for which no search finds the pixels that a triangle
// covers.
void expect_same_alone(const Specimen& specimen, const AreaOf& area_of) {
    const auto together = truth(specimen, grid, area_of);
    EXPECT_EQ(together.x0, grid.x0);
    EXPECT_EQ(together.pitch_y, grid.pitch_y);
    int known = 0;
    for (int row = 0; row < grid.rows; ++row) {
        for (int column = 0; column < grid.columns; ++column) {
            const PixelGrid one{.columns = 1, .rows = 1, .x0 = 0, .y0 = 0, .pitch_x = pitch, .pitch_y = pitch};
            const double alone = truth(specimen, one, [&](int, int) { return area_of(column, row); }).height(0, 0);
            ASSERT_EQ(std::isnan(together.height(column, row)), std::isnan(alone)) << column << ", " << row;
            if (!std::isnan(alone)) {
                ++known;
                ASSERT_EQ(together.height(column, row), alone) << column << ", " << row;
            }
        }
    }
    EXPECT_GT(known, grid.columns * grid.rows / 4);
}

TEST(PixelArea, OfAMeshIsThatOfEachPixelAlone) {
    const Specimen specimen{heap_of_triangles(), {}};
    for (const AreaOf& area_of : {AreaOf(regular), AreaOf(turned), AreaOf(distorted), AreaOf(scattered)}) {
        expect_same_alone(specimen, area_of);
    }
}

// Each area has the mean of z = 0.2 x - 0.1 y in its middle.
TEST(PixelArea, OfAPlaneIsItsHeightInTheMiddle) {
    HeightField field{.heights = Grid<float>(3, 3), .x_min = -0.05, .y_min = -0.05, .pitch_x = 0.05, .pitch_y = 0.05};
    for (int row = 0; row < 3; ++row) {
        for (int column = 0; column < 3; ++column) {
            field.heights(column, row) =
                static_cast<float>(0.2 * (field.x_min + column * 0.05) - 0.1 * (field.y_min + row * 0.05));
        }
    }
    for (const AreaOf& area_of : {AreaOf(turned), AreaOf(distorted), AreaOf(scattered)}) {
        const auto map = truth(Specimen{field, {}}, grid, area_of);
        for (int row = 0; row < grid.rows; row += 6) {
            for (int column = 0; column < grid.columns; column += 5) {
                const glm::dvec2 middle = area_of(column, row).middle;
                EXPECT_NEAR(map.height(column, row), 0.2 * middle.x - 0.1 * middle.y, 1e-9);
            }
        }
    }
}

} // namespace
} // namespace vkfv::specimen
