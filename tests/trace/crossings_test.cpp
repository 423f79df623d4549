// The number of surfaces that an image's light met is counted.
#include "trace/device/device_tracer.hpp"
#include "trace/microscope.hpp"

#include <gtest/gtest.h>

#include <cstdio>

using namespace vkfv;

// The truth is in the names of the ledger's rows, which say where light ended.
TEST(Crossings, AreThoseOfTheLedger) {
    const auto instrument = optics::assemble(test::microscope_description());
    const auto specimen = test::rough_specimen();
    trace::TraceOptions options;
    options.rays = 100000;
    options.traversal = trace::Traversal::quadtree;
    const auto image = trace::make_device_tracer(instrument, specimen, options)->expose(0, 0);
    const double illumination = instrument.constants.illumination_count;
    const double both = illumination + instrument.constants.imaging_count;
    double expected = 0;
    for (const auto& entry : image.ledger.entries) {
        const auto at = entry.name.find(" at ");
        const char* where = at == std::string::npos ? "" : entry.name.c_str() + at;
        int surface = 0;
        double crossings = illumination;
        if (entry.name.starts_with("beam splitter") || entry.name == "not aimed at") {
            crossings = 0; // these rays are counted where they end
        } else if (entry.name == "detected" || entry.name == "beside the detector") {
            crossings = both;
        } else if (std::sscanf(where, " at illumination %d", &surface) == 1) {
            crossings = surface;
        } else if (std::sscanf(where, " at imaging %d", &surface) == 1) {
            crossings = illumination + surface;
        }
        expected += crossings * static_cast<double>(entry.rays);
    }
    EXPECT_EQ(image.crossings, expected); // whole numbers below 2^53
    EXPECT_GT(image.crossings, static_cast<double>(image.rays));
    EXPECT_GT(image.device_seconds, 0);
    EXPECT_LE(image.device_seconds, image.seconds);
}
