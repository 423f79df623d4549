// Maps of reflectance in the trace agree with closed forms on a flat; the estimators, traversals, modes and the host
// agree with each other.
#include "support/statistics.hpp"
#include "trace/agreement.hpp"
#include "trace/device/device_tracer.hpp"
#include "trace/host/host_tracer.hpp"
#include "trace/microscope.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <complex>
#include <numeric>

using namespace vkfv;
using test::agreement;
using test::total;
using trace::Estimator;
using trace::Traversal;

namespace {

constexpr double level = 1e-3; // false-positive rate of each chi-square test here

constexpr double field = 0.032; // mm

// An instrument of 16 pixels of 2 um in the object, with not much light beside them. Without aberrations an image in
// focus is the object's mean over the pixels.
optics::Instrument ideal_microscope() {
    auto description = test::ideal_microscope_description();
    description.field_stop_radius = 0.18;
    description.detector_width = 0.32;
    description.detector_pixels = ImageSize::square(16);
    description.turned = true;
    return optics::assemble(description);
}

struct Way {
    const char* name;
    trace::TraceOptions options;
    bool host = false;
};

Way way(const char* name, Estimator estimator, std::uint64_t rays, Traversal traversal = Traversal::automatic,
        int max_bounces = 1) {
    Way result{name, {}};
    result.options.estimator = estimator;
    result.options.rays = rays;
    result.options.seed = 3;
    result.options.max_bounces = max_bounces;
    result.options.traversal = traversal;
    return result;
}
Way directed(Way analog) {
    analog.options.directed_scatter = true;
    return analog;
}
Way nonsequential(Way sequential) {
    sequential.options.nonsequential = true;
    return sequential;
}
Way on_host(Way device) {
    device.host = true;
    return device;
}

trace::Image expose(const optics::Instrument& instrument, const specimen::Specimen& specimen, const Way& by,
                    double focal_height = 0, std::uint32_t image = 1) {
    const auto tracer = by.host ? trace::make_host_tracer(instrument, specimen, by.options)
                                : trace::make_device_tracer(instrument, specimen, by.options);
    return tracer->expose(focal_height, image);
}

// A level square of 0.1 mm at the height 0, white and Lambertian.
specimen::Specimen analytic_flat() {
    specimen::Analytic plane;
    plane.x_min = plane.y_min = -0.05;
    plane.x_max = plane.y_max = 0.05;
    return {plane, specimen::Material{{{"lambertian", 1, {}}}}};
}
specimen::Specimen facets_flat() {
    specimen::HeightField field_of_heights;
    field_of_heights.heights = Grid<float>(11, 11, 0.0F);
    field_of_heights.x_min = field_of_heights.y_min = -0.05;
    field_of_heights.pitch_x = field_of_heights.pitch_y = 0.01;
    return {field_of_heights, specimen::Material{{{"lambertian", 1, {}}}}};
}
specimen::Specimen mesh_flat() {
    specimen::Mesh mesh;
    mesh.vertices = {{-0.05F, -0.05F, 0}, {0.05F, -0.05F, 0}, {0.05F, 0.05F, 0}, {-0.05F, 0.05F, 0}};
    mesh.triangles = {{0, 1, 2}, {0, 2, 3}};
    return {mesh, specimen::Material{{{"lambertian", 1, {}}}}};
}

specimen::Specimen with_map(specimen::Specimen specimen, const specimen::Reflectance& reflectance) {
    const auto r = specimen::record(specimen, 1);
    specimen.reflectance =
        specimen::make_reflectance_map(reflectance, {r.x_min, r.y_min, r.x_max, r.y_max}, SourceLocation{});
    return specimen;
}

// The grating has whole periods in the field: 3 along x and 4 along y.
constexpr int periods_x = 3, periods_y = 4;
constexpr double lowest = 0.05, highest = 0.95;
constexpr double origin_x = 0.0013, origin_y = -0.0007;

specimen::Reflectance grating(double sign_of_angle = 1) {
    return {.kind = specimen::Reflectance::Kind::grating,
            .lowest = lowest,
            .highest = highest,
            .x = origin_x,
            .y = origin_y,
            .angle = sign_of_angle * std::atan2(periods_y, periods_x),
            .period = field / std::hypot(periods_x, periods_y)};
}

specimen::Reflectance texture(std::uint32_t seed = 1) {
    return {.kind = specimen::Reflectance::Kind::noise,
            .pitch = 0.001,
            .mean = 0.5,
            .standard_deviation = 0.25,
            .correlation_length = 0.004,
            .seed = seed};
}

// The Fourier coefficient of so many periods in the field, of the image over that of the bare flat, and the standard
// error of its parts.
struct Coefficient {
    std::complex<double> value;
    double error = 0;
};
Coefficient coefficient(const trace::Image& image, const trace::Image& bare, int along_x, int along_y) {
    const int pixels = image.flux.columns;
    Coefficient result;
    double variance = 0;
    for (int row = 0; row < pixels; ++row) {
        for (int column = 0; column < pixels; ++column) {
            const double turns =
                (along_x * (column + 0.5 - 0.5 * pixels) + along_y * (row + 0.5 - 0.5 * pixels)) / pixels;
            const double share = image.flux(column, row) / bare.flux(column, row);
            result.value += share * std::polar(1.0, -2 * pi * turns);
            // A dark pixel of few counts knows no error of its own: that of all is shared out as the light is.
            variance += share / bare.flux(column, row);
        }
    }
    double squares = 0;
    for (const double error : image.standard_error.values) {
        squares += error * error;
    }
    const double count = pixels * pixels;
    result.value /= count;
    result.error = std::sqrt(variance * squares / total(image.flux)) / count;
    return result;
}

// Expects the mean and the fundamental of the grating, which pixels average.
void expect_closed_form(const trace::Image& image, const trace::Image& bare, double further_error) {
    const auto sinc = [](double periods) { return std::sin(pi * periods / 16) / (pi * periods / 16); };
    const auto fundamental = 0.25 * (highest - lowest) * sinc(periods_x) * sinc(periods_y) *
                             std::polar(1.0, -2 * pi * (periods_x * origin_x + periods_y * origin_y) / field);
    const auto mean = coefficient(image, bare, 0, 0);
    const auto seen = coefficient(image, bare, periods_x, periods_y);
    const auto across = coefficient(image, bare, periods_x, -periods_y);
    const double bound = 4 * seen.error + further_error;
    EXPECT_NEAR(mean.value.real(), 0.5 * (lowest + highest), bound);
    EXPECT_LT(std::abs(seen.value - fundamental), bound);
    EXPECT_LT(std::abs(across.value), bound);
    EXPECT_GT(std::abs(fundamental), 4 * bound) << "nothing is told apart";
}

// The sum of the pixels' differences as a share of the light.
double difference(const trace::Image& one, const trace::Image& other) {
    double sum = 0;
    for (std::size_t k = 0; k < one.flux.values.size(); ++k) {
        sum += std::abs(one.flux.values[k] - other.flux.values[k]);
    }
    return sum / total(one.flux);
}

} // namespace

