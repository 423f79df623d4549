// Maps of reflectance are made as asked for: noise by its statistics, images by their pixels; impossible ones are
// refused.
#include "images/image_file.hpp"
#include "specimen/description.hpp"
#include "specimen/geometry_digest.hpp"
#include "specimen/temporary_files.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>

namespace vkfv::specimen {
namespace {

using testing::AllOf;
using testing::HasSubstr;
using Kind = Reflectance::Kind;

constexpr Rectangle square_mm{-0.5, -0.5, 0.5, 0.5};

Reflectance noise(double correlation_length = 0.008, double pitch = 0.002) {
    Reflectance result;
    result.kind = Kind::noise;
    result.pitch = pitch;
    result.correlation_length = correlation_length;
    result.mean = 0.5;
    result.standard_deviation = 0.1;
    result.seed = 3;
    return result;
}

struct Statistics {
    double mean, deviation;
};
Statistics statistics_of(const Grid<float>& grid) {
    double sum = 0, squares = 0;
    for (const float value : grid.values) {
        sum += static_cast<double>(value);
        squares += static_cast<double>(value) * static_cast<double>(value);
    }
    const auto count = static_cast<double>(grid.values.size());
    return {sum / count, std::sqrt(squares / count - sum / count * sum / count)};
}

// The autocorrelation at a distance of so many points along x and along y, 1 at 0.
double correlation(const Grid<float>& grid, int apart_x, int apart_y) {
    const auto [mean, deviation] = statistics_of(grid);
    double sum = 0;
    int pairs = 0;
    for (int row = 0; row + apart_y < grid.rows; ++row) {
        for (int column = 0; column + apart_x < grid.columns; ++column) {
            sum += (static_cast<double>(grid(column, row)) - mean) *
                   (static_cast<double>(grid(column + apart_x, row + apart_y)) - mean);
            ++pairs;
        }
    }
    return sum / pairs / (deviation * deviation);
}

std::string problem_of(const Reflectance& reflectance, const Rectangle& footprint = square_mm) {
    try {
        (void)make_reflectance_map(reflectance, footprint, {});
    } catch (const InputError& error) {
        return error.what();
    }
    return "";
}

} // namespace

// About 16,000 of 501 x 501 points are independent: correlations are known to about 0.008.
TEST(ReflectanceNoise, HasTheCorrelationThatWasAskedFor) {
    const auto map = make_reflectance_map(noise(), square_mm, {});
    ASSERT_EQ(map.values.columns, 501);
    ASSERT_EQ(map.values.rows, 501);
    const auto [mean, deviation] = statistics_of(map.values);
    EXPECT_NEAR(mean, 0.5, 1e-5); // but for what is clipped beyond five deviations
    EXPECT_NEAR(deviation, 0.1, 1e-5);
    for (const int apart : {1, 2, 4, 6, 8}) {
        const double r = apart * 0.002 / 0.008;
        EXPECT_NEAR(correlation(map.values, apart, 0), std::exp(-r * r), 0.03) << apart;
        EXPECT_NEAR(correlation(map.values, 0, apart), std::exp(-r * r), 0.03) << apart;
        EXPECT_NEAR(correlation(map.values, apart, apart), std::exp(-2 * r * r), 0.03) << apart;
    }
    const auto twin = make_reflectance_map(noise(0.010), square_mm, {}); // a quarter longer
    EXPECT_GT(std::abs(correlation(twin.values, 4, 0) - std::exp(-1)), 0.1);
    const auto white = make_reflectance_map(noise(0), square_mm, {});
    EXPECT_NEAR(correlation(white.values, 1, 0), 0, 0.01);
    EXPECT_NEAR(correlation(white.values, 0, 1), 0, 0.01);
}

TEST(ReflectanceNoise, CoversTheFootprintAndIsClipped) {
    const Rectangle footprint{0.1, -0.3, 0.31, 0.2};
    auto loud = noise();
    loud.standard_deviation = 0.5;
    const auto map = make_reflectance_map(loud, footprint, {});
    EXPECT_EQ(map.values.columns, 106);
    EXPECT_EQ(map.values.rows, 251);
    EXPECT_DOUBLE_EQ(map.record.centre_x, 0.205);
    EXPECT_DOUBLE_EQ(map.record.centre_y, -0.05);
    EXPECT_EQ(*std::ranges::min_element(map.values.values), 0);
    EXPECT_EQ(*std::ranges::max_element(map.values.values), 1);
    // The share erfc(1 / sqrt 2) of a normal density that is clipped at one deviation on both sides lies on the bounds.
    const auto on_bounds =
        std::ranges::count_if(map.values.values, [](float value) { return value <= 0 || value >= 1; });
    EXPECT_NEAR(static_cast<double>(on_bounds) / (106 * 251), std::erfc(std::sqrt(0.5)), 0.03);
}

TEST(ReflectanceNoise, DependsOnItsNumbersAlone) {
    const auto bits = [](const Reflectance& reflectance) {
        return make_reflectance_map(reflectance, square_mm, {}).values.values;
    };
    const auto first = bits(noise());
    EXPECT_EQ(bits(noise()), first);
    auto other = noise();
    other.seed = 4;
    EXPECT_NE(bits(other), first);
}

class ReflectanceImage : public test::TemporaryFiles {};

TEST_F(ReflectanceImage, IsTakenPixelByPixelAndEntersTheDigest) {
    Grid<float> pixels(3, 2);
    pixels.values = {0, 0.25f, 0.5f, 0.75f, 1, 0.125f};
    Description description;
    Plane plane;
    plane.size = 0.1;
    plane.pitch = 0.01;
    description.shape = plane;
    const std::string bare = geometry_digest(make(description));
    description.reflectance = Reflectance{.kind = Kind::image,
                                          .lowest = 0.1,
                                          .highest = 0.9,
                                          .x = 0.01,
                                          .y = -0.02,
                                          .pitch = 0.004,
                                          .file = write("map.tif", images::tiff_bytes(pixels))};
    const Specimen specimen = make(description);
    ASSERT_TRUE(specimen.reflectance);
    EXPECT_EQ(specimen.reflectance->values.values, pixels.values);
    const auto map = record(specimen, 1).reflectance;
    EXPECT_EQ(map.kind, physics::f64::PATTERN_GRID);
    EXPECT_EQ(map.columns, 3);
    EXPECT_EQ(map.rows, 2);
    EXPECT_DOUBLE_EQ(map.per_mm, 250);
    EXPECT_EQ(map.lowest, 0.1);
    EXPECT_EQ(map.centre_y, -0.02);
    EXPECT_NE(geometry_digest(specimen), bare);
    pixels.values[3] = std::nextafter(0.75f, 1.0f);
    description.reflectance->file = write("other.tif", images::tiff_bytes(pixels));
    EXPECT_NE(geometry_digest(make(description)), geometry_digest(specimen));
}

TEST_F(ReflectanceImage, Outside0To1OrNotThereIsRefused) {
    Grid<float> pixels(3, 2, 0.5f);
    pixels(2, 1) = 1.5f;
    Reflectance image{.kind = Kind::image, .pitch = 0.001, .file = write("bright.tif", images::tiff_bytes(pixels))};
    EXPECT_THAT(problem_of(image), AllOf(HasSubstr("bright.tif"), HasSubstr("column 2, row 1 from below"),
                                         HasSubstr("1.5"), HasSubstr("[0, 1]")));
    image.file = write("cut.tif", images::tiff_bytes(pixels).substr(0, 40));
    EXPECT_THAT(problem_of(image), HasSubstr("cut.tif"));
    image.file = folder_ / "absent.tif";
    EXPECT_THAT(problem_of(image), AllOf(HasSubstr("absent.tif"), HasSubstr("no such file")));
}

TEST(Reflectance, RefusesWhatIsNoMap) {
    Reflectance grating;
    grating.period = 0.01;
    EXPECT_EQ(problem_of(grating), "");
    const auto with = [&](auto change) {
        Reflectance changed = grating;
        change(changed);
        return problem_of(changed);
    };
    EXPECT_THAT(with([](auto& r) { r.period = 0; }), HasSubstr("specimen.reflectance.period_um"));
    EXPECT_THAT(with([](auto& r) { r.period = NAN; }), HasSubstr("specimen.reflectance.period_um"));
    EXPECT_THAT(with([](auto& r) { r.lowest = -0.1; }), HasSubstr("specimen.reflectance.lowest"));
    EXPECT_THAT(with([](auto& r) { r.highest = 1.1; }), HasSubstr("specimen.reflectance.highest"));
    EXPECT_THAT(with([](auto& r) { r.lowest = 0.6, r.highest = 0.5; }),
                AllOf(HasSubstr("specimen.reflectance.lowest"), HasSubstr("at most highest = 0.5")));
    EXPECT_THAT(with([](auto& r) { r.x = INFINITY; }), HasSubstr("specimen.reflectance.x_um"));
    EXPECT_THAT(with([](auto& r) { r.angle = NAN; }), HasSubstr("specimen.reflectance.angle_deg"));
    EXPECT_THAT(with([](auto& r) { r.kind = Kind::checkerboard; }), HasSubstr("specimen.reflectance.side_um"));
    EXPECT_THAT(with([](auto& r) { r.kind = Kind::star; }), HasSubstr("specimen.reflectance.cycles"));
    EXPECT_THAT(problem_of(noise(0.008, 0)), HasSubstr("specimen.reflectance.pitch_um"));
    EXPECT_THAT(problem_of(noise(0.008, 0.005)),
                AllOf(HasSubstr("specimen.reflectance.pitch_um"), HasSubstr("half the correlation length, 4 um")));
    EXPECT_THAT(problem_of(noise(2.0)), HasSubstr("specimen.reflectance.correlation_length_um"));
    EXPECT_THAT(problem_of(noise(0.008, 1e-6)),
                AllOf(HasSubstr("specimen.reflectance.pitch_um"), HasSubstr("Choose reflectance.pitch_um >=")));
    auto loud = noise();
    loud.mean = 1.2;
    EXPECT_THAT(problem_of(loud), HasSubstr("specimen.reflectance.mean"));
}

} // namespace vkfv::specimen
