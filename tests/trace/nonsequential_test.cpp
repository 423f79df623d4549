// Light that finds its own way makes the sequential image without Fresnel's reflections, agrees with closed forms with
// them, and closes the ledger; the device agrees with the host.
#include "optics/instrument/room.hpp"
#include "support/statistics.hpp"
#include "trace/device/device_tracer.hpp"
#include "trace/elements.hpp"
#include "trace/host/host_tracer.hpp"
#include "trace/same_paths.hpp"

#include <gtest/gtest.h>

#include <array>
#include <cmath>

using namespace vkfv;
using namespace vkfv::physics::f64;
using namespace vkfv::test;

TEST(Nonsequential, WithoutFresnelItGivesTheSequentialImage) {
    const auto description = coarse_microscope();
    const auto instrument = optics::assemble(description);
    const auto specimen = smooth_specimen();
    constexpr double level = 1e-4; // false-positive rate of each comparison
    const auto sequential =
        trace::make_device_tracer(instrument, specimen, options(trace::Traversal::quadtree, false))->expose(0.001, 2);
    const auto by_bvh =
        trace::make_device_tracer(instrument, specimen, options(trace::Traversal::bvh))->expose(0.001, 3);
    EXPECT_GT(same_expectation_p(sequential, by_bvh), level);
    EXPECT_GT(by_bvh.detected, 5000u);
    const auto by_ray_query =
        trace::make_device_tracer(instrument, specimen, options(trace::Traversal::ray_query))->expose(0.001, 3);
    // The two traversals trace the same paths: the counts are the same but for paths within float rounding of an edge.
    EXPECT_NEAR(static_cast<double>(by_ray_query.detected), static_cast<double>(by_bvh.detected), 10);
    // The wrong twin is a splitter of 0.35 / 0.65, which passes 9 % less.
    auto other = description;
    other.splitter.reflectance = 0.35;
    other.splitter.transmittance = 0.65;
    auto twin_options = options(trace::Traversal::quadtree, false);
    twin_options.rays *= 4;
    const auto twin = trace::make_device_tracer(optics::assemble(other), specimen, twin_options)->expose(0.001, 2);
    double sum = 0;
    double twin_sum = 0;
    for (std::size_t k = 0; k < twin.flux.values.size(); ++k) {
        sum += by_bvh.flux.values[k];
        twin_sum += twin.flux.values[k];
    }
    const double sum_z = (sum - twin_sum) / (sum / std::sqrt(static_cast<double>(by_bvh.detected)));
    EXPECT_GT(std::abs(sum_z), 4);
}

TEST(Nonsequential, TheLedgerClosesWithGhosts) {
    auto description = coarse_microscope();
    description.interfaces.model = optics::Interfaces::Model::fresnel;
    const auto instrument = optics::assemble(description);
    for (const auto traversal : {trace::Traversal::bvh, trace::Traversal::ray_query}) {
        const auto image =
            trace::make_device_tracer(instrument, smooth_specimen(), options(traversal))->expose(0.001, 2);
        EXPECT_LT(std::abs(image.ledger.residual()), 1e-12 * image.ledger.emitted);
        std::uint64_t rays = 0;
        for (const auto& entry : image.ledger.entries) {
            rays += entry.name.starts_with("beam splitter,") ? 0 : entry.rays;
            EXPECT_FALSE(entry.name == "under way" && entry.rays > 0);
        }
        EXPECT_EQ(rays, image.rays);
        EXPECT_GT(image.detected, 1000u);
    }
}

TEST(Nonsequential, HostAndDeviceTraceTheSamePaths) {
    auto description = coarse_microscope();
    description.interfaces.model = optics::Interfaces::Model::fresnel;
    expect_same_paths(optics::assemble(description));
}