// Backward paths have the same points with and without the map: pixels of the bare flat divide the illumination out.
TEST(ReflectanceMap, AGratingOnEveryKindOfSpecimenAndInEveryTraversalHasItsClosedForm) {
    const auto instrument = ideal_microscope();
    const auto quadtree = way("quadtree", Estimator::backward, 1 << 14, Traversal::quadtree);
    const auto bvh = way("bvh", Estimator::backward, 1 << 14, Traversal::bvh);
    const auto ray_query = way("ray query", Estimator::backward, 1 << 14, Traversal::ray_query);
    const auto host = on_host(way("host", Estimator::backward, 1 << 14));
    struct Case {
        const char* name;
        specimen::Specimen flat;
        std::vector<Way> ways;
    };
    for (const Case& one :
         {Case{"analytic", analytic_flat(), {quadtree, ray_query}},
          Case{"facets", facets_flat(), {quadtree, bvh, host}}, Case{"mesh", mesh_flat(), {bvh, ray_query}}}) {
        const auto bare = expose(instrument, one.flat, one.ways.front());
        for (const Way& by : one.ways) {
            SCOPED_TRACE(std::string(one.name) + " by " + by.name);
            expect_closed_form(expose(instrument, with_map(one.flat, grating()), by), bare, 0);
        }
    }
}

