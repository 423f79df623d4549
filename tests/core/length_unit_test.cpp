#include "core/parsing/length_unit.hpp"

#include <gtest/gtest.h>

#include <initializer_list>

namespace vkfv {
namespace {

void expect_size(double mm, std::initializer_list<const char*> names) {
    for (const char* name : names) {
        EXPECT_EQ(mm_per_length_unit(name), mm) << name;
    }
}

TEST(LengthUnit, HasTheSizeOfItsSymbolOrName) {
    expect_size(1e6, {"km", "kilometer"});
    expect_size(1e3, {"m", "metre", "Metres"});
    expect_size(1, {"mm", "MM", "millimeters"});
    expect_size(1e-3, {"um", "UM", "\u00b5m", "\u03bcm", "\xB5m", "\xE6m", "\\u00B5m", "micron", "Microns",
                       "micrometer", "Micrometres"});
    expect_size(1e-6, {"nm", "NM", "nanometre"});
    expect_size(1e-7, {"\u00c5", "\u212b", "Angstrom"});
    expect_size(1e-9, {"pm", "picometers"});
    expect_size(25.4, {"in", "inch", "INCH", "inches"});
    expect_size(304.8, {"ft"});
    expect_size(0.0254, {"mil", "mils"});
}

TEST(LengthUnit, IsNoneForOtherWords) {
    for (const char* name :
         {"", "M", "Mm", "Nm", "s", "pixel", "reference frame", "metres per second", "um2", "thermometer"}) {
        EXPECT_EQ(mm_per_length_unit(name), std::nullopt) << name;
    }
}

} // namespace
} // namespace vkfv
