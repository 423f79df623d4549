// A ray-tracing pipeline meets what the traversals meet, on software Vulkan, by the shaders and tables that a GPU runs.
#include "bench/pipeline_hits.hpp"
#include "specimen/description.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>

namespace vkfv::bench {
namespace {

// A field of 65 x 65 points over 0.1 mm, with waves of 2 um up to slopes of 0.8.
specimen::HeightField waves(double offset = 0) {
    specimen::HeightField field;
    field.heights = Grid<float>(65, 65);
    field.pitch_x = field.pitch_y = 0.1 / 64;
    field.x_min = field.y_min = -0.05;
    for (int row = 0; row < 65; ++row) {
        for (int column = 0; column < 65; ++column) {
            field.heights(column, row) =
                static_cast<float>(offset + 0.002 * std::sin(0.6 * column) * std::cos(0.5 * row));
        }
    }
    return field;
}

// A roof, whose ridge hides one side from light that comes from the other.
specimen::Mesh roof() {
    specimen::Mesh mesh;
    mesh.vertices = {{-0.05, -0.05, 0}, {0, -0.05, 0.03}, {0.05, -0.05, 0},
                     {-0.05, 0.05, 0},  {0, 0.05, 0.03},  {0.05, 0.05, 0}};
    mesh.triangles = {{0, 1, 4}, {0, 4, 3}, {1, 2, 5}, {1, 5, 4}};
    return mesh;
}

specimen::Analytic sinusoid() {
    specimen::Analytic surface;
    surface.shape = physics::f64::SHAPE_SINUSOID;
    surface.parameters[0] = 0.002; // amplitude, mm
    surface.parameters[1] = 0.02;  // wavelength, mm
    surface.x_min = surface.y_min = -0.05;
    surface.x_max = surface.y_max = 0.05;
    return surface;
}

HitDifferences compared(const specimen::Specimen& specimen, const specimen::Specimen& beside,
                        trace::Traversal traversal) {
    return compare_pipeline_hits(specimen, beside, traversal, "", 4000, 1);
}

void expect_agreement(const specimen::Specimen& specimen, trace::Traversal traversal) {
    const HitDifferences found = compared(specimen, specimen, traversal);
    // The roof is 0.03 mm high and 0.1 mm wide, and rays lean by at most 24 degrees, so that at most a fifth of those
    // that arrive leave sideways. Rays that leave the roof need not meet it again.
    EXPECT_GT(found.both, found.rays * 2 / 5);
    EXPECT_EQ(found.unexplained, 0U);
    // The belt of 1 nm beside edges and crests, some 100 lines of 0.1 mm in a square of that side, holds 1e-3 of the
    // rays.
    EXPECT_LE(found.one_alone + found.apart, 10U);
}

TEST(PipelineHits, AgreeOnHeightFields) {
    for (const auto traversal : {trace::Traversal::quadtree, trace::Traversal::bvh}) {
        expect_agreement({waves(), {}}, traversal);
    }
}

TEST(PipelineHits, AgreeOnMeshes) {
    expect_agreement({roof(), {}}, trace::Traversal::bvh);
}

TEST(PipelineHits, AgreeOnAnalyticSurfaces) {
    for (const auto traversal : {trace::Traversal::quadtree, trace::Traversal::bvh}) {
        expect_agreement({sinusoid(), {}}, traversal);
    }
}

TEST(PipelineHits, AreFoundApartWhereASurfaceIsThreeNanometresHigher) {
    const HitDifferences found = compared({waves(), {}}, {waves(3e-6), {}}, trace::Traversal::bvh);
    EXPECT_GT(found.apart, found.both * 9 / 10);
    EXPECT_GT(found.unexplained, found.both / 2);
}

} // namespace
} // namespace vkfv::bench
