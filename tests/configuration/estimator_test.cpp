// trace.estimator = "auto", the default, is resolved by the configuration alone, and stack.toml has the word it stands
// for.
#include "configuration/configuration.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <string>

namespace vkfv {
namespace {

using testing::HasSubstr;
using trace::Estimator;

const std::string coaxial = "[source]\nradius_mm = 0.96\nwavelength_um = 0.5876\n"
                            "[objective]\nprescription = \"10x_0.28\"\n[tube_lens]\nprescription = \"200mm\"\n"
                            "[detector]\nsize_mm = 0.16\npixels = 8\n[specimen]\nkind = \"plane\"\nsize_mm = 0.2\n";

std::string ring_over(const std::string& immersion, const std::string& glass) {
    return "[source]\nkind = \"ring\"\nwavelength_um = 0.5876\ndistance_mm = 25.0\nelevation_deg = 30.0\nwidth_mm = "
           "5.0\n"
           "[beam_splitter]\nreflectance = 0.0\ntransmittance = 1.0\n"
           "[objective]\nkind = \"ideal\"\nfocal_length_mm = 20.0\nnumerical_aperture = 0.28\nimmersion = \"" +
           immersion +
           "\"\n[tube_lens]\nkind = \"ideal\"\nfocal_length_mm = 200.0\n"
           "[detector]\nsize_mm = 0.16\npixels = 8\n[specimen]\nkind = \"plane\"\nsize_mm = 0.2\n"
           "[cover_glass]\nthickness_mm = 0.17\nglass = \"" +
           glass + "\"\n";
}

Configuration read(const std::string& text) {
    return read_configuration(TomlTable::parse(text, "c.toml"), Needs::exposure);
}

TEST(EstimatorChoice, IsBackwardWhereLightCanBeTracedSo) {
    for (const std::string& text : {coaxial, coaxial + "[trace]\nestimator = \"auto\"\n",
                                    coaxial + "[trace]\ndevice = \"host\"\n", ring_over("water", "N-BK7")}) {
        const auto configuration = read(text);
        EXPECT_TRUE(configuration.estimator_is_chosen);
        EXPECT_EQ(configuration.trace.estimator, Estimator::backward) << text;
        EXPECT_TRUE(configuration.instrument.turned);
        EXPECT_THAT(configuration.canonical, HasSubstr("estimator = \"backward\"\n"));
        EXPECT_THAT(configuration.identity, HasSubstr("estimator = \"backward\"\n"));
    }
}

TEST(EstimatorChoice, IsForwardElsewhere) {
    for (const std::string& text : {coaxial + "[trace]\nmode = \"nonsequential\"\n",
                                    coaxial + "[trace]\nscattering = \"directed\"\n", ring_over("N-SF11", "N-BK7")}) {
        const auto configuration = read(text);
        EXPECT_TRUE(configuration.estimator_is_chosen);
        EXPECT_EQ(configuration.trace.estimator, Estimator::forward) << text;
        EXPECT_THAT(configuration.identity, HasSubstr("estimator = \"forward\"\n"));
    }
}

TEST(EstimatorChoice, GivesWayToAGivenWord) {
    const auto forward = read(coaxial + "[trace]\nestimator = \"forward\"\n");
    EXPECT_FALSE(forward.estimator_is_chosen);
    EXPECT_EQ(forward.trace.estimator, Estimator::forward);
    EXPECT_THROW((void)read(coaxial + "[trace]\nestimator = \"backward\"\nmode = \"nonsequential\"\n"), InputError);
    const auto chosen = read(coaxial);
    EXPECT_FALSE(read(chosen.canonical).estimator_is_chosen) << "stack.toml names the estimator";
    EXPECT_EQ(read(chosen.canonical).identity, chosen.identity);
}

} // namespace
} // namespace vkfv
