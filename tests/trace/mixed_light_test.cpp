// The image of light of several sources is the sum of what each gives, forward and backward, on device and host.
#include "trace/interface/light_sources.hpp"

#include "trace/agreement.hpp"
#include "trace/device/device_tracer.hpp"
#include "trace/host/host_tracer.hpp"
#include "trace/microscope.hpp"

#include "support/statistics.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <functional>
#include <numeric>
#include <set>

using namespace vkfv;
using test::agreement;
using test::total;

namespace {

constexpr double focal_height = 0.002;
constexpr double level = 1e-3; // false-positive rate of each test here, on either side
constexpr double largest_z = 3.3;

optics::RingLightDescription narrow_ring(double elevation) {
    return {.distance = 25,
            .elevation = elevation,
            .width = 0.1, // forward light is aimed the better
            .segments = 5,
            .fill = 0.7,
            .on = {true, true, false, false, true},
            .lit_radius = 0.05};
}

// A disc of 1 W, of which the specimen gets a small share, and a ring light that brings about as much to the detector.
optics::InstrumentDescription mixed_description() {
    auto description = test::ideal_microscope_description();
    description.field_stop_radius = 0.18;
    description.detector_width = 0.64;
    description.detector_pixels = ImageSize::square(16);
    description.greatest_defocus = 0.02;
    description.turned = true;
    optics::SourceDescription ring;
    ring.key = "source[1]";
    ring.flux = 14;
    ring.ring = narrow_ring(0.8);
    description.further_sources = {ring};
    return description;
}

// The instrument in the light of one of its sources alone.
optics::Instrument lit_by(const optics::InstrumentDescription& description, std::size_t which) {
    auto alone = description;
    alone.source = *description.sources()[which];
    alone.further_sources.clear();
    return optics::assemble(alone);
}

trace::TraceOptions options(trace::Estimator estimator, std::uint64_t rays, std::uint32_t seed = 3) {
    trace::TraceOptions result;
    result.estimator = estimator;
    result.rays = rays;
    result.seed = seed;
    result.max_bounces = 1;
    return result;
}

// An image of a flat with a wide lobe, for little noise, or of the rough specimen.
trace::Image expose(const optics::Instrument& instrument, const trace::TraceOptions& with, bool on_flat = false,
                    bool on_host = false) {
    static const auto rough = test::rough_specimen();
    static const auto flat = test::plane_specimen(0.3);
    const auto& specimen = on_flat ? flat : rough;
    return (on_host ? trace::make_host_tracer(instrument, specimen, with)
                    : trace::make_device_tracer(instrument, specimen, with))
        ->expose(focal_height, 0);
}

double variance(const trace::Image& image) {
    return std::inner_product(image.standard_error.values.begin(), image.standard_error.values.end(),
                              image.standard_error.values.begin(), 0.0);
}

// The number of standard errors by which the light of `whole` is off that of the parts together.
double apart(const trace::Image& whole, const std::vector<trace::Image>& parts) {
    double difference = total(whole.flux);
    double of_both = variance(whole);
    for (const auto& part : parts) {
        difference -= total(part.flux);
        of_both += variance(part);
    }
    return std::abs(difference) / std::sqrt(of_both);
}

} // namespace

// Energy adds up with both estimators, in float on the device and in double on the host. Each wrong twin has a ring
// light that is 5 % brighter, or forward, with few rays, 30 %.
TEST(MixedLight, GivesTheSumOfItsSources) {
    const auto description = mixed_description();
    const auto mixed = optics::assemble(description);
    struct Way {
        trace::Estimator estimator;
        std::uint64_t rays;
        bool on_host;
        double brighter; // the twin's ring light
    };
    for (const Way& way :
         {Way{trace::Estimator::forward, 2'000'000, false, 1.3}, Way{trace::Estimator::backward, 1 << 16, false, 1.05},
          Way{trace::Estimator::backward, 1 << 15, true, 1.05}}) {
        SCOPED_TRACE(way.on_host);
        SCOPED_TRACE(static_cast<int>(way.estimator));
        std::vector<trace::Image> parts;
        for (const std::size_t source : {0, 1}) {
            parts.push_back(
                expose(lit_by(description, source), options(way.estimator, way.rays, 11), true, way.on_host));
        }
        const double share = total(parts[1].flux) / (total(parts[0].flux) + total(parts[1].flux));
        EXPECT_GT(share, 0.4) << "the twin would hardly differ";
        EXPECT_LT(share, 0.6);
        const auto with = options(way.estimator, way.rays);
        const auto whole = expose(mixed, with, true, way.on_host);
        EXPECT_LT(apart(whole, parts), largest_z);
        auto twin = description;
        twin.further_sources.front().flux *= way.brighter;
        EXPECT_GT(apart(expose(optics::assemble(twin), with, true, way.on_host), parts), largest_z);
        EXPECT_DOUBLE_EQ(whole.ledger.emitted, 15);
    }
}

