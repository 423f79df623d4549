// Warnings: how a key's value is told.
#include "core/messages/warning.hpp"

#include <gtest/gtest.h>

#include <limits>
#include <string>

namespace vkfv {
namespace {

TEST(Warning, NumbersHaveFourDigitsAndStillWork) {
    EXPECT_EQ(number_text(58.0249), "58.02");
    EXPECT_EQ(number_text(58.0249, Rounding::up), "58.03");
    EXPECT_EQ(number_text(-58.0249, Rounding::up), "-58.02");
    EXPECT_EQ(number_text(0.1 + 0.2, Rounding::down), "0.3");
    EXPECT_EQ(number_text(0), "0");
}

// Without bounds the power of ten of a subnormal number's last digit is 0, and the text "-nan".
TEST(Warning, NumbersAtTheEndsOfDoubleAreTold) {
    using limits = std::numeric_limits<double>;
    for (const double value : {limits::denorm_min(), limits::min(), limits::max(), 1e-306, 1e306}) {
        for (const auto rounding : {Rounding::nearest, Rounding::up, Rounding::down}) {
            EXPECT_NEAR(std::stold(number_text(value, rounding)) / static_cast<long double>(value), 1, 0.02) << value;
            EXPECT_EQ(number_text(-value), "-" + number_text(value));
        }
    }
}

} // namespace
} // namespace vkfv
