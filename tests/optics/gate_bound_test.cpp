// The pupil's gate, found by samples, holds all light of the field that reaches the detector's plane: proved by bounds
// for every objective of the library but the 100x, whose proof takes ten times as long as all others (it holds too).
#include "optics/train/bundle.hpp"

#include "core/mathematics/units.hpp"
#include "optics/train/train.hpp"
#include "parts.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <queue>

namespace vkfv::optics {
namespace {

// The gate of physics::Instrument for rays that start on the object plane, seen from the planes that the specimen's top
// takes.
struct Gate {
    double position = 0; // 1/mm
    std::array<double, 2> heights{};

    // The largest |position * place + (1 + position * height) * slope| in a box. Its square is convex in place and
    // slope and linear in the cosine between them, so that the box's corners hold it.
    double largest_in(const EmissionBox& box) const {
        const auto& [low, high] = box[azimuth]; // within a half turn, where the cosine falls
        double largest = 0;
        for (const double height : heights) {
            for (const double start : {box[from_axis].low, box[from_axis].high}) {
                for (const double sine : {box[from_middle].low, box[from_middle].high}) {
                    const double cosine = std::sqrt(std::max(1 - sine * sine, 1e-32));
                    for (const double between : {low, high}) {
                        const double slope = (1 + position * height) * sine / cosine;
                        largest = std::max(largest, std::hypot(position * start + slope * std::cos(between),
                                                               slope * std::sin(between)));
                    }
                }
            }
        }
        return largest;
    }
};

// Light of the field, on its way through an imaging train.
struct FieldLight {
    std::vector<physics::f64::Surface> train;
    double working_distance = 0; // mm, to the frame that the train is entered in
    double field_radius = 0;     // mm

    // Whether the ray in the middle of the box passes the train.
    bool passes_from(const EmissionBox& box) const {
        auto emitted = ray_in(box, {}, {});
        if (!emitted) {
            return false;
        }
        emitted->ray.position.z -= working_distance;
        return trace_through(train, emitted->ray, 1).status == physics::f64::PATH_ALIVE;
    }
};

enum class Verdict { holds, loses, unknown };

// Whether any ray of the field passes outside of the radius.
Verdict holds_all(const FieldLight& light, const Gate& gate, double radius) {
    const BundleTracer tracer(light.train, light.working_distance);
    EmissionBox whole{};
    whole[from_axis] = {0, light.field_radius};
    whole[from_middle] = {0, 1};
    whole[azimuth] = {0, pi};
    const auto is_nearer = [&](const EmissionBox& a, const EmissionBox& b) {
        return gate.largest_in(a) < gate.largest_in(b);
    };
    std::priority_queue<EmissionBox, std::vector<EmissionBox>, decltype(is_nearer)> left(is_nearer);
    left.push(whole);
    constexpr int most_boxes = 150000;
    for (int boxes = 0; boxes < most_boxes && !left.empty(); ++boxes) {
        EmissionBox box = left.top();
        left.pop();
        if (gate.largest_in(box) <= radius) {
            continue;
        }
        // Sines below which the whole box is within the gate need not be excluded.
        Range within = {box[from_middle].low, box[from_middle].high};
        for (int bisection = 0; bisection < 30; ++bisection) {
            EmissionBox part = box;
            part[from_middle].high = within.middle();
            (gate.largest_in(part) <= radius ? within.low : within.high) = within.middle();
        }
        box[from_middle].low = within.low;
        if (const auto cut = tracer.may_pass(box)) {
            EmissionBox middle = box;
            for (Range& side : middle) {
                side = {side.middle(), side.middle()};
            }
            if (gate.largest_in(middle) > radius && light.passes_from(box)) {
                return Verdict::loses;
            }
            EmissionBox lower = box;
            EmissionBox upper = box;
            lower[*cut].high = upper[*cut].low = box[*cut].middle();
            left.push(lower);
            left.push(upper);
        }
    }
    return left.empty() ? Verdict::holds : Verdict::unknown;
}

class GateBound : public ::testing::TestWithParam<const char*> {};

TEST_P(GateBound, HoldsAllLightOfTheField) {
    const auto description = test::microscope(GetParam());
    const Instrument instrument = assemble(description);
    const auto& constants = instrument.constants;
    const FieldLight light = {
        .train = {instrument.surfaces.begin() + constants.imaging_first, instrument.surfaces.end()},
        .working_distance = instrument.first_order.working_distance,
        .field_radius = std::sqrt(2.0) * instrument.first_order.field_edge};
    const double focus = instrument.first_order.best_focus_offset;
    const Gate gate = {.position = constants.gate_position,
                       .heights = {focus - description.greatest_defocus, focus + description.greatest_defocus}};
    EXPECT_EQ(holds_all(light, gate, constants.gate_radius), Verdict::holds);
    EXPECT_EQ(holds_all(light, gate, 0.95 * constants.gate_radius), Verdict::loses); // wrong twin
}

INSTANTIATE_TEST_SUITE_P(Library, GateBound, ::testing::Values("5x_0.15", "10x_0.28", "20x_0.41", "50x_0.66"),
                         [](const auto& parameter) {
                             std::string name = parameter.param;
                             std::ranges::replace(name, '.', '_');
                             return name;
                         });

} // namespace
} // namespace vkfv::optics
