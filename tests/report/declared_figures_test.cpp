// Figures are written by the keys and in the units that assets/schemas declares.
#include "report/declared_figures.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <stdexcept>

namespace vkfv::report {
namespace {

using Json = nlohmann::ordered_json;

TEST(DeclaredFigures, LengthsAreWrittenInMicrometresUnderTheirWholeKey) {
    const Json written = as_declared("results", {{"sq_ratio", 0.5}, {"rms_deviation", 0.002}, {"images", 31}});
    EXPECT_EQ(written.dump(), R"({"sq_ratio":0.5,"rms_deviation_um":2.0,"images":31})");
}

TEST(DeclaredFigures, ObjectsAndListsAreWrittenLikewise) {
    const Json written =
        as_declared("results", {{"curves", {{"height_noise", 0.001}, {"noise_correlation", {0.25, 0.5}}}},
                                {"focus_curves", {{"rows", {3, 4}}, {"z", {-0.001, 0.002}}}},
                                {"parameters", {{"Sq", {{"measured", 0.003}, {"true", 0.004}}}}}});
    EXPECT_EQ(written.dump(), R"({"curves":{"height_noise_um":1.0,"noise_correlation":[0.25,0.5]},)"
                              R"("focus_curves":{"rows":[3,4],"z_um":[-1.0,2.0]},)"
                              R"("parameters":{"Sq_um":{"measured":3.0,"true":4.0}}})");
}

TEST(DeclaredFigures, FiguresOfASweepHaveTheirUnitBehindAStroke) {
    EXPECT_EQ(as_declared("sweep.rows.figures", {{"rms deviation", 0.001}}).dump(), R"({"rms deviation / um":1.0})");
}

TEST(DeclaredFigures, AnglesSharesAndVolumesHaveTheirFactor) {
    EXPECT_NEAR(declared_figure("results.parameters", "Std").factor * 3.14159265358979, 180, 1e-9);
    EXPECT_EQ(declared_figure("results.parameters", "Sdr").factor, 100);
    EXPECT_EQ(declared_figure("results.parameters", "Sdr").unit, "percent");
    EXPECT_EQ(declared_figure("results.parameters", "Vmp").key, "Vmp_um3_per_um2");
    EXPECT_EQ(declared_figure("results.parameters", "Vmp").factor, 1000); // mm^3/mm^2 is mm
    EXPECT_EQ(declared_figure("results.parameters", "Str").factor, 1);
}

TEST(DeclaredFigures, AReferenceHasTheUnitAndTheTitleOfWhatItRefersTo) {
    EXPECT_EQ(declared_figure("results.diffracted.filtered", "rms_deviation").key, "rms_deviation_um");
    EXPECT_EQ(declared_figure("results.diffracted.filtered", "rms_deviation").title, "RMS deviation");
}

TEST(DeclaredFigures, WhatIsNotFiniteBecomesNull) {
    EXPECT_EQ(as_declared("results", {{"rms_deviation", NAN}}).dump(), R"({"rms_deviation_um":null})");
}

TEST(DeclaredFigures, WhatIsNotDeclaredIsAFaultOfTheProgram) {
    EXPECT_THROW(as_declared("results", {{"new", 1.0}}), std::logic_error);
    EXPECT_THROW(as_declared("results", {{"rms", 1.0}}), std::logic_error); // the beginning of a name alone
    EXPECT_THROW(as_declared("results.curves", {{"rms_deviation", 1.0}}), std::logic_error);
    EXPECT_THROW(declared_figure("results.nowhere", "rms_deviation"), std::logic_error);
}

} // namespace
} // namespace vkfv::report
