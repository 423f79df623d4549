// Numbers and units are written as a reader writes them.
#include "report/reader_text.hpp"

#include <gmock/gmock.h>
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

TEST(ReaderText, FiguresKeepTheirZeros) {
    EXPECT_EQ(reader_figure(5), "5.000");
    EXPECT_EQ(reader_figure(16.602), "16.60");
    EXPECT_EQ(reader_figure(0.99996), "1.000");
    EXPECT_EQ(reader_figure(9.33e-6), "9.330 × 10⁻⁶");
    EXPECT_EQ(reader_figure(0), "0");
    EXPECT_EQ(reader_figure(NAN), "–");
}

TEST(ReaderText, ADifferenceHasTheDecimalsOfItsOperands) {
    const auto form = form_for({2.741, 2.733037});
    EXPECT_EQ(reader_number(2.733037, form), "2.733");
    EXPECT_EQ(reader_number(-0.007963, form), "−0.008");
    EXPECT_EQ(reader_number(-0.0001, form), "0.000");
    EXPECT_EQ(reader_number(NAN, form), "–");
    EXPECT_EQ(reader_number(7.315669, form_for({7.315669, 11.083817})), "7.32");
    EXPECT_EQ(reader_number(3.1e-8, form_for({1.5e-6, NAN})), "0.031 × 10⁻⁶");
    EXPECT_EQ(reader_number(2.0991, form_for(7.3286, 0.7129)), "2.10");
}

TEST(ReaderText, ADeviationHasFourDigitsToo) {
    using testing::ElementsAre;
    EXPECT_THAT(reader_deviation(2.741, 2.733037), ElementsAre("2.741", "2.733", "−0.008"));
    EXPECT_THAT(reader_deviation(0.51234, -0.50736), ElementsAre("0.512", "−0.507", "−1.020"));
    EXPECT_THAT(reader_deviation(-9.9996, 0.0124), ElementsAre("−10.00", "0.01", "10.01"));
    EXPECT_THAT(reader_deviation(NAN, 0.25), ElementsAre("–", "0.2500", "–"));
}

TEST(ReaderText, NumbersOfAColumnAreAlikeWhereNoneIsLost) {
    using testing::ElementsAre;
    EXPECT_THAT(reader_column({16.602, 17.914, NAN}), ElementsAre("16.60", "17.91", "–"));
    EXPECT_THAT(reader_column({2.678, 1.9}), ElementsAre("2.678", "1.900"));
    EXPECT_THAT(reader_column({0.9988, 9.33e-6}), ElementsAre("0.9988", "9.330 × 10⁻⁶"));
}

TEST(ReaderText, ValuesThatWereSetStandInOneNotation) {
    using testing::ElementsAre;
    EXPECT_THAT(reader_values({"1e4", "5e5", "1e7"}), ElementsAre("10⁴", "5 × 10⁵", "10⁷"));
    EXPECT_THAT(reader_values({"1e4", "20000"}), ElementsAre("10000", "20000"));
    EXPECT_THAT(reader_values({"-0.5", "0.65", "12345.6"}), ElementsAre("−0.5", "0.65", "12345.6"));
    EXPECT_THAT(reader_values({"forward", "backward"}), ElementsAre("forward", "backward"));
}

TEST(ReaderText, UncertaintySaysHowManyDigitsThereAre) {
    EXPECT_EQ(reader_number(5.01234, 0.0131), "5.012 ± 0.013");
    EXPECT_EQ(reader_number(5.01234, 0.12), "5.01 ± 0.12");
    EXPECT_EQ(reader_number(-0.5, 0.25), "−0.50 ± 0.25");
    EXPECT_EQ(reader_number(5.01234, 0), "5.012");
    EXPECT_EQ(reader_number(5.01234, NAN), "5.012");
    EXPECT_EQ(reader_number(5.01234, 2e-6), "5.012 ± 2.0 × 10⁻⁶");
    EXPECT_EQ(reader_number(512.3, 25), "512 ± 25");
    EXPECT_EQ(reader_number(5123.4, 250), "5120 ± 250");
    EXPECT_EQ(reader_number(50.0234, 0.0131), "50.023 ± 0.013");
    EXPECT_EQ(reader_number(-0.6714, 0.7129), "−0.67 ± 0.71");
    EXPECT_EQ(reader_number(1e-9, 0.7), "0.00 ± 0.70");
    EXPECT_EQ(reader_number(1.234e-7, 2e-9), "(1.234 ± 0.020) × 10⁻⁷");
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
