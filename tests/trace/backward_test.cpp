// The backward estimator agrees with the forward one, which is the arbiter, and keeps what it promises of itself.
#include "trace/device/device_tracer.hpp"
#include "trace/host/host_tracer.hpp"
#include "trace/interface/backward_image.hpp"
#include "trace/interface/lattice_generators.hpp"
#include "trace/microscope.hpp"

#include "core/mathematics/units.hpp"
#include "core/messages/error.hpp"
#include "support/statistics.hpp"

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <functional>
#include <numeric>
#include <random>
#include <set>

using namespace vkfv;
using namespace vkfv::physics::f64;

namespace {

constexpr double focal_height = 0.002;
constexpr double level = 1e-3; // false-positive rate of each chi-square test here, on either side

optics::InstrumentDescription small(optics::InstrumentDescription description) {
    description.field_stop_radius = 0.18; // little more than the detector's corners
    description.detector_width = 0.32;
    description.detector_pixels = ImageSize::square(16);
    description.turned = true;
    return description;
}

optics::InstrumentDescription small_description() {
    return small(test::microscope_description());
}

// A microscope of ideal lenses, for tests that do not depend on the lenses.
optics::InstrumentDescription ideal_description() {
    return small(test::ideal_microscope_description());
}

constexpr std::array objectives = {"5x_0.15", "10x_0.28", "20x_0.41", "50x_0.66", "100x_0.83"}; // of the library

optics::InstrumentDescription with_objective(const char* name) {
    auto description = small_description();
    const std::filesystem::path base = std::filesystem::path(VKFV_SOURCE_DIR) / "assets" / "stacks";
    description.objective = optics::load_prescription(name, "objectives", base);
    description.field_stop_radius = 2.0;
    return description;
}

trace::TraceOptions options(trace::Estimator estimator, std::uint64_t rays, int max_bounces) {
    trace::TraceOptions result;
    result.estimator = estimator;
    result.rays = rays;
    result.seed = 3;
    result.max_bounces = max_bounces;
    return result;
}

trace::Image backward_image(const optics::Instrument& instrument, const specimen::Specimen& specimen, int max_bounces,
                            std::uint64_t rays = 1 << 19, std::uint32_t image = 0) {
    return trace::make_device_tracer(instrument, specimen, options(trace::Estimator::backward, rays, max_bounces))
        ->expose(focal_height, image);
}

// The rays are so few that forward's noise, whose distribution is known, is the larger one in what is compared, and so
// many that the 25 000 are detected that expect_agreement() asks for, or that wrong twins are far.
trace::Image forward_image(const optics::Instrument& instrument, const specimen::Specimen& specimen, int max_bounces,
                           std::uint64_t rays = 1'200'000) {
    return trace::make_device_tracer(instrument, specimen, options(trace::Estimator::forward, rays, max_bounces))
        ->expose(focal_height, 0);
}

// The probability of a greater sum over the pixels of (difference)^2 / variance. Forward counts are Poisson's about the
// expectation, which backward knows better; backward's own variances have one degree of freedom a pixel, so their sum
// over the field is used, shared out as the light is.
double agreement(const trace::Image& forward, const trace::Image& backward) {
    const auto pixels = forward.flux.values.size();
    const auto total = [](const Grid<double>& grid) {
        return std::accumulate(grid.values.begin(), grid.values.end(), 0.0);
    };
    double variance_per_flux = total(forward.flux) / static_cast<double>(forward.detected);
    for (const double error : backward.standard_error.values) {
        variance_per_flux += error * error / total(backward.flux);
    }
    double chi_square = 0;
    double cells = 0;
    double seen = 0;
    double expected = 0;
    for (std::size_t pixel = 0; pixel < pixels; ++pixel) {
        seen += forward.flux.values[pixel];
        expected += backward.flux.values[pixel];
        if (expected > 10 * variance_per_flux) { // dark pixels, which mirrors leave, join their neighbours
            chi_square += (seen - expected) * (seen - expected) / (variance_per_flux * expected);
            cells += 1;
            seen = expected = 0;
        }
    }
    return test::chi_square_tail(chi_square, cells);
}

void expect_agreement(const trace::Image& forward, const trace::Image& backward) {
    ASSERT_GT(forward.detected, 25'000u);
    const double p = agreement(forward, backward);
    EXPECT_GT(p, level);
    EXPECT_LT(p, 1 - level);
}

specimen::Specimen with_material(specimen::Specimen specimen, const specimen::Material& material) {
    specimen.material = material;
    return specimen;
}

} // namespace

// The images agree for a single scatter event, and for up to four on facets so steep that light meets them again.
TEST(Backward, EstimatesTheImageThatForwardDoes) {
    const auto instrument = optics::assemble(small_description());
    const auto rough = test::rough_specimen();
    expect_agreement(forward_image(instrument, rough, 1, 850'000), backward_image(instrument, rough, 1));
    const auto steep = test::steep_specimen(0.65);
    expect_agreement(forward_image(instrument, steep, 4), backward_image(instrument, steep, 4));
}

// The wrong twins, a slightly sharper lobe and a bounce too few, are told apart.
TEST(Backward, AnotherSpecimenDoesNotPass) {
    const auto instrument = optics::assemble(ideal_description());
    const auto rough = test::rough_specimen(0.65);
    EXPECT_LT(agreement(forward_image(instrument, rough, 1), backward_image(instrument, test::rough_specimen(0.68), 1)),
              level);
    const auto steep = test::steep_specimen(0.65);
    EXPECT_LT(agreement(forward_image(instrument, steep, 4), backward_image(instrument, steep, 3)), level);
}

// The part of the aperture that shows the source for sure is sampled apart from the source's rim, and the image is the
// same. How much less noise that is depends on the specimen; here it is no more. If the rim's directions were a poor
// lattice, the variance would be ten times as large.
TEST(Backward, TellsTheRimOfTheSourceApart) {
    auto description = small_description();
    description.field_stop_radius = 0.3; // so that all of the detector sees the source's middle for sure
    const auto instrument = optics::assemble(description);
    const auto rough = test::rough_specimen(0.3);
    auto as_one = instrument;
    as_one.turned->optics.source_inner = 0;
    const auto variance = [](const trace::Image& image) {
        return std::transform_reduce(image.standard_error.values.begin(), image.standard_error.values.end(), 0.0,
                                     std::plus<>(), [](double error) { return error * error; });
    };
    const auto apart = backward_image(instrument, rough, 1);
    EXPECT_LT(variance(apart), 1.5 * variance(backward_image(as_one, rough, 1)));
    const auto forward = forward_image(instrument, rough, 1, 2'400'000);
    expect_agreement(forward, apart);
    // In the wrong twin more of the source is taken for sure than is.
    auto too_sure = instrument;
    too_sure.turned->optics.source_inner *= 1.2;
    EXPECT_LT(agreement(forward, backward_image(too_sure, rough, 1)), level);
}

TEST(Backward, KnowsEveryMaterial) {
    const auto instrument = optics::assemble(ideal_description());
    const auto rough = test::rough_specimen();
    const specimen::Material mixture{
        {{"lambertian", 0.4, {}}, {"henyey-greenstein", 0.3, {0.95}}, {"mirror", 0.2, {}}}};
    struct Case {
        specimen::Material material;
        std::uint64_t forward, backward; // rays
    };
    // With a mirror among other lobes backward's own noise would be half of forward's; twice as many paths make it
    // less.
    for (const auto& [material, forward, backward] :
         {Case{mixture, 720'000, 1 << 20}, Case{specimen::Material::henyey_greenstein(1), 480'000, 1 << 19},
          Case{specimen::Material::henyey_greenstein(-0.4), 720'000, 1 << 19},
          Case{specimen::Material::henyey_greenstein(0.97), 480'000, 1 << 19}}) {
        const auto specimen = with_material(rough, material);
        expect_agreement(forward_image(instrument, specimen, 2, forward),
                         backward_image(instrument, specimen, 2, backward));
    }
    // A single event takes fewer random numbers, but the lobe is still chosen.
    const specimen::Material sharp_and_wide{{{"henyey-greenstein", 0.5, {0.3}}, {"henyey-greenstein", 0.4, {0.95}}}};
    const auto specimen = with_material(rough, sharp_and_wide);
    expect_agreement(forward_image(instrument, specimen, 1, 900'000), backward_image(instrument, specimen, 1));
}

// GGX loses light at each event, and other light backward: with the lobe as wide as the source's cone, sharper, and
// much wider, on facets that light meets again.
TEST(Backward, KnowsWhatALossyLobeAbsorbs) {
    const auto instrument = optics::assemble(ideal_description());
    const auto rough = test::rough_specimen();
    for (const double alpha : {0.03, 0.2, 0.7}) {
        SCOPED_TRACE(alpha);
        const auto specimen = with_material(rough, {{{"ggx", 1, {alpha}}}});
        const auto forward = forward_image(instrument, specimen, 2, alpha > 0.5 ? 1'600'000 : 640'000);
        expect_agreement(forward, backward_image(instrument, specimen, 2));
        EXPECT_LT(agreement(forward, backward_image(instrument, with_material(rough, {{{"ggx", 0.9, {alpha}}}}), 2)),
                  level); // wrong twin
    }
    const specimen::Material mixture{{{"ggx", 0.4, {0.5}}, {"lambertian", 0.3, {}}, {"ggx", 0.2, {0.05}}}};
    const auto steep = with_material(test::steep_specimen(0), mixture);
    expect_agreement(forward_image(instrument, steep, 4, 1'400'000), backward_image(instrument, steep, 4));
}

// The trains of both ways differ by losses at interfaces, a spectrum, parts that stand askew, or a cube; images that
// are recorded aside are looked up there by one and drawn from there by the other.
TEST(Backward, KnowsEveryInstrument) {
    const auto rough = test::rough_specimen();
    auto lossy = small_description();
    lossy.interfaces.model = optics::Interfaces::Model::fresnel;
    auto coloured = small_description();
    coloured.spectrum = optics::Spectrum::gaussian(0.57, 0.04);
    auto askew = small_description();
    askew.tube_lens_placement.change.decentre_x = 0.05;
    askew.objective_placement.change.tilt_y = 0.0003;
    auto cube = small_description();
    cube.splitter.kind = optics::BeamSplitter::Kind::cube;
    cube.splitter.glass = optics::Medium::constant("glass", 1.5168);
    cube.splitter.size = 25;
    auto compressed = small_description(); // corners look 6 % farther out, and all 2 % farther in
    compressed.field_stop_radius = 0.2;    // the corners and a tenth
    compressed.image = {.distortion = -0.06, .field_height = 0.0226, .shear = 0.07, .magnification_rate = 10};
    compressed.image.greatest_height = focal_height;
    for (const auto& description : {lossy, coloured, askew, cube, compressed}) {
        SCOPED_TRACE(fmt::format("{} {} {}", description.splitter.size,
                                 description.tube_lens_placement.change.decentre_x, description.image.distortion));
        const auto instrument = optics::assemble(description);
        // Bare interfaces leave a third of the light.
        const std::uint64_t rays =
            description.interfaces.model == optics::Interfaces::Model::ideal ? 1'000'000 : 3'100'000;
        expect_agreement(forward_image(instrument, rough, 1, rays), backward_image(instrument, rough, 1));
    }
}

TEST(Backward, EveryTraversalGivesTheSameImage) {
    const auto instrument = optics::assemble(small_description());
    const auto specimen = test::steep_specimen(0.65);
    auto with = options(trace::Estimator::backward, 1 << 16, 3);
    std::vector<trace::Image> images;
    for (const auto traversal : {trace::Traversal::quadtree, trace::Traversal::bvh, trace::Traversal::ray_query}) {
        with.traversal = traversal;
        images.push_back(trace::make_device_tracer(instrument, specimen, with)->expose(focal_height, 1));
    }
    // All traversals trace the same paths: only those within rounding of an edge differ, fewer than 1 in 1000.
    const auto& first = images.front().flux.values;
    const double total = std::accumulate(first.begin(), first.end(), 0.0);
    for (const auto& image : images) {
        double difference = 0;
        for (std::size_t pixel = 0; pixel < first.size(); ++pixel) {
            difference += std::abs(image.flux.values[pixel] - first[pixel]);
        }
        EXPECT_LT(difference, 2e-3 * total);
    }
}

// In double and in float the points are the same, so the values are the same but for paths within rounding of an edge,
// and of the choice between two candidates.
TEST(Backward, HostAndDeviceFollowTheSamePaths) {
    const auto instrument = optics::assemble(small_description());
    const auto specimen = test::steep_specimen(0.65);
    const auto with = options(trace::Estimator::backward, 1 << 14, 3);
    const auto device = trace::make_device_tracer(instrument, specimen, with)->expose(focal_height, 1);
    const auto host = trace::make_host_tracer(instrument, specimen, with)->expose(focal_height, 1);
    double total = 0;
    double difference = 0;
    for (std::size_t pixel = 0; pixel < host.flux.values.size(); ++pixel) {
        total += host.flux.values[pixel];
        difference += std::abs(device.flux.values[pixel] - host.flux.values[pixel]);
    }
    EXPECT_LT(difference, 5e-3 * total);
    // The wrong twin has other points.
    const auto other = trace::make_device_tracer(instrument, specimen, with)->expose(focal_height, 2);
    double apart = 0;
    for (std::size_t pixel = 0; pixel < host.flux.values.size(); ++pixel) {
        apart += std::abs(other.flux.values[pixel] - host.flux.values[pixel]);
    }
    EXPECT_GT(apart, 5e-3 * total);
}

// There are more paths than two of the largest lattices have.
TEST(Backward, HostAndDeviceFollowTheSamePathsOfThreeRandomisations) {
    auto description = small_description();
    description.detector_pixels = {2, 1};
    description.detector_width = 0.32;
    const auto instrument = optics::assemble(description);
    const auto specimen = test::rough_specimen();
    const auto with = options(trace::Estimator::backward, 2 * ((std::uint64_t{2} << 14) + 1), 1);
    ASSERT_EQ(trace::backward_plan(with.rays, {2, 1}).randomisations, 3u);
    const auto device = trace::make_device_tracer(instrument, specimen, with)->expose(focal_height, 1);
    const auto host = trace::make_host_tracer(instrument, specimen, with)->expose(focal_height, 1);
    for (std::size_t pixel = 0; pixel < 2; ++pixel) {
        EXPECT_NEAR(device.flux.values[pixel] / host.flux.values[pixel], 1, 1e-4);
        EXPECT_NEAR(device.standard_error.values[pixel] / host.standard_error.values[pixel], 1, 0.1);
    }
}

TEST(Backward, BitsDoNotDependOnTheBatch) {
    const auto instrument = optics::assemble(ideal_description());
    const auto specimen = test::rough_specimen();
    auto with = options(trace::Estimator::backward, 1 << 16, 2);
    const auto whole = trace::make_device_tracer(instrument, specimen, with)->expose(focal_height, 4);
    with.batch = 9000;
    const auto parts = trace::make_device_tracer(instrument, specimen, with)->expose(focal_height, 4);
    EXPECT_EQ(whole.flux.values, parts.flux.values);
    EXPECT_EQ(whole.standard_error.values, parts.standard_error.values);
}

// The mean of the stated variances is the variance over images: their ratio has a relative spread of about
// sqrt(2 / 256 (1 / 15 + 1)), the stated one with one degree of freedom a pixel and image; five of those are allowed.
TEST(Backward, StatesItsStandardError) {
    const auto instrument = optics::assemble(ideal_description());
    const auto specimen = test::plane_specimen(0.3);
    constexpr int images = 16;
    const auto tracer =
        trace::make_device_tracer(instrument, specimen, options(trace::Estimator::backward, 1 << 13, 1));
    std::vector<double> sums(256), squares(256);
    double stated = 0;
    for (int image = 0; image < images; ++image) {
        const auto exposed = tracer->expose(focal_height, static_cast<std::uint32_t>(image));
        for (std::size_t pixel = 0; pixel < sums.size(); ++pixel) {
            sums[pixel] += exposed.flux.values[pixel];
            squares[pixel] += exposed.flux.values[pixel] * exposed.flux.values[pixel];
            stated += exposed.standard_error.values[pixel] * exposed.standard_error.values[pixel] / images;
        }
    }
    double seen = 0;
    for (std::size_t pixel = 0; pixel < sums.size(); ++pixel) {
        seen += (squares[pixel] - sums[pixel] * sums[pixel] / images) / (images - 1);
    }
    EXPECT_NEAR(stated / seen, 1.0, 5 * std::sqrt(2.0 / 256 * (1.0 / 15 + 1)));
}

// The gates keep their promise for each microscope of the library, in double: all light within the inner one is from
// the source, none outside the outer one.
TEST(Backward, GatesHoldForEveryMicroscope) {
    for (const char* objective : objectives) {
        SCOPED_TRACE(objective);
        const auto description = with_objective(objective);
        const auto instrument = optics::assemble(description);
        const auto& optics = instrument.turned.value().optics;
        const auto turned = optics::turned_round(instrument);
        const auto scene = turned.scene();
        SpecimenRecord record{};
        Exposure exposure{};
        exposure.top_distance = optics.object_distance; // the top plane is the object plane
        EXPECT_GT(optics.source_inner, 0.9 * optics.source_outer);
        std::mt19937 engine(5);
        std::uniform_real_distribution<double> uniform(0, 1);
        const auto disc = [&](double radius) {
            const double rho = radius * std::sqrt(uniform(engine));
            const double phi = 2 * pi * uniform(engine);
            return glm::dvec2(rho * std::cos(phi), rho * std::sin(phi));
        };
        const auto seen = [&](glm::dvec2 position, glm::dvec2 crossing) {
            SourceQuery query{};
            const glm::dvec2 slope = crossing - optics.source_position * position;
            query.position = glm::dvec3(position, 0);
            query.direction = glm::normalize(glm::dvec3(slope, 1));
            query.weight = 1;
            query.light.wave_number = 1 / 0.587562;
            return trace_to_source(scene, turned.constants, record, exposure, query) > 0;
        };
        int dark_within = 0;
        int lit_outside = 0;
        for (int k = 0; k < 4000; ++k) {
            dark_within += seen(disc(optics.inner_field), disc(optics.source_inner)) ? 0 : 1;
            const glm::dvec2 direction = disc(1);
            const glm::dvec2 outside = glm::normalize(direction) * optics.source_outer * (1 + 0.2 * uniform(engine));
            lit_outside += seen(disc(optics.inner_field), outside) ? 1 : 0;
        }
        EXPECT_EQ(dark_within, 0);
        EXPECT_EQ(lit_outside, 0);
    }
}

// A stack must not be continued by a program that draws other paths.
TEST(Backward, IdentityKnowsWhatPathsAreDrawnBy) {
    const auto instrument = optics::assemble(small_description());
    auto other = instrument;
    other.turned->pupil_rim *= 1.001;
    const auto specimen = test::plane_specimen(0.3);
    const auto with = options(trace::Estimator::backward, 1 << 13, 1);
    for (const bool host : {false, true}) {
        const auto identity = [&](const optics::Instrument& turned) {
            const auto tracer = host ? trace::make_host_tracer(turned, specimen, with)
                                     : trace::make_device_tracer(turned, specimen, with);
            return tracer->identity().toml();
        };
        EXPECT_EQ(identity(instrument), identity(instrument));
        EXPECT_NE(identity(instrument), identity(other));
    }
}

// The pupil ends, in the disc that paths start from, after so many of a lattice's points for every shift. If it ended
// between two numbers, as in the wrong twin, the number would vary.
TEST(Backward, ThePupilsRimAddsNoNoise) {
    for (const char* objective : objectives) {
        SCOPED_TRACE(objective);
        auto description = with_objective(objective);
        description.detector_width = 8;
        const auto instrument = optics::assemble(description);
        const auto turned = optics::turned_round(instrument);
        const auto scene = turned.scene();
        const trace::BackwardPlan plan{.randomisations = 2, .points = 64};
        const auto& seen = instrument.turned.value();
        auto optics = trace::backward_optics(
            instrument, specimen::material_record(specimen::Material::henyey_greenstein(0.3)), plan);
        ASSERT_GT(seen.pupil_rim, 0);
        EXPECT_GE(optics.pupil_radius, seen.optics.pupil_radius);
        const SpecimenRecord record{};
        Exposure exposure{};
        exposure.top_distance = optics.object_distance;
        const Light light{.spectral = 0, .wave_number = 1 / 0.587562, .survival = 0};
        // The number of 64 azimuths that pass from the detector's corner, on a circle `times` the disc that holds all
        // light.
        const auto passing_at = [&](double times) {
            optics.pupil_radius = times * seen.optics.pupil_radius;
            int passing = 0;
            for (int azimuth = 0; azimuth < 64; ++azimuth) {
                const double phi = 2 * pi * azimuth / 64;
                const auto arrival = look_from_detector(scene, turned.constants, optics, record, exposure, 4, 4,
                                                        real2(std::cos(phi), std::sin(phi)), light);
                passing += arrival.status == PATH_ALIVE ? 1 : 0;
            }
            return passing;
        };
        const double chosen = optics.pupil_radius;
        EXPECT_EQ(passing_at(1), 0);
        EXPECT_EQ(passing_at(1.1), 0);
        EXPECT_EQ(passing_at(0.9), 64);
        // The variance over pixels of the number of points that pass.
        const auto variance = [&](double radius) {
            optics.pupil_radius = radius;
            constexpr int pixels = 400;
            double sum = 0, squares = 0;
            for (int pixel = 0; pixel < pixels; ++pixel) {
                const auto shift = lattice_shift(7, 0, static_cast<std::uint32_t>(pixel), 0);
                const double x = 8.0 * (shift.first.x * 0x1p-32 - 0.5);
                const double y = 8.0 * (shift.first.y * 0x1p-32 - 0.5);
                double passing = 0;
                for (std::uint32_t point = 0; point < plan.points; ++point) {
                    const real2 pupil = backward_start(plan.lattice(), shift, point).pupil;
                    const auto arrival =
                        look_from_detector(scene, turned.constants, optics, record, exposure, x, y, pupil, light);
                    passing += arrival.status == PATH_ALIVE ? 1 : 0;
                }
                sum += passing;
                squares += passing * passing;
            }
            return squares / pixels - sum / pixels * (sum / pixels);
        };
        // An edge at the share p between two points is a coin's throw, of the variance p (1 - p). A variance of 0.1 is
        // a rim 0.11 points off, 0.9e-3 of its radius; 0.15, of the twin's half a point at most 0.32 off: 2.5e-3.
        const double within = std::round(plan.points * std::pow(seen.pupil_rim / chosen, 2));
        EXPECT_LT(variance(chosen), 0.1);
        EXPECT_GT(variance(seen.pupil_rim * std::sqrt(plan.points / (within + 0.5))), 0.15);
    }
}

// The source is an LED's die: narrower than the pupil one way, wider the other.
TEST(Backward, KnowsARectangularSource) {
    auto description = ideal_description();
    description.source.rectangle = glm::dvec2(2.4, 0.9);
    const auto rough = test::rough_specimen();
    const auto instrument = optics::assemble(description);
    const auto forward = forward_image(instrument, rough, 1, 3'000'000);
    expect_agreement(forward, backward_image(instrument, rough, 1));
    // The wrong twins are a wider die, so that more of the same flux passes beside the pupil, and one with its sides
    // exchanged.
    for (const glm::dvec2 sides : {glm::dvec2(2.54, 0.9), glm::dvec2(0.9, 2.4)}) {
        auto other = description;
        other.source.rectangle = sides;
        EXPECT_LT(agreement(forward, backward_image(optics::assemble(other), rough, 1)), level) << sides.x;
    }
    // Aiming loses nothing of a die that the pupil sees whole.
    auto small = description;
    small.source.rectangle = glm::dvec2(0.8, 0.5);
    auto whole = small;
    whole.directed_emission = false;
    const auto detected = [&](const optics::InstrumentDescription& of, std::uint64_t rays) {
        return forward_image(optics::assemble(of), rough, 1, rays).ledger.entries.front();
    };
    // The error of the analog light is by far the larger: aimed rays need not be as many.
    const auto aimed = detected(small, 600'000), analog = detected(whole, 6'000'000);
    const double error =
        std::hypot(aimed.power / std::sqrt(double(aimed.rays)), analog.power / std::sqrt(double(analog.rays)));
    EXPECT_LT(std::abs(aimed.power - analog.power), 3.9 * error); // two-sided, 1e-4
    EXPECT_GT(aimed.rays, 2 * analog.rays);
}

// The light comes from one side, past the objective: segments with gaps, wide and sharp lobes, mirrors, a spectrum, a
// cover glass.
TEST(Backward, KnowsARingLight) {
    auto description = ideal_description();
    description.detector_width = 0.64;
    description.greatest_defocus = 0.02;
    description.source.ring = optics::RingLightDescription{.distance = 25,
                                                           .elevation = 0.8,
                                                           .width = 0.1, // forward light is aimed the better
                                                           .segments = 5,
                                                           .fill = 0.7,
                                                           .on = {true, true, false, false, true},
                                                           .lit_radius = 0.05};
    const auto rough = test::rough_specimen();
    const auto instrument = optics::assemble(description);
    const auto forward = forward_image(instrument, rough, 1, 12'000'000);
    expect_agreement(forward, backward_image(instrument, rough, 1));
    // The wrong twins are a ring a little lower, and one whose gaps stand elsewhere.
    for (const bool lower : {true, false}) {
        auto other = description;
        other.source.ring->elevation -= lower ? 0.03 : 0;
        other.source.ring->on = lower ? other.source.ring->on : std::vector<bool>{true, true, true, false, false};
        EXPECT_LT(agreement(forward, backward_image(optics::assemble(other), rough, 1)), level) << lower;
    }
    const auto mixed =
        with_material(rough, {{{"lambertian", 0.4, {}}, {"henyey-greenstein", 0.3, {0.95}}, {"mirror", 0.2, {}}}});
    // Few paths find the ring by a mirror: the errors that they state are large, so one side of the test says nothing.
    const auto of_mirrors = forward_image(instrument, mixed, 2, 1'200'000);
    EXPECT_GT(agreement(of_mirrors, backward_image(instrument, mixed, 2)), level);
    const auto blind = with_material(rough, {{{"lambertian", 0.4, {}}, {"henyey-greenstein", 0.3, {0.95}}}});
    EXPECT_LT(agreement(of_mirrors, backward_image(instrument, blind, 2)), level);
    description.spectrum = optics::Spectrum::gaussian(0.57, 0.04);
    description.cover_glass =
        optics::CoverGlass{.thickness = 0.05, .glass = optics::Medium::constant("glass", 1.5168), .distance = 2};
    const auto covered = optics::assemble(description);
    const auto under_glass = forward_image(covered, mixed, 1, 3'000'000);
    EXPECT_GT(agreement(under_glass, backward_image(covered, mixed, 1)), level);
    description.cover_glass.reset();
    EXPECT_LT(agreement(under_glass, backward_image(optics::assemble(description), blind, 1)), level);
}

// Rays that go to points drawn on a wide band meet it there; rays to gaps and beside the band do not.
TEST(RingLight, IsMetWhereItIsDrawn) {
    RingLight ring{};
    ring.distance = 25;
    ring.elevation_sine = std::sin(0.7);
    ring.elevation_cosine = std::cos(0.7);
    ring.half_width = 3;
    ring.fill = 0.6;
    ring.segments = 7;
    ring.switched_on = 0b1011001;
    RingLight beside = ring;
    beside.switched_on = 0b0100110;
    std::mt19937 engine(5);
    std::uniform_real_distribution<double> uniform(0, 1);
    double area = 0; // by rays from one point, uniform over the upper half space
    constexpr int rays = 400'000;
    const real3 from(0.4, -0.2, 0.1);
    for (int k = 0; k < 2000; ++k) {
        const RingPoint point = ring_point(ring, uniform(engine), uniform(engine));
        const real3 there(point.position.x, -point.position.y, -point.position.z);
        const real3 direction = glm::normalize(there - from);
        const RingMeeting meeting = meet_ring(ring, from, direction);
        ASSERT_TRUE(meeting.found);
        EXPECT_NEAR(meeting.distance, glm::length(there - from), 1e-9);
        EXPECT_NEAR(meeting.cosine, -glm::dot(direction, real3(point.normal.x, -point.normal.y, -point.normal.z)),
                    1e-9);
        EXPECT_FALSE(meet_ring(beside, from, direction).found);
        EXPECT_FALSE(meet_ring(ring, from, -direction).found);
    }
    for (int k = 0; k < rays; ++k) {
        const double z = uniform(engine), azimuth = 2 * pi * uniform(engine), rho = std::sqrt(1 - z * z);
        const RingMeeting meeting = meet_ring(ring, from, {rho * std::cos(azimuth), rho * std::sin(azimuth), z});
        area += meeting.found ? 2 * pi * meeting.distance * meeting.distance / meeting.cosine / rays : 0;
    }
    EXPECT_NEAR(area / ring_area(ring), 1, 0.03);
}

// Columns and rows are told apart, and light between the sensitive parts of the pixels is not seen.
TEST(Backward, KnowsRectangularDetectorsWithGaps) {
    auto description = ideal_description();
    description.detector_pixels = {24, 9};
    description.detector_width = 24 * 0.02;
    description.fill_factor = 0.49;
    const auto rough = test::rough_specimen();
    const auto instrument = optics::assemble(description);
    ASSERT_NEAR(instrument.first_order.pixel_pitch, 0.02 / 10, 1e-8);
    ASSERT_NEAR(instrument.constants.detector_half_height, 9 * 0.01, 1e-12);
    const auto forward = forward_image(instrument, rough, 2, 1'450'000);
    const auto backward = backward_image(instrument, rough, 2);
    ASSERT_EQ(forward.flux.columns, 24);
    ASSERT_EQ(forward.flux.rows, 9);
    expect_agreement(forward, backward);
    auto whole = description;
    whole.fill_factor = 1;
    const auto all = backward_image(optics::assemble(whole), rough, 2);
    const auto total = [](const trace::Image& image) {
        return std::accumulate(image.flux.values.begin(), image.flux.values.end(), 0.0);
    };
    EXPECT_NEAR(total(backward) / total(all), 0.49, 0.01);
    // The pixels lie where those of a larger square detector do.
    auto square = whole;
    square.detector_pixels = ImageSize::square(24);
    const auto larger = backward_image(optics::assemble(square), rough, 2, 24 * 24 * 4096);
    const auto smaller = backward_image(optics::assemble([&] {
                                            auto odd = whole;
                                            odd.detector_pixels = {24, 8};
                                            return odd;
                                        }()),
                                        rough, 2, 24 * 8 * 4096);
    double chi_square = 0;
    for (int row = 0; row < 8; ++row) {
        for (int column = 0; column < 24; ++column) {
            const double variance =
                std::pow(larger.standard_error(column, row + 8), 2) + std::pow(smaller.standard_error(column, row), 2);
            chi_square +=
                std::min(std::pow(larger.flux(column, row + 8) - smaller.flux(column, row), 2) / variance, 40.0);
        }
    }
    // Differences follow Student's t of two degrees of freedom each: heavier than a normal, hence the cut above and the
    // wide bound.
    EXPECT_LT(chi_square / (24 * 8), 6);
    EXPECT_GT(chi_square / (24 * 8), 0.3);
}

// Each coordinate alone visits every n-th of the interval once, and no two coordinates are one.
TEST(Lattice, EveryCoordinateIsStratified) {
    for (std::uint32_t bits = 0; bits < trace::lattice_generators.size(); ++bits) {
        const auto& z = trace::lattice_generators[bits];
        const std::uint32_t n = 1u << bits;
        const Lattice lattice{bits, z[0], z[1], z[2], z[3], z[4], z[5], z[6], z[7]};
        for (const std::uint32_t component : z) {
            std::set<std::uint32_t> strata;
            for (std::uint32_t point = 0; point < n; ++point) {
                const double u = lattice_coordinate(lattice, point, component, 0x12345678u);
                EXPECT_GT(u, 0);
                EXPECT_LT(u, 1);
                strata.insert(static_cast<std::uint32_t>(u * n + n - 0x12345678p-32 * n + 1e-6) % n);
            }
            EXPECT_EQ(strata.size(), n);
        }
        if (bits >= 5) {
            EXPECT_EQ(std::set<std::uint32_t>(z.begin(), z.end()).size(), z.size());
        }
    }
}