TEST(ReflectanceMap, ForwardPathsOfEveryFormHaveTheClosedForm) {
    const auto instrument = ideal_microscope();
    const auto flat = analytic_flat();
    const auto mapped = with_map(flat, grating());
    const auto bare = expose(instrument, flat, way("backward", Estimator::backward, 1 << 18));
    for (const Way& by : {way("analog", Estimator::forward, 1'000'000, Traversal::quadtree),
                          directed(way("directed", Estimator::forward, 300'000, Traversal::bvh)),
                          nonsequential(way("nonsequential", Estimator::forward, 1'600'000, Traversal::bvh))}) {
        SCOPED_TRACE(by.name);
        expect_closed_form(expose(instrument, mapped, by), bare, 1e-3);
    }
}

// Ray queries trace the same paths as the hierarchy of boxes, but for those within rounding of an edge.
TEST(ReflectanceMap, NonsequentialPathsMeetTheSameMapByRayQuery) {
    const auto instrument = ideal_microscope();
    const auto mapped = with_map(mesh_flat(), grating());
    const auto by = [&](Traversal traversal) {
        return expose(instrument, mapped, nonsequential(way("", Estimator::forward, 100'000, traversal)));
    };
    const auto boxes = by(Traversal::bvh);
    ASSERT_GT(boxes.detected, 100U);
    EXPECT_LT(difference(boxes, by(Traversal::ray_query)), 0.02);
}

// The wrong twin has the angle the other way, which every way of tracing tells.
TEST(ReflectanceMap, AnotherAngleHasNoSuchFrequency) {
    const auto instrument = ideal_microscope();
    const auto by = way("backward", Estimator::backward, 1 << 16);
    const auto bare = expose(instrument, analytic_flat(), by);
    const auto twin = expose(instrument, with_map(analytic_flat(), grating(-1)), by);
    EXPECT_LT(std::abs(coefficient(twin, bare, periods_x, periods_y).value), 0.01);
    EXPECT_GT(std::abs(coefficient(twin, bare, periods_x, -periods_y).value), 0.1);
}

// With up to four bounces on facets so steep that light meets them again, and a mixture of lobes, forward, which counts
// what the map absorbs, agrees with backward, which multiplies by the map.
TEST(ReflectanceMap, EstimatorsAgreeWhereLightIsScatteredAgain) {
    const auto instrument = ideal_microscope();
    auto steep = test::steep_specimen(0.65);
    steep.material.lobes = {{"lambertian", 0.5, {}}, {"henyey-greenstein", 0.3, {0.8}}, {"mirror", 0.1, {}}};
    const auto mapped = with_map(steep, texture());
    const auto backward = way("backward", Estimator::backward, 1 << 18, Traversal::quadtree, 4);
    const auto forward = way("forward", Estimator::forward, 1'500'000, Traversal::quadtree, 4);
    const auto reference = expose(instrument, mapped, backward, 0.002);
    EXPECT_GT(agreement(expose(instrument, mapped, forward, 0.002), reference), level);
    EXPECT_GT(agreement(expose(instrument, mapped,
                               directed(way("directed", Estimator::forward, 400'000, Traversal::quadtree, 4)), 0.002),
                        reference),
              level);
    // The wrong twins are another texture of the same statistics, and no map but a reflectance of its mean.
    EXPECT_LT(agreement(expose(instrument, with_map(steep, texture(2)), forward, 0.002), reference), level);
    auto even = texture();
    even.standard_deviation = 0;
    EXPECT_LT(agreement(expose(instrument, with_map(steep, even), forward, 0.002), reference), level);
}

// Every traversal and the host trace the same paths: only those within rounding of an edge differ.
TEST(ReflectanceMap, HostAndEveryTraversalTraceTheSamePaths) {
    const auto instrument = ideal_microscope();
    const auto mapped = with_map(test::steep_specimen(0.65), texture());
    const auto by = [&](Traversal traversal) {
        return expose(instrument, mapped, way("backward", Estimator::backward, 1 << 13, traversal, 3), 0.002);
    };
    const auto host = expose(instrument, mapped, on_host(way("host", Estimator::backward, 1 << 13, {}, 3)), 0.002);
    for (const auto traversal : {Traversal::quadtree, Traversal::bvh, Traversal::ray_query}) {
        EXPECT_LT(difference(host, by(traversal)), 5e-3);
    }
    // The specimen has little roughness and a narrow lobe, so that much of the light returns.
    const auto smooth = test::rough_specimen(0.95, 0.0002);
    const auto forward = way("forward", Estimator::forward, 50'000, Traversal::quadtree, 3);
    const auto of_device = expose(instrument, with_map(smooth, texture()), forward, 0.002);
    const auto of_host = expose(instrument, with_map(smooth, texture()), on_host(forward), 0.002);
    ASSERT_GT(of_device.detected, 500U);
    EXPECT_LT(difference(of_host, of_device), 0.02);
    const auto other = expose(instrument, with_map(smooth, texture(2)), forward, 0.002);
    EXPECT_GT(difference(of_host, other), 0.1); // wrong twin
}

// The light that the map takes is absorbed: one minus its mean of what arrives, and the ledger closes.
TEST(ReflectanceMap, TheLedgerCountsWhatTheMapAbsorbs) {
    const auto instrument = ideal_microscope();
    const auto mapped = with_map(analytic_flat(), grating());
    using Status = trace::Ledger::Status;
    for (const Way& by : {way("analog", Estimator::forward, 200'000, Traversal::quadtree),
                          directed(way("directed", Estimator::forward, 200'000, Traversal::quadtree)),
                          nonsequential(way("nonsequential", Estimator::forward, 200'000, Traversal::bvh))}) {
        SCOPED_TRACE(by.name);
        const auto image = expose(instrument, mapped, by);
        EXPECT_LT(std::abs(image.ledger.residual()),
                  std::max(1e-6 * image.ledger.emitted, 4 * image.ledger.residual_error));
        double absorbed = 0, rays = 0, left = 0;
        for (const auto& entry : image.ledger.entries) {
            const bool leaves = entry.status == Status::outside_pupil || entry.status == Status::detected ||
                                entry.status == Status::splitter_towards_detector ||
                                entry.status == Status::beside_detector || entry.train == trace::Train::imaging;
            absorbed += entry.status == Status::absorbed ? entry.power : 0;
            rays += entry.status == Status::absorbed ? static_cast<double>(entry.rays) : 0;
            left += leaves ? entry.power : 0;
        }
        ASSERT_GT(rays, 2000);
        if (!by.options.nonsequential) { // where light from the specimen and light to it meet the same elements
            EXPECT_NEAR(absorbed / (absorbed + left), 1 - 0.5 * (lowest + highest), 4 / std::sqrt(rays));
        }
    }
}

TEST(ReflectanceMap, BitsDoNotDependOnTheBatch) {
    const auto instrument = ideal_microscope();
    const auto mapped = with_map(test::rough_specimen(), texture());
    for (Way by : {way("backward", Estimator::backward, 1 << 16, Traversal::quadtree, 2),
                   way("forward", Estimator::forward, 300'000, Traversal::quadtree, 2)}) {
        const auto whole = expose(instrument, mapped, by, 0.001);
        by.options.batch = 9000;
        EXPECT_EQ(whole.flux.values, expose(instrument, mapped, by, 0.001).flux.values);
    }
}
