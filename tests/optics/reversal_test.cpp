#include "optics/prescriptions/reversal.hpp"

#include "core/mathematics/units.hpp"
#include "optics/prescriptions/pose.hpp"
#include "optics/prescriptions/prescription_writer.hpp"

#include <gtest/gtest.h>

namespace vkfv::optics {
namespace {

Prescription tilted_lens() {
    Prescription lens;
    lens.title = "tilted";
    lens.medium_before = Medium::constant("oil", 1.5);
    PrescribedSurface front, middle, back;
    front.curvature = 0.02;
    front.aspheric[0] = 1e-5;
    front.thickness = 4;
    front.medium_after = Medium::constant("glass", 1.6);
    middle.breaks = {
        {.decentre_x = 0.3, .decentre_y = -0.2, .tilt_x = 0.1, .tilt_y = -0.2, .tilt_z = 0.3, .thickness = 1},
        {.decentre_y = 0.5, .tilt_x = 0.05, .tilt_z = -0.1, .tilt_first = true, .thickness = -0.5}};
    middle.curvature = -0.01;
    middle.conic = -1.5;
    middle.thickness = 6;
    middle.medium_after = Medium::air();
    middle.role = PrescribedSurface::Role::aperture_stop;
    back.curvature = 0.005;
    back.semi_diameter = 7;
    back.medium_after = Medium::constant("water", 1.33);
    lens.surfaces = {front, middle, back};
    return lens;
}

std::vector<Pose> vertices_of(const Prescription& lens) {
    std::vector<Pose> vertices;
    Pose pose;
    for (const auto& surface : lens.surfaces) {
        pose = pose.along(surface.breaks);
        vertices.push_back(pose);
        pose = pose.along_z(surface.thickness);
    }
    return vertices;
}

// The pose of `inside`, given in the frame that `outside` is given in, as `outside` sees it.
Pose seen_from(const Pose& outside, const Pose& inside) {
    const glm::dmat3 back = glm::transpose(outside.axes);
    return {back * (inside.origin - outside.origin), back * inside.axes};
}

// Every surface of the turned lens stands where the lens has it, in the frame of the last vertex after half a turn
// about y.
TEST(Reversal, SurfacesStandWhereTheyStood) {
    const auto lens = tilted_lens();
    const auto before = vertices_of(lens), after = vertices_of(turned_round(lens));
    ASSERT_EQ(after.size(), before.size());
    const glm::dmat3 half_turn(glm::dvec3(-1, 0, 0), glm::dvec3(0, 1, 0), glm::dvec3(0, 0, -1));
    for (std::size_t i = 0; i < before.size(); ++i) {
        const Pose expected = seen_from(before.back(), before[before.size() - 1 - i]);
        const Pose found = seen_from(after.front(), after[i]);
        const glm::dvec3 origin = half_turn * expected.origin;
        const glm::dmat3 axes = half_turn * expected.axes * half_turn;
        for (int k = 0; k < 3; ++k) {
            EXPECT_NEAR(found.origin[k], origin[k], 1e-13) << i;
            for (int j = 0; j < 3; ++j) {
                EXPECT_NEAR(found.axes[k][j], axes[k][j], 1e-14) << i;
            }
        }
    }
}

TEST(Reversal, ShapesMediaAndStopsFollow) {
    const auto turned = turned_round(tilted_lens());
    ASSERT_EQ(turned.surfaces.size(), 3u);
    EXPECT_EQ(turned.medium_before.name, "water");
    EXPECT_EQ(turned.surfaces[0].medium_after.name, "air");
    EXPECT_EQ(turned.surfaces[1].medium_after.name, "glass");
    EXPECT_EQ(turned.surfaces[2].medium_after.name, "oil");
    EXPECT_EQ(turned.surfaces[0].curvature, -0.005);
    EXPECT_EQ(turned.surfaces[0].semi_diameter, 7);
    EXPECT_EQ(turned.surfaces[1].curvature, 0.01);
    EXPECT_EQ(turned.surfaces[1].conic, -1.5);
    EXPECT_EQ(turned.surfaces[1].role, PrescribedSurface::Role::aperture_stop);
    EXPECT_EQ(turned.surfaces[2].curvature, -0.02);
    EXPECT_EQ(turned.surfaces[2].aspheric[0], -1e-5);
    EXPECT_EQ(turned.surfaces[2].thickness, 0);
}

TEST(Reversal, TwiceIsTheLensItself) {
    auto lens = tilted_lens();
    lens.surfaces[1].breaks.clear();
    EXPECT_EQ(prescription_text(turned_round(turned_round(lens))), prescription_text(lens));
}

} // namespace
} // namespace vkfv::optics
