// Numbers and units as a reader writes them.
#include "report/reader_text.hpp"

#include <gtest/gtest.h>

#include <cmath>

namespace vkfv::report {
namespace {

TEST(ReaderText, NumbersHaveFourDigits) {
    EXPECT_EQ(reader_number(0), "0");
    EXPECT_EQ(reader_number(5), "5");
    EXPECT_EQ(reader_number(-1.23456), "−1.235");
    EXPECT_EQ(reader_number(0.99996), "1");
    EXPECT_EQ(reader_number(0.012345678), "0.01235");
    EXPECT_EQ(reader_number(123456), "123500");
    EXPECT_EQ(reader_number(2600), "2600");
    EXPECT_EQ(reader_number(1.3e7), "1.3 × 10⁷");
    EXPECT_EQ(reader_number(-9.38217e-12), "−9.382 × 10⁻¹²");
    EXPECT_EQ(reader_number(NAN), "–");
    EXPECT_EQ(reader_number(INFINITY), "–");
}

TEST(ReaderText, UncertaintySaysHowManyDigitsThereAre) {
    EXPECT_EQ(reader_number(5.01234, 0.0131), "5.012 ± 0.013");
    EXPECT_EQ(reader_number(5.01234, 0.12), "5.01 ± 0.12");
    EXPECT_EQ(reader_number(-0.5, 0.25), "−0.50 ± 0.25");
    EXPECT_EQ(reader_number(5.01234, 0), "5.012");
    EXPECT_EQ(reader_number(5.01234, NAN), "5.012");
    EXPECT_EQ(reader_number(5.01234, 2e-6), "5.012 ± 2e-06");
    EXPECT_EQ(reader_number(512.3, 25), "512 ± 25");
}

TEST(ReaderText, CountsStandInGroups) {
    EXPECT_EQ(reader_count(4096), "4096");
    EXPECT_EQ(reader_count(13000000), "13\u202f000\u202f000");
    EXPECT_EQ(reader_count(-51200), "−51\u202f200");
}

TEST(ReaderText, UnitsAndLabels) {
    EXPECT_EQ(reader_unit("um3_per_um2"), "µm³/µm²");
    EXPECT_EQ(reader_unit("deg"), "°");
    EXPECT_EQ(reader_unit("unknown"), "unknown");
    EXPECT_EQ(reader_label("z_step_um"), "z step / µm");
    EXPECT_EQ(reader_label("rays_per_image"), "rays per image");
    EXPECT_EQ(reader_label("um"), "um");
}

} // namespace
} // namespace vkfv::report
