// The real train is out of focus as geometry says.
#include "trace/device/ray_trace.hpp"
#include "trace/microscope.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

using namespace vkfv;

namespace {

// The diameter in the object of the blur of a point on the axis, `height` above best focus, by rays up to the sine
// `na`.
double blur_diameter(const optics::Instrument& instrument, double height, double na) {
    std::vector<trace::RayInput> rays;
    for (int k = 0; k < 64; ++k) {
        const double phi = 2 * pi * k / 64;
        const double z = instrument.first_order.best_focus_offset + height; // origin: the paraxial plane
        rays.push_back({0, 0, z, na * std::cos(phi), na * std::sin(phi), std::sqrt(1 - na * na)});
    }
    double radius = 0;
    for (const auto& ray : trace::trace_rays_on_host(instrument, rays, false)) {
        radius = std::max(radius, std::hypot(ray.x, ray.y));
    }
    return 2 * radius / std::abs(instrument.first_order.magnification);
}

} // namespace

// A point z out of focus is blurred over 2 z tan(asin NA), exactly so by a lens that obeys the sine condition. This one
// offends it at the rim by 0.27 % (an aperture of 0.2770 where pupil radius over focal length is 0.2778), with the
// square of the aperture; the blur follows the derivative of aperture times offence, three times as much: 0.8 %.
// Spherical aberration cancels to first order in the mean of equal defocus to both sides, and leaves (7 um / 200 um)^2,
// 0.1 %.
TEST(Defocus, TheBlurHasTheDiameterOfTheMarginalCone) {
    const auto instrument = test::microscope();
    const double na = instrument.first_order.numerical_aperture * (1 - 1e-6);
    const double z = 0.2;
    const double mean = 0.5 * (blur_diameter(instrument, z, na) + blur_diameter(instrument, -z, na));
    const double expected = 2 * z * std::tan(std::asin(na));
    EXPECT_NEAR(mean / expected, 1.0, 9e-3);
    EXPECT_GT(std::abs(mean / (2 * z * na) - 1.0), 2e-2); // wrong twin: the sine instead of the tangent
}
