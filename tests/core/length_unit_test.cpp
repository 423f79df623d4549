#include "core/parsing/length_unit.hpp"

#include <gtest/gtest.h>

namespace vkfv {
namespace {

TEST(LengthUnit, HasTheSizeOfItsSymbolOrName) {
    for (const auto& [name, mm] : std::initializer_list<std::pair<const char*, double>>{{"m", 1e3},
                                                                                        {"mm", 1},
                                                                                        {"um", 1e-3},
                                                                                        {"\u00b5m", 1e-3},
                                                                                        {"\u03bcm", 1e-3},
                                                                                        {"\xB5m", 1e-3},
                                                                                        {"\xE6m", 1e-3},
                                                                                        {"\\u00B5m", 1e-3},
                                                                                        {"nm", 1e-6},
                                                                                        {"pm", 1e-9},
                                                                                        {"\u00c5", 1e-7},
                                                                                        {"\u212b", 1e-7},
                                                                                        {"in", 25.4},
                                                                                        {"inches", 25.4},
                                                                                        {"ft", 304.8},
                                                                                        {"mil", 0.0254},
                                                                                        {"km", 1e6},
                                                                                        {"micron", 1e-3},
                                                                                        {"Microns", 1e-3},
                                                                                        {"Angstrom", 1e-7},
                                                                                        {"micrometer", 1e-3},
                                                                                        {"Micrometres", 1e-3},
                                                                                        {"nanometre", 1e-6},
                                                                                        {"Metres", 1e3},
                                                                                        {"kilometer", 1e6},
                                                                                        {"UM", 1e-3},
                                                                                        {"MM", 1},
                                                                                        {"NM", 1e-6},
                                                                                        {"INCH", 25.4}}) {
        EXPECT_EQ(mm_per_length_unit(name), mm) << name;
    }
}

TEST(LengthUnit, IsNoneForOtherWords) {
    for (const char* name :
         {"", "M", "Mm", "Nm", "s", "pixel", "reference frame", "metres per second", "um2", "thermometer"}) {
        EXPECT_EQ(mm_per_length_unit(name), std::nullopt) << name;
    }
}

} // namespace
} // namespace vkfv
