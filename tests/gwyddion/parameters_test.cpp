// Parameters that Gwyddion has too agree for the same heights.
#include <libintl.h> // before Gwyddion's macros of the same names

#include <libprocess/datafield.h>
#include <libprocess/stats.h>

#include "surface/areal_parameters.hpp"
#include "surface/maps.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <memory>

namespace vkfv::surface {
namespace {

struct Unref {
    void operator()(void* object) const { g_object_unref(object); }
};
using Field = std::unique_ptr<GwyDataField, Unref>;

HeightMap rough(double pitch = 0.002) {
    return test::sampled(300, 240, pitch, [](double x, double y) {
        return 1e-3 * (std::sin(190 * x + 60 * y) + std::cos(330 * y - 70 * x) * std::sin(40 * x * y + 250 * x));
    });
}

template <class Value>
Field field_of(const HeightMap& map, const Value& value) {
    Field field(
        gwy_data_field_new(map.columns(), map.rows(), map.columns() * map.pitch_x, map.rows() * map.pitch_y, TRUE));
    for (std::size_t k = 0; k < map.height.values.size(); ++k)
        gwy_data_field_get_data(field.get())[k] = value(map.height.values[k]);
    return field;
}

TEST(GwyddionParameters, HeightsAreTheSameWithGaps) {
    HeightMap map = rough();
    test::forget_a_third(map);
    const Field heights = field_of(map, [](double z) { return std::isnan(z) ? 0 : z; });
    const Field mask = field_of(map, [](double z) { return std::isnan(z) ? 0 : 1; });
    double mean, sa, sq, skewness, excess, lowest, highest;
    gwy_data_field_area_get_stats_mask(heights.get(), mask.get(), GWY_MASK_INCLUDE, 0, 0, map.columns(), map.rows(),
                                       &mean, &sa, &sq, &skewness, &excess);
    gwy_data_field_area_get_min_max_mask(heights.get(), mask.get(), GWY_MASK_INCLUDE, 0, 0, map.columns(), map.rows(),
                                         &lowest, &highest);
    // The tolerance is for sums of 48 000 rounded terms.
    const HeightParameters p = height_parameters(map);
    EXPECT_NEAR(p.sa, sa, 1e-11 * sa);
    EXPECT_NEAR(p.sq, sq, 1e-11 * sq);
    EXPECT_NEAR(p.ssk, skewness, 1e-9);
    EXPECT_NEAR(p.sku, excess + 3, 1e-9);
    EXPECT_NEAR(p.sp, highest - mean, 1e-11 * sq);
    EXPECT_NEAR(p.sv, mean - lowest, 1e-11 * sq);
}

TEST(GwyddionParameters, GradientIsTheSameWithGaps) {
    // Gwyddion weights differences along x and y alike; as many of both make that the sum of two means.
    const int n = 240;
    HeightMap map =
        test::sampled(n, n, 0.002, [](double x, double y) { return 1e-3 * std::sin(190 * x + 60 * y * x); });
    map.pitch_y = 0.003;
    for (const bool gaps : {false, true}) {
        if (gaps) {
            test::forget_a_third(map);
            for (int row = 0; row < n; ++row)
                for (int column = 0; column < n; ++column)
                    if (std::isnan(map.height(row, column)))
                        map.height(column, row) = test::not_measured;
        }
        const Field heights = field_of(map, [](double z) { return std::isnan(z) ? 0 : z; });
        const Field mask = field_of(map, [](double z) { return std::isnan(z) ? 0 : 1; });
        const double sdq =
            gwy_data_field_area_get_surface_slope_mask(heights.get(), mask.get(), GWY_MASK_INCLUDE, 0, 0, n, n);
        EXPECT_NEAR(hybrid_parameters(map).sdq, sdq, 1e-11 * sdq) << gaps;
    }
}

TEST(GwyddionParameters, AreaIsTheSameButForItsBordersAndTriangles) {
    // Gwyddion's triangles meet at the cell's mean height, which takes a quarter of the squared difference of opposite
    // edges off, (k pitch)^2 / 4 of the part that runs askew: at k = 400 / mm 0.2 %.
    const HeightMap map = rough(0.0002);
    const Field heights = field_of(map, [](double z) { return z; });
    const double area = map.columns() * map.pitch_x * map.rows() * map.pitch_y;
    const double theirs = gwy_data_field_get_surface_area(heights.get()) / area - 1;
    const HybridParameters p = hybrid_parameters(map);
    // Gwyddion adds half a cell, level across the border, around the map: 1 / 300 + 1 / 240 of the area, whose excess
    // is between none and twice the mean.
    EXPECT_NEAR(p.sdr, theirs, 0.0095 * p.sdr);
    // The wrong twin has a pitch 3 % longer.
    HeightMap longer = map;
    longer.pitch_x *= 1.03;
    EXPECT_GT(std::abs(hybrid_parameters(longer).sdr - theirs), 0.0095 * p.sdr);
}

} // namespace
} // namespace vkfv::surface
