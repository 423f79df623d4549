// A stack as a whole must show more than chance does: its points see the same images in the same order, so that many
// pass at once.
#include "topography/chance.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <vector>

namespace vkfv::topography {
namespace {

constexpr int scan_images = 15;

// Gaussians of standard deviation 1 image around heights 5 to 9 of a smooth specimen.
std::vector<std::vector<double>> curves_of_a_smooth_specimen() {
    std::vector<std::vector<double>> curves;
    for (int place = 0; place < 64; ++place) {
        const double height = 7 + 2 * std::sin(0.1 * place);
        std::vector<double>& curve = curves.emplace_back();
        for (int image = 0; image < scan_images; ++image) {
            curve.push_back(std::exp(-0.5 * (image - height) * (image - height)));
        }
    }
    return curves;
}

std::vector<double> reordered(const std::vector<double>& values, const std::vector<int>& order) {
    std::vector<double> result;
    for (const int image : order) {
        result.push_back(values[static_cast<std::size_t>(image)]);
    }
    return result;
}

TEST(Chance, OfAWholeStackIsWhatIsTold) {
    constexpr double rate = 0.03;
    constexpr int tried = 1000;
    const auto curves = curves_of_a_smooth_specimen();
    const auto order_of = [](int k) {
        return random_order(scan_images, std::uint64_t{1000000} + static_cast<unsigned>(k));
    };

    std::vector<Evidence> points;
    for (int k = 0; k < tried; ++k) {
        const auto values = reordered(curves[static_cast<std::size_t>(k) % curves.size()], order_of(tried + k));
        points.push_back(evidence_of(values, values));
    }
    const ChanceLimit of_points = limit_of(points, rate, scan_images);
    const ChanceLimit of_stack = limit_of_stack(curves, rate);
    int alike = 0, passed = 0;
    double share = 0;
    for (int k = 0; k < tried; ++k) {
        const auto order = order_of(k);
        const auto passing = std::ranges::count_if(curves, [&](const std::vector<double>& curve) {
            const auto values = reordered(curve, order);
            return of_points.exceeded_by(evidence_of(values, values));
        });
        const double here = static_cast<double>(passing) / static_cast<double>(curves.size());
        share += here / tried;
        alike += here > 0.2 ? 1 : 0;
        passed += of_stack.exceeded_by(mean_evidence(curves, order)) ? 1 : 0;
    }
    EXPECT_NEAR(share, rate, 0.02);
    EXPECT_GT(alike, 10 * rate_of_stacks * rate * tried); // the limit of points alone: many pass at once
    EXPECT_NEAR(of_stack.rate, rate_of_stacks * rate, 0.5 * rate_of_stacks * rate);
    EXPECT_LE(passed, 10); // 3 expected
    EXPECT_TRUE(of_stack.exceeded_by(mean_evidence(curves, images_in_order(scan_images))));
}

TEST(Chance, OfCurvesThatVaryByNothingIsNotExceeded) {
    const std::vector<std::vector<double>> curves(3, std::vector<double>(scan_images, 2.0));
    EXPECT_FALSE(limit_of_stack(curves, 0.1).exceeded_by(mean_evidence(curves, images_in_order(scan_images))));
}

} // namespace
} // namespace vkfv::topography
