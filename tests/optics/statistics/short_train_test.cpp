// The short form of a train (shaders/physics/short_train.glsl) ends every ray as the long one does.
#include "optics/parts.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <random>
#include <vector>

using namespace vkfv;
using namespace vkfv::physics::f64;

namespace {

struct Train {
    std::vector<Surface> surfaces;
    double start;    // mm, height of the rays' start over the first vertex
    double radius;   // mm, of the disc that they leave
    double steepest; // slope
    double index;    // of the medium that they come through
    unsigned features = 0;
};

std::vector<Surface> part(const optics::Instrument& instrument, int first, int count) {
    return {instrument.surfaces.begin() + first, instrument.surfaces.begin() + first + count};
}

// Trains of two kinds: illumination and imaging of microscopes with aspheres, under rays of which most end on their
// way, and lenses so strong that many rays miss them or are totally reflected.
std::vector<Train> trains() {
    std::vector<Train> result;
    for (const char* objective : {"5x_0.15", "20x_0.41", "100x_0.83"}) {
        const auto instrument = optics::assemble(test::microscope(objective));
        const auto& constants = instrument.constants;
        result.push_back({part(instrument, constants.illumination_first, constants.illumination_count),
                          -constants.source_distance, 3 * constants.source_radius, 1.2, 1});
        result.push_back({part(instrument, constants.imaging_first, constants.imaging_count),
                          -instrument.first_order.working_distance, 3 * instrument.first_order.field_edge,
                          2 * std::tan(std::asin(instrument.first_order.numerical_aperture)), 1});
    }
    for (const double conic : {0.0, -0.6, -1.0, 0.8}) {
        // The train is a ball's two sides, of which the second reflects steep light totally.
        Train ball{{test::surface(0.2, 0, 1, 1.8, conic), test::surface(-0.2, 10, 1.8, 1, conic)}, -3, 4, 1.5, 1};
        ball.surfaces[1].flags = SURFACE_CLIPPED;
        ball.surfaces[1].semi_diameter_squared = 16;
        result.push_back(ball);
        Train asphere = ball;
        asphere.surfaces[0].flags = SURFACE_ASPHERIC;
        asphere.surfaces[0].a4 = 2e-4;
        asphere.surfaces[0].a6 = -1e-6;
        result.push_back(asphere);
    }
    return result;
}

struct Ends {
    std::map<unsigned, int> by_status; // of the long form
    int differing = 0;
    double farthest = 0; // mm, in the frame of the last vertex, of what passes
};

Ends ends_of(const Train& train, unsigned form, int count, unsigned seed, bool apertures = true) {
    const optics::TrainScene scene{.surfaces = train.surfaces, .present = train.features};
    const auto surfaces = static_cast<int>(train.surfaces.size());
    std::mt19937 generator(seed);
    std::uniform_real_distribution<double> uniform(-1, 1);
    Ends ends;
    for (int k = 0; k < count; ++k) {
        const double x = uniform(generator), y = uniform(generator), l = uniform(generator), m = uniform(generator);
        Ray ray{};
        ray.position = {train.radius * x, train.radius * y, train.start};
        ray.direction = glm::normalize(glm::dvec3(train.steepest * l, train.steepest * m, 1)) * train.index;
        const TrainResult exact = trace_train(scene, 0, surfaces, ray, train.index, apertures, Light{});
        const TrainResult found = trace_short_train(scene, 0, surfaces, ray, train.index, Light{}, form);
        ++ends.by_status[exact.status];
        if (exact.status != found.status || exact.surface != found.surface) {
            ++ends.differing;
        } else if (exact.status == PATH_ALIVE) {
            ends.farthest = std::max({ends.farthest, glm::length(exact.ray.position - found.ray.position),
                                      glm::length(exact.ray.direction - found.ray.direction)});
        }
    }
    return ends;
}

TEST(ShortTrain, EndsAMillionRaysAsTheLongFormDoes) {
    std::map<unsigned, int> by_status;
    for (const Train& train : trains()) {
        for (const unsigned form : {SHORT_TRAIN_FINE, SHORT_TRAIN_PLAIN}) {
            const Ends ends = ends_of(train, form, 40000, 3);
            EXPECT_EQ(ends.differing, 0);
            EXPECT_LT(ends.farthest, 1e-9);
            for (const auto& [status, count] : ends.by_status) {
                by_status[status] += count;
            }
        }
    }
    // Every end that a path can have occurs.
    for (const unsigned status : {PATH_ALIVE, PATH_VIGNETTED, PATH_MISSED_SURFACE, PATH_TOTAL_REFLECTION}) {
        EXPECT_GT(by_status[status], 1000) << status;
    }
    // The wrong twin has edges of which one form knows nothing.
    EXPECT_GT(ends_of(trains()[1], SHORT_TRAIN_FINE, 1000, 3, false).differing, 100);
}

TEST(ShortTrain, LeavesWhatItDoesNotKnowToTheLongForm) {
    Train tilted = trains().front();
    tilted.features = FEATURE_PLACEMENT;
    tilted.surfaces[3].decentre_x = 0.5;
    EXPECT_EQ(ends_of(tilted, SHORT_TRAIN_FINE, 20000, 4).differing, 0);
    // In the wrong twin the short form passes the lens where it does not stand.
    const Train straight = trains().front();
    const optics::TrainScene scene{.surfaces = tilted.surfaces, .present = FEATURE_PLACEMENT};
    const optics::TrainScene blind{.surfaces = tilted.surfaces, .present = 0};
    Ray ray{};
    ray.position = {0, 0, straight.start};
    ray.direction = {0, 0, 1};
    const auto count = static_cast<int>(tilted.surfaces.size());
    EXPECT_NE(trace_short_train(scene, 0, count, ray, 1, Light{}, SHORT_TRAIN_FINE).ray.position.x,
              trace_short_train(blind, 0, count, ray, 1, Light{}, SHORT_TRAIN_FINE).ray.position.x);
}

} // namespace
