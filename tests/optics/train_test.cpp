#include "optics/train/train.hpp"

#include "core/mathematics/units.hpp"
#include "parts.hpp"
#include "support/statistics.hpp"

#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <random>

namespace vkfv::optics {
namespace {

using physics::f64::PATH_ALIVE;
using physics::f64::PATH_INTERFACE_LOSS;
using physics::f64::Ray;

// The achromat of tests/references/trace_decentred_doublet.py.
Prescription decentred_doublet() {
    Prescription lens;
    lens.name = "doublet";
    lens.medium_before = Medium::air();
    const CoordinateBreak first{.decentre_x = 1.5, .decentre_y = -0.8, .tilt_x = 0.10, .tilt_y = -0.15, .tilt_z = 0.40};
    const CoordinateBreak last{.decentre_x = 0.2, .decentre_y = 0.1, .tilt_x = 0.03, .tilt_y = 0.02, .tilt_z = -0.10};
    lens.surfaces = {test::prescribed(1 / 91.62, 5.7, Medium::constant("N-BK7", 1.5168), {first}),
                     test::prescribed(1 / -66.68, 2.2, Medium::constant("SF5", 1.6727)),
                     test::prescribed(1 / -197.7, 0, Medium::air(), {last})};
    return lens;
}

std::vector<PlacedSurface> placed(const Prescription& prescription, const Interfaces& interfaces = {}) {
    Pose end;
    return place_prescription(prescription, Spectrum::line(test::d_line_um), interfaces, Pose{}, end);
}

std::vector<physics::f64::Surface> linked(std::vector<PlacedSurface> part) {
    link(part, Pose{});
    return surfaces_of(part);
}

// The expected values are printed by tests/references/trace_decentred_doublet.py: x, y on the plane z = 150 mm,
// direction cosines, optical path.
TEST(Train, DecentredDoubletAgreesWithAnIndependentTracer) {
    struct Row {
        glm::dvec3 position;
        glm::dvec3 direction;
        std::array<double, 6> expected;
    };
    const std::array<Row, 5> rows = {{
        {{0, 0, -10},
         {0, 0, 1},
         {-1.9562506657359093, 0.82433634295914171, -0.011012205516336068, 0.0079406485322634779, 0.99990783446803355,
          164.50842134514818}},
        {{5, 3, -10},
         {0.02, -0.03, 1},
         {0.91429761252763297, -3.604242662545234, -0.027536812370776931, -0.040735716910979006, 0.99879043113768651,
          164.52094125820153}},
        {{-6, 2, -10},
         {-0.05, 0.04, 1},
         {-9.3791273235707653, 6.7393212586162559, -0.017001420947070287, 0.031596741174126843, 0.99935609150740479,
          164.53928260695005}},
        {{1, -8, -10},
         {0.08, 0.06, 1},
         {9.8570519362409286, 9.8334045947835307, 0.056358670179358236, 0.11851646771497486, 0.99135137422408459,
          165.55249079762098}},
        {{7, -7, -10},
         {-0.11, 0.02, 1},
         {-17.990240542936725, 3.8785500637643233, -0.15795241723953962, 0.073950903186719957, 0.98467370118534969,
          166.45477286352121}},
    }};
    const auto worst = [&](const Prescription& lens) {
        auto part = placed(lens);
        part.push_back(dummy_plane({}, Pose{}.along_z(150), "screen"));
        const auto train = linked(part);
        double position = 0;
        double direction = 0;
        for (const Row& row : rows) {
            const auto result = test::trace(train, row.position, row.direction);
            EXPECT_EQ(result.status, PATH_ALIVE);
            const auto& [x, y, l, m, n, path] = row.expected;
            const Ray& ray = result.ray;
            position = std::max({position, std::abs(ray.position.x - x), std::abs(ray.position.y - y),
                                 std::abs(ray.path_length - path)});
            direction = std::max({direction, std::abs(ray.direction.x - l), std::abs(ray.direction.y - m),
                                  std::abs(ray.direction.z - n)});
        }
        return std::pair(position, direction);
    };
    const auto [position, direction] = worst(decentred_doublet());
    EXPECT_LT(position, 1e-9); // mm
    EXPECT_LT(direction, 1e-12);
    auto twin = decentred_doublet();
    std::swap(twin.surfaces[0].breaks[0].tilt_x, twin.surfaces[0].breaks[0].tilt_y);
    EXPECT_GT(worst(twin).first, 0.1);
    twin = decentred_doublet();
    twin.surfaces[2].breaks[0].tilt_first = true;
    EXPECT_GT(worst(twin).first, 1e-5);
}

// A ray is brought into the frame of a tilted and decentred surface by hand.
TEST(Train, LinkBringsARayIntoEachSurfacesFrame) {
    const Pose pose = Pose{{0.4, -0.3, 12}}.turned({.tilt_x = 0.2, .tilt_y = -0.1, .tilt_z = 0.5});
    const Pose entry = Pose{{-0.2, 0.1, 3}}.turned({.tilt_y = 0.07});
    PlacedSurface sphere;
    sphere.surface = test::surface(1 / 30.0, 0, 1, 1.6, -0.5);
    sphere.pose = pose;
    std::vector<PlacedSurface> part = {sphere};
    link(part, entry);
    EXPECT_TRUE(is_displaced(part.front().surface));
    const glm::dvec3 position(1, 2, -4);
    const glm::dvec3 direction = glm::normalize(glm::dvec3(0.05, -0.04, 1));
    const auto through = test::trace(surfaces_of(part), position, direction);
    const glm::dvec3 global = entry.point(position) - pose.origin;
    const auto by_hand = test::trace({sphere.surface}, glm::transpose(pose.axes) * global,
                                     glm::transpose(pose.axes) * entry.direction(direction));
    EXPECT_LT(glm::length(through.ray.position - by_hand.ray.position), 1e-14);
    EXPECT_LT(glm::length(through.ray.direction - by_hand.ray.direction), 1e-15);
    EXPECT_NEAR(through.ray.path_length, by_hand.ray.path_length, 1e-14);

    // A step along z alone is no displacement; a train in line carries no rounding of its transfers.
    Pose end;
    auto straight = place_prescription(load_prescription("10x_0.28", "objectives", test::source_folder()),
                                       Spectrum::line(test::d_line_um), {}, Pose{{0, 0, 1.0 / 3}}, end);
    link(straight, Pose{});
    for (const PlacedSurface& surface : straight) {
        EXPECT_FALSE(is_displaced(surface.surface));
    }
}

// The reversed train takes the light back along its way.
TEST(Train, ReversedTakesLightBack) {
    auto forward = placed(decentred_doublet());
    const Pose screen = Pose{}.along_z(150);
    forward.insert(forward.begin(), dummy_plane({}, Pose{}, "start"));
    forward.push_back(dummy_plane({}, screen, "screen"));
    auto backward = reversed(forward);
    link(backward, screen.half_turn());
    const auto turned = [](glm::dvec3 v) { return glm::dvec3(v.x, -v.y, -v.z); };
    for (const double height : {-6.0, 0.0, 3.0}) {
        const auto there = test::trace(linked(forward), {height, 1, 0}, {0.03, -0.02, 1});
        const auto back = test::trace(surfaces_of(backward), turned(there.ray.position), turned(-there.ray.direction));
        ASSERT_EQ(back.status, PATH_ALIVE);
        EXPECT_LT(glm::length(turned(back.ray.position) - glm::dvec3(height, 1, 0)), 1e-12);
        EXPECT_LT(glm::length(turned(back.ray.direction) + glm::normalize(glm::dvec3(0.03, -0.02, 1))), 1e-13);
        EXPECT_NEAR(back.ray.path_length, there.ray.path_length, 1e-12);
    }
}

TEST(Train, MarksItsInterfaces) {
    using namespace physics::f64;
    const auto flags = [](Interfaces::Model model) {
        const auto part =
            placed(decentred_doublet(),
                   {.model = model, .layer = Medium::constant("MgF2", 1.38), .design_wavelength_um = 0.55});
        return std::array{part[0].surface.flags, part[1].surface.flags, part[2].surface.flags};
    };
    EXPECT_EQ(flags(Interfaces::Model::ideal), (std::array{0u, 0u, 0u}));
    EXPECT_EQ(flags(Interfaces::Model::fresnel), (std::array{SURFACE_FRESNEL, SURFACE_FRESNEL, SURFACE_FRESNEL}));
    // Two cemented glasses meet without a layer.
    EXPECT_EQ(flags(Interfaces::Model::quarter_wave), (std::array{SURFACE_LAYER, SURFACE_FRESNEL, SURFACE_LAYER}));
    EXPECT_EQ(dummy_plane({}, Pose{}, "").surface.flags, 0u);
}

// Each of the ten surfaces of five plates of N-BK7 lets 1 - ((n - 1) / (n + 1))^2 pass.
TEST(Train, TenUncoatedSurfacesTransmitTheirProduct) {
    Prescription plates;
    plates.medium_before = Medium::air();
    for (int plate = 0; plate < 5; ++plate) {
        plates.surfaces.push_back(test::prescribed(0, 2, Medium::constant("N-BK7", 1.5168)));
        plates.surfaces.push_back(test::prescribed(0, 1, Medium::air()));
    }
    const auto train = linked(placed(plates, {.model = Interfaces::Model::fresnel}));
    const Ray ray{.position = {0.3, 0, -1}, .direction = {0, 0, 1}, .path_length = 0};
    const auto trace = [&](double survival) {
        return physics::f64::trace_train(TrainScene{.surfaces = train}, 0, 10, ray, 1, 1,
                                         {.spectral = 0, .wave_number = 1 / 0.5876, .survival = survival});
    };
    const double expected = std::pow(1 - std::pow(0.5168 / 2.5168, 2), 10);
    EXPECT_NEAR(trace(0).transmitted, expected, 1e-14);
    EXPECT_NEAR(expected, 0.650, 5e-4); // its value, by hand
    // Each uniform number stands for a ray: either it passes, or it ends somewhere.
    constexpr int rays = 400000;
    std::mt19937_64 generator(3);
    std::uniform_real_distribution<double> uniform(0, 1);
    std::array<double, 10> lost{};
    double passed = 0;
    for (int i = 0; i < rays; ++i) {
        const auto result = trace(uniform(generator));
        if (result.status == PATH_ALIVE) {
            passed += 1;
        } else {
            ASSERT_EQ(result.status, PATH_INTERFACE_LOSS);
            lost[static_cast<std::size_t>(result.surface)] += 1;
        }
    }
    EXPECT_LT(test::share_z(passed, rays, expected), 4); // false positives: 6e-5
    // The wrong twin has one surface more.
    EXPECT_GT(test::share_z(passed, rays, expected * (1 - std::pow(0.5168 / 2.5168, 2))), 4);
    for (int i = 0; i < 10; ++i) {
        const double share = std::pow(expected, i / 10.0) * (1 - std::pow(expected, 0.1));
        EXPECT_LT(test::share_z(lost[static_cast<std::size_t>(i)], rays, share), 4.5) << i; // ten of 7e-6
    }
}

} // namespace
} // namespace vkfv::optics
