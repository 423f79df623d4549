#include "optics/medium.hpp"

#include "core/error.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>

namespace vkfv::optics {
namespace {

using ::testing::HasSubstr;

TEST(Medium, IsCauchysFormulaThroughItsPoints) {
    const auto cauchy = [](double um) { return 1.5 + 0.0042 / (um * um) + 1e-5 / (um * um * um * um); };
    const std::vector<double> wavelengths_um = {0.486133, 0.587562, 0.656273};
    std::vector<double> indices;
    for (const double um : wavelengths_um) {
        indices.push_back(cauchy(um));
    }
    const Medium medium = Medium::tabulated("glass", wavelengths_um, indices);
    for (std::size_t i = 0; i < 3; ++i) {
        EXPECT_EQ(medium.index(wavelengths_um[i]), indices[i]);
    }
    // Rounding of indices near 1.5, amplified by a few in the range.
    for (const double um : {0.4785, 0.52, 0.6, 0.663}) {
        EXPECT_NEAR(medium.index(um), cauchy(um), 1e-14) << um;
    }
    EXPECT_THROW(medium.index(0.476), InputError);
    EXPECT_THROW(medium.index(0.667), InputError);
    EXPECT_THROW(medium.index(std::nan("")), InputError);
}

TEST(Medium, TakesTheThreeNearestOfMore) {
    // The formula through the lower three is 1.5, through the upper three it is not.
    const Medium medium =
        Medium::tabulated("glass", {0.40, 0.45, 0.50, 0.70, 0.75}, {1.5, 1.5, 1.5, 1.6, 1.6});
    EXPECT_NEAR(medium.index(0.46), 1.5, 1e-14);
    EXPECT_GT(medium.index(0.68), 1.55);
    EXPECT_EQ(Medium::air().index(10.6), 1.0);
}

} // namespace
} // namespace vkfv::optics