// Five uncoated plates of N-BK7 at normal incidence with all multiple reflections pass (1 - R) / (1 + 9 R): G. G.
// Stokes, Proc. R. Soc. 11 (1862) 545. Single passes alone (the sequential mode) would leave (1 - R)^10.
TEST(Nonsequential, FivePlatesPassWhatStokesSays) {
    constexpr double index = 1.5168;
    Bench bench;
    for (int plate = 0; plate < 5; ++plate) {
        bench.add_plate(optics::Pose{}.along_z(2.0 * plate), 1.0, index);
    }
    bench.add_detector(20);
    constexpr double reflectance = (index - 1) * (index - 1) / ((index + 1) * (index + 1));
    const double expected = (1 - reflectance) / (1 + 9 * reflectance);
    EXPECT_NEAR(expected, 0.694, 5e-4);
    constexpr std::uint32_t paths = 40000;
    const double share = detected_share(trace_bench(bench, pencil(1, 4), paths));
    EXPECT_LT(test::share_z(share * paths, paths, expected), 4); // false-positive rate 6e-5
    EXPECT_GT(test::share_z(share * paths, paths, std::pow(1 - reflectance, 10)), 4);
}

// Light reflected twice inside a plate leaves parallel to the light that passes, t 2 cos(theta) tan(theta') beside it,
// with R^2 of its power; and twice as far with R^4.
TEST(Nonsequential, ThePlatesGhostHasItsPlaceAndStrength) {
    constexpr double index = 2.0;
    constexpr double thickness = 3.0;
    const double theta = 20 * pi / 180;
    const double refracted = std::asin(std::sin(theta) / index);
    Bench bench;
    bench.add_plate(optics::Pose{}.turned({.tilt_x = theta}), thickness, index);
    bench.add_detector(10);
    // A turn of the plate about x leans its normal to -y: passing light is moved to -y, and each ghost further to +y.
    const double passes_at = -thickness * std::sin(theta - refracted) / std::cos(refracted);
    const double step = 2 * thickness * std::cos(theta) * std::tan(refracted);
    const double s = std::pow(std::sin(theta - refracted) / std::sin(theta + refracted), 2);
    const double p = std::pow(std::tan(theta - refracted) / std::tan(theta + refracted), 2);
    const double reflectance = 0.5 * (s + p); // unpolarised at each interface
    constexpr std::uint32_t paths = 300000;
    std::array<double, 3> seen{};
    std::array<double, 3> place{};
    for (const Detection& end : trace_bench(bench, pencil(10, 4), paths)) {
        if (end.fate.status != PATH_DETECTED) {
            continue;
        }
        const auto order = static_cast<std::size_t>(std::lround(std::abs(end.y - passes_at) / step));
        if (order < seen.size()) {
            seen[order] += 1;
            place[order] += end.y;
        }
    }
    const double through = (1 - reflectance) * (1 - reflectance);
    for (std::size_t order = 0; order < seen.size(); ++order) {
        const double share = through * std::pow(reflectance, 2.0 * static_cast<double>(order));
        EXPECT_LT(test::share_z(seen[order], paths, share), 4) << order;
        // The pencil's centre is known to its radius over the root of twice the counts.
        const double tolerance = 5 * 0.01 / std::sqrt(4 * seen[order]);
        EXPECT_NEAR(std::abs(place[order] / seen[order] - passes_at), static_cast<double>(order) * step, tolerance)
            << order;
    }
    // The wrong twin has the reflectance at normal incidence.
    EXPECT_GT(test::share_z(seen[1], paths, through * std::pow(1.0 / 9, 2) * 1.1), 4);
}

// Beyond a lens' edge lies its mount, and no light passes beside the barrels to the detector.
TEST(Nonsequential, NothingPassesBesideTheLenses) {
    auto description = coarse_microscope();
    description.splitter.semi_diameter = 25;
    const auto instrument = optics::assemble(description);
    const auto room = optics::furnish(instrument);
    std::uint32_t reached = 0;
    // Rays go up from the specimen's plane at all angles, from beside the objective too.
    for (int i = 0; i < 40; ++i) {
        for (int j = -40; j <= 40; ++j) {
            const glm::dvec3 origin(0.05 + 0.5 * i, 0, 0);
            const double angle = j * 0.03;
            const glm::dvec3 direction(std::sin(angle), 0, std::cos(angle));
            const auto hit = optics::nearest_element(room, origin, direction, {-1, -1, -1});
            // Rays meet the objective first, never what stands behind it, unless the ray passes outside its barrel.
            if (hit.index >= 0 && room.names[static_cast<std::size_t>(hit.index)].starts_with("detector")) {
                const double at_detector = origin.x + std::tan(angle) * 327;
                EXPECT_GT(std::abs(origin.x + std::tan(angle) * 16), 7) << at_detector;
                ++reached;
            }
        }
    }
    EXPECT_EQ(reached, 0u);
}