TEST(MixedLight, IsTheSameForwardAndBackward) {
    const auto description = mixed_description();
    const auto mixed = optics::assemble(description);
    const auto forward = expose(mixed, options(trace::Estimator::forward, 2'000'000));
    ASSERT_GT(forward.detected, 25'000u);
    const double p = agreement(forward, expose(mixed, options(trace::Estimator::backward, 1 << 19)));
    EXPECT_GT(p, level);
    EXPECT_LT(p, 1 - level);
    // The wrong twin is a ring whose gaps stand elsewhere.
    auto other = description;
    other.further_sources.front().ring->on = {true, true, true, false, false};
    EXPECT_LT(agreement(forward, expose(optics::assemble(other), options(trace::Estimator::backward, 1 << 19))), level);
    // Every ray has one fate, and all the light is accounted for.
    EXPECT_LT(std::abs(forward.ledger.residual()), 1e-6 * forward.ledger.emitted);
    EXPECT_EQ(forward.rays, 2'000'000u);
    std::uint64_t rays = 0;
    std::set<std::string> names;
    for (const auto& entry : forward.ledger.entries) {
        rays += entry.name.starts_with("beam splitter") ? 0 : entry.rays;
        EXPECT_TRUE(names.insert(entry.name).second) << entry.name;
    }
    EXPECT_EQ(rays, forward.rays);
    EXPECT_NEAR(total(forward.flux), forward.ledger.entries.front().power, 1e-12);
}

// In the room of all elements the ring's light may find the illuminator, so all sources have one list of ends.
TEST(MixedLight, FindsItsOwnWayToo) {
    auto description = mixed_description();
    description.turned = false;
    const auto mixed = optics::assemble(description);
    auto with = options(trace::Estimator::forward, 2'000'000);
    with.nonsequential = true;
    const auto found = expose(mixed, with);
    EXPECT_LT(std::abs(found.ledger.residual()), 1e-6 * found.ledger.emitted);
    with.nonsequential = false;
    const auto led = expose(mixed, with);
    // Ideal interfaces make no ghosts, and the splitter's shares are drawn instead of calculated.
    EXPECT_GT(found.detected, 1000u);
    EXPECT_LT(apart(found, {led}), largest_z);
    auto brighter = description;
    brighter.further_sources.front().flux *= 1.5; // few rays arrive: a coarser twin
    EXPECT_GT(apart(found, {expose(optics::assemble(brighter), with)}), largest_z);
}

// A ring twice, in two colours, is one ring of two lines: geometry, best focus and dispersion are those of all light
// together.
TEST(MixedLight, OfTwoColoursIsOneLightOfTwoLines) {
    auto description = mixed_description();
    optics::SourceDescription blue;
    blue.flux = 2;
    blue.ring = narrow_ring(0.8);
    blue.spectrum = optics::Spectrum::line(0.5);
    optics::SourceDescription red = blue;
    red.key = "source[1]";
    red.flux = 3;
    red.spectrum = optics::Spectrum::line(0.63);
    description.source = blue;
    description.further_sources = {red};
    description.spectrum = optics::Spectrum::mixture({{2, *blue.spectrum}, {3, *red.spectrum}});
    auto one = description;
    one.source.spectrum.reset();
    one.source.flux = 5;
    one.spectrum = optics::Spectrum::lines({0.5, 0.63}, {2, 3});
    one.further_sources.clear();
    const auto both = optics::assemble(description);
    const auto lines = optics::assemble(one);
    EXPECT_EQ(both.first_order.best_focus_offset, lines.first_order.best_focus_offset);
    EXPECT_EQ(both.constants.specimen_index, lines.constants.specimen_index);
    const auto backward = options(trace::Estimator::backward, 1 << 18);
    const auto image = expose(both, backward);
    EXPECT_LT(apart(image, {expose(lines, options(trace::Estimator::backward, 1 << 18, 5))}), largest_z);
    // The wrong twin has 5 % more light.
    one.source.flux = 5.25;
    EXPECT_GT(apart(image, {expose(optics::assemble(one), options(trace::Estimator::backward, 1 << 18, 5))}),
              largest_z);
}

TEST(MixedLight, RaysAreSharedOutAmongTheSources) {
    using Rays = std::vector<std::uint64_t>;
    EXPECT_EQ(trace::rays_of_sources(10, std::vector<double>{1.0, 3.0, 1.0}), (Rays{2, 6, 2}));
    EXPECT_EQ(trace::rays_of_sources(1000, std::vector<double>{1.0, 1.0, 1.0}), (Rays{334, 333, 333}));
    EXPECT_EQ(trace::rays_of_sources(7, std::vector<double>{2.0}), (Rays{7}));
    EXPECT_EQ(trace::rays_of_sources(100, std::vector<double>{1e-9, 1.0}), (Rays{1, 99}));
    EXPECT_EQ(trace::rays_of_sources(1, std::vector<double>{1.0, 1.0}), (Rays{1, 1}));
    const auto description = mixed_description();
    const auto mixed = optics::assemble(description);
    auto with = options(trace::Estimator::forward, 600'000);
    EXPECT_EQ(trace::launched_rays(with, description), 600'000u);
    const auto parts = trace::one_by_one(mixed, with);
    ASSERT_EQ(parts.size(), 2u);
    EXPECT_EQ(parts[0].options.rays + parts[1].options.rays, with.rays);
    // The power of a ray of a Lambertian source that is aimed.
    const auto power = [](const trace::OneLight& part) {
        return part.instrument.flux * std::pow(part.instrument.constants.emission_sine, 2) /
               static_cast<double>(part.options.rays);
    };
    EXPECT_NEAR(power(parts[0]) / power(parts[1]), 1, 0.01);
    EXPECT_EQ(parts[0].options.seed, with.seed);
    EXPECT_NE(parts[1].options.seed, with.seed); // else both would draw the same numbers
    // Backward, each source is looked for by as many paths.
    with.estimator = trace::Estimator::backward;
    EXPECT_EQ(trace::one_by_one(mixed, with)[1].options.rays, 300'000u);
    EXPECT_EQ(trace::launched_rays(with, description), 2u * 256 * 2048);
}

// Another light of the second source is another identity, on host and device, since images depend on it.
TEST(MixedLight, IdentityKnowsEverySource) {
    const auto specimen = test::rough_specimen();
    auto description = mixed_description();
    for (const char* device : {"host", ""}) {
        auto with = options(trace::Estimator::forward, 1000);
        with.device = device;
        const auto identity = [&] {
            return trace::expected_identity(optics::assemble(description), specimen, with).toml();
        };
        const auto before = identity();
        EXPECT_EQ(before, identity());
        description.further_sources.front().ring->width *= 1.01;
        EXPECT_NE(before, identity());
        const auto tracer = *device == 'h' ? trace::make_host_tracer(optics::assemble(description), specimen, with)
                                           : trace::make_device_tracer(optics::assemble(description), specimen, with);
        EXPECT_EQ(tracer->identity().toml(), identity());
    }
}

// Two colours are bells that overlap: the mixture has their shares, ends and mean.
TEST(Spectrum, OfSeveralSourcesIsTheirMixture) {
    const auto blue = optics::Spectrum::gaussian(0.5, 0.05);
    const auto green = optics::Spectrum::gaussian(0.53, 0.04);
    const auto both = optics::Spectrum::mixture({{1, blue}, {3, green}});
    EXPECT_NEAR(both.reference_um, 0.25 * 0.5 + 0.75 * 0.53, 1e-12);
    EXPECT_EQ(both.shortest_um, blue.shortest_um);
    EXPECT_EQ(both.longest_um, green.longest_um);
    EXPECT_EQ(both.bins.back().cumulative, 1);
    double mean = 0, weight = 0;
    for (const auto& node : optics::spectral_nodes(both.bins, both.centre(), both.half_width())) {
        mean += node.weight * node.wavelength_um;
        weight += node.weight;
    }
    EXPECT_NEAR(weight, 1, 1e-12);
    EXPECT_NEAR(mean, both.reference_um, 1e-5); // a mean over the middles of bins
    EXPECT_TRUE(optics::Spectrum::mixture({{1, blue}, {3, blue}}) == blue);
    EXPECT_FALSE(both == green);
}
