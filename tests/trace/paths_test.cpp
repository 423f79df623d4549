// The host in double and the device in float trace the same paths one by one, and gate and ledger keep their promises.
#include "trace/device/device_tracer.hpp"
#include "trace/host/host_tracer.hpp"
#include "trace/microscope.hpp"

#include "support/statistics.hpp"

#include <gtest/gtest.h>

#include <map>

using namespace vkfv;
using namespace vkfv::physics::f64;

namespace {

trace::TraceOptions options(trace::Traversal traversal = trace::Traversal::quadtree) {
    trace::TraceOptions result;
    result.rays = 200000;
    result.seed = 3;
    result.max_bounces = 3;
    result.traversal = traversal;
    return result;
}

constexpr double focal_height = 0.002;
constexpr std::uint32_t paths = 120000;

bool same_fate(const trace::PathEnd& a, const trace::PathEnd& b) {
    return a.status == b.status && a.surface == b.surface;
}

} // namespace

// Statuses are the same but for paths that pass an edge, a facet's border or an acceptance threshold within float
// rounding. In object space the float error of a train is 4 nm rms and 25 nm at most (measured on prototypes), so those
// change their fate or place in double too when the source is scaled by up to 1e-4 (10 nm at the field's edge) or the
// focus moved by up to 20 nm. Positions: at the detector, ten times larger, 0.5 um bounds every other path.
TEST(Paths, HostAndDeviceTraceTheSamePaths) {
    const auto instrument = test::microscope();
    const auto specimen = test::steep_specimen(0.65);
    const auto host = trace::host_paths(instrument, specimen, options(), focal_height, 7, 0, paths);
    for (const auto traversal : {trace::Traversal::quadtree, trace::Traversal::ray_query}) {
        const auto device = trace::device_paths(instrument, specimen, options(traversal), focal_height, 7, 0, paths);
        std::map<std::uint32_t, int> fates;
        int differing = 0, unexplained = 0, far = 0, detected = 0;
        std::vector<std::uint32_t> suspects;
        for (std::uint32_t k = 0; k < paths; ++k) {
            fates[host[k].status] += 1;
            const bool arrived = host[k].status == PATH_DETECTED || host[k].status == PATH_OFF_DETECTOR;
            if (!same_fate(host[k], device[k])) {
                suspects.push_back(k);
                ++differing;
            } else if (arrived) {
                ++detected;
                if (std::hypot(host[k].x - device[k].x, host[k].y - device[k].y) > 0.5e-3) {
                    suspects.push_back(k);
                    ++far;
                }
            }
        }
        for (const std::uint32_t k : suspects) {
            bool explained = false;
            for (const auto& [scale, height] : std::vector<std::pair<double, double>>{{0x1p-21, 0},
                                                                                      {-0x1p-21, 0},
                                                                                      {1e-5, 0},
                                                                                      {-1e-5, 0},
                                                                                      {4e-5, 0},
                                                                                      {-4e-5, 0},
                                                                                      {1e-4, 0},
                                                                                      {-1e-4, 0},
                                                                                      {0, 5e-6},
                                                                                      {0, -5e-6},
                                                                                      {0, 2e-5},
                                                                                      {0, -2e-5}}) {
                const auto moved =
                    trace::host_paths(instrument, specimen, options(), focal_height + height, 7, k, 1, 1 + scale);
                const bool same =
                    same_fate(moved[0], host[k]) && std::hypot(moved[0].x - host[k].x, moved[0].y - host[k].y) < 0.5e-3;
                explained = explained || !same;
            }
            unexplained += explained ? 0 : 1;
        }
        // The test must have seen every kind of end it is about.
        EXPECT_GT(detected, 3000);
        EXPECT_GT(fates[PATH_ESCAPED], 1000);
        EXPECT_GT(fates[PATH_BOUNCE_LIMIT], 10);
        EXPECT_GT(fates[PATH_VIGNETTED], 1000);
        EXPECT_LE(differing, static_cast<int>(paths / 2000));
        EXPECT_LE(far, static_cast<int>(paths / 2000));
        EXPECT_EQ(unexplained, 0) << differing << " differing, " << far << " far of " << detected;
    }
}

// The wrong twin: a device that traced other paths would be found out.
TEST(Paths, OtherPathsDoNotPassForTheSame) {
    const auto instrument = test::microscope();
    const auto specimen = test::rough_specimen();
    const auto host = trace::host_paths(instrument, specimen, options(), focal_height, 7, 0, 2000);
    const auto device = trace::device_paths(instrument, specimen, options(), focal_height, 8, 0, 2000);
    int differing = 0;
    for (std::size_t k = 0; k < host.size(); ++k) {
        differing += same_fate(host[k], device[k]) ? 0 : 1;
    }
    EXPECT_GT(differing, 200);
}

// With the gate wide open the detections are the same, one by one. A gate shrunk by a tenth loses some.
TEST(Paths, TheGateTurnsNoDetectedLightAway) {
    const auto instrument = test::microscope();
    const auto specimen = test::plane_specimen(0.3);
    auto open = instrument;
    open.constants.gate_radius = 1e6;
    auto narrow = instrument;
    narrow.constants.gate_radius *= 0.9;
    const auto detections = [&](const optics::Instrument& with) {
        std::vector<std::uint32_t> found;
        const auto ends = trace::host_paths(with, specimen, options(), focal_height, 7, 0, paths);
        for (std::uint32_t k = 0; k < paths; ++k) {
            if (ends[k].status == PATH_DETECTED) {
                found.push_back(k);
            }
        }
        return found;
    };
    const auto gated = detections(instrument);
    EXPECT_GT(gated.size(), 1000u);
    EXPECT_EQ(gated, detections(open));
    EXPECT_LT(detections(narrow).size(), gated.size());
}
