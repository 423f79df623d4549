#include "physics/physics.hpp"
#include "support/statistics.hpp"

#include <gtest/gtest.h>

using namespace vkfv::physics::f64;

// The known answers published with the generator's reference implementation (Random123, kat_vectors).
TEST(Random, philox_gives_the_published_answers) {
    EXPECT_EQ(philox_4x32_10(uvec4(0u), 0u, 0u), uvec4(0x6627e8d5u, 0xe169c58du, 0xbc57ac4cu, 0x9b00dbd8u));
    const uint ones = 0xffffffffu;
    EXPECT_EQ(philox_4x32_10(uvec4(ones), ones, ones), uvec4(0x408f276du, 0x41c83b0eu, 0xa20bc7c6u, 0x6d5451fdu));
    EXPECT_EQ(philox_4x32_10(uvec4(0x243f6a88u, 0x85a308d3u, 0x13198a2eu, 0x03707344u), 0xa4093822u, 0x299f31d0u),
              uvec4(0xd16cfe09u, 0x94fdccebu, 0x5001e420u, 0x24126ea1u));
}

namespace {

// p-value of a joint histogram of two of the six numbers, over `paths` paths of one seed each.
double joint_p(real Draws::*first, real Draws::*second, bool across_seeds, double exponent) {
    const int side = 16;
    const int draws_made = 200000;
    std::vector<double> seen(side * side), expected(side * side, double(draws_made) / (side * side));
    for (uint k = 0; k < draws_made; ++k) {
        const Draws a = across_seeds ? draw(k, 3u, uvec2(5u, 0u), 0u) : draw(7u, 3u, uvec2(k, 0u), 0u);
        const Draws b = across_seeds ? draw(k + 1, 3u, uvec2(5u, 0u), 0u) : a;
        const int i = static_cast<int>(std::pow(a.*first, exponent) * side);
        const int j = static_cast<int>(b.*second * side);
        seen[i * side + j] += 1;
    }
    return vkfv::test::chi_square_p(seen, expected);
}

} // namespace

// 15 pairs of numbers of a path and 6 of neighbouring seeds; the family errs once in 1000 (seeds are fixed).
TEST(Random, numbers_are_uniform_and_independent_in_pairs) {
    const std::vector<real Draws::*> numbers = {&Draws::u0, &Draws::u1, &Draws::u2,
                                                &Draws::u3, &Draws::u4, &Draws::u5};
    const double level = vkfv::test::sidak(1e-3, 21);
    for (std::size_t i = 0; i < numbers.size(); ++i) {
        for (std::size_t j = i + 1; j < numbers.size(); ++j) {
            EXPECT_GT(joint_p(numbers[i], numbers[j], false, 1.0), level) << i << " " << j;
        }
        EXPECT_GT(joint_p(numbers[i], numbers[i], true, 1.0), level) << i << " across seeds";
    }
    // Wrong twin: u^1.1 is not uniform.
    EXPECT_LT(joint_p(&Draws::u0, &Draws::u1, false, 1.1), level);
}

TEST(Random, every_number_stays_inside_the_open_interval_in_float) {
    EXPECT_GT(vkfv::physics::f32::uniform_from_21_bits(0u), 0.0f);
    EXPECT_LT(vkfv::physics::f32::uniform_from_21_bits(0xffffffffu), 1.0f);
}
