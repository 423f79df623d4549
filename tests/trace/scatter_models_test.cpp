// With several scatter models in one material the device in float agrees with the host in double, forward with
// backward, and the effect of the wavelength on a material with closed forms.
#include "specimen/tabulated_bsdf.hpp"
#include "trace/agreement.hpp"
#include "trace/alike_paths.hpp"
#include "trace/device/device_tracer.hpp"
#include "trace/host/host_tracer.hpp"
#include "trace/microscope.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <complex>

using namespace vkfv;
using test::agreement;
using test::total;
using trace::Estimator;

namespace {

constexpr double level = 1e-3; // false-positive rate of each chi-square test here

const std::vector<double> lines_um = {0.45, 0.65}, fluxes = {0.3, 0.7};

// An instrument of 16 pixels of 2 um in the object, with lenses without aberrations, and light of two wavelengths.
optics::Instrument ideal_microscope(bool coloured = true) {
    auto description = test::ideal_microscope_description();
    description.field_stop_radius = 0.18;
    description.detector_width = 0.32;
    description.detector_pixels = ImageSize::square(16);
    description.turned = true;
    if (coloured) {
        description.spectrum = optics::Spectrum::lines(lines_um, fluxes);
    }
    return optics::assemble(description);
}

trace::Image expose(const optics::Instrument& instrument, const specimen::Specimen& specimen, Estimator estimator,
                    std::uint64_t rays, bool host = false, int max_bounces = 1) {
    trace::TraceOptions options;
    options.estimator = estimator;
    options.rays = rays;
    options.seed = 4;
    options.max_bounces = max_bounces;
    options.directed_scatter = estimator == Estimator::forward;
    const auto tracer = host ? trace::make_host_tracer(instrument, specimen, options)
                             : trace::make_device_tracer(instrument, specimen, options);
    return tracer->expose(0.0, 1);
}

specimen::Specimen rough(const specimen::Material& material) {
    specimen::Rough shape;
    shape.size = 0.1;
    shape.pitch = 0.002;
    shape.random = {.sq = 0.002, .correlation_length = 0.012, .seed = 5};
    return specimen::make({.shape = shape, .material = material});
}

specimen::Specimen flat(const specimen::Material& material) {
    specimen::Analytic plane;
    plane.x_min = plane.y_min = -0.05;
    plane.x_max = plane.y_max = 0.05;
    return {plane, material};
}

// A reciprocal table: a sum of products of the same function of both angles.
specimen::TabulatedBsdf table() {
    specimen::TabulatedBsdf bsdf;
    for (int k = 0; k <= 9; ++k) {
        bsdf.incidences.push_back(pi / 2 * k / 9);
    }
    bsdf.scatters = bsdf.incidences;
    bsdf.azimuths = {0, 0.7, 2, pi};
    bsdf.given_incidences = bsdf.incidences.size();
    for (const double i : bsdf.incidences) {
        for (const double s : bsdf.scatters) {
            for (const double a : bsdf.azimuths) {
                bsdf.values.push_back(0.2 + 0.1 * std::cos(i) * std::cos(s) +
                                      0.1 * std::sin(i) * std::sin(s) * std::cos(a));
            }
        }
    }
    return bsdf;
}

// All models that have a density, with a weight of 0.9 together; twins change the share of the first.
specimen::Material mixture(double compensated = 0.25) {
    specimen::Material material{{{"ggx-multiple-scatter", compensated, {0.4}},
                                 {"harvey-shack", 0.25, {0.1, -1.5}},
                                 {"ggx-conductor", 0.2, {0.27, 2.95, 0.3}},
                                 {"tabulated", 0.2, {}}}};
    material.lobes[1].reflectance = {{0.4, 0.5, 0.7}, {1, 0.8, 0.3}};
    material.lobes[2].refractive_index = {{0.4, 0.7}, {1.5, 0.2}};
    material.lobes[2].extinction_coefficient = {{0.4, 0.7}, {1.9, 3.8}};
    material.lobes[3].bsdf = table();
    return material;
}

// A material with a mirror, a delta, besides.
specimen::Material with_mirrors() {
    return {{{"abg", 0.4, {0.01, 1.5}}, {"conductor", 0.5, {0.27, 2.95}}}};
}

struct Share {
    double value;
    double error; // its standard error
};
Share share_of(const trace::Image& image, const trace::Image& whole) {
    const auto squares = [](const trace::Image& one) {
        double sum = 0;
        for (const double error : one.standard_error.values) {
            sum += error * error;
        }
        return sum / std::pow(total(one.flux), 2);
    };
    const double share = total(image.flux) / total(whole.flux);
    return {share, share * std::sqrt(squares(image) + squares(whole))};
}

} // namespace

TEST(ScatterModels, HostAndDeviceScatterEachPathAlike) {
    const auto instrument = ideal_microscope();
    constexpr std::uint32_t paths = 4000;
    for (const auto& material : {mixture(), with_mirrors()}) {
        const auto specimen = rough(material);
        trace::TraceOptions options;
        options.rays = paths;
        options.seed = 5;
        options.max_bounces = 2;
        const auto host = trace::host_paths(instrument, specimen, options, 0.0, 7, 0, paths);
        const auto device = trace::device_paths(instrument, specimen, options, 0.0, 7, 0, paths);
        test::expect_alike(host, device, 10);
    }
}

// Backward makes another image of a model that is not reciprocal, or whose sampler draws another density.
TEST(ScatterModels, ForwardAndBackwardMakeOneImage) {
    const auto instrument = ideal_microscope();
    const auto backward_of = [&](const specimen::Material& material, std::uint64_t rays, bool host = false) {
        return expose(instrument, rough(material), Estimator::backward, rays, host, 2);
    };
    for (const auto& material : {mixture(), with_mirrors()}) {
        const auto forward = expose(instrument, rough(material), Estimator::forward, 1 << 19, false, 2);
        const auto backward = backward_of(material, 1 << 15);
        EXPECT_GT(agreement(forward, backward), level);
        const auto sum = share_of(backward, forward);
        EXPECT_NEAR(sum.value, 1, 4 * sum.error);
        EXPECT_LT(sum.error, 0.02);
        if (material == mixture()) { // wrong twin: a weight that is 0.05 smaller
            const auto twin = share_of(backward_of(mixture(0.2), 1 << 15), forward);
            EXPECT_GT(std::abs(twin.value - 1), 4 * twin.error);
        }
        const auto by_host = backward_of(material, 1 << 11, true), by_device = backward_of(material, 1 << 11);
        double apart = 0;
        for (std::size_t k = 0; k < by_host.flux.values.size(); ++k) {
            apart += std::abs(by_host.flux.values[k] - by_device.flux.values[k]);
        }
        EXPECT_LT(apart, 0.02 * total(by_host.flux)); // a path of 4096 may part by rounding
    }
}

// The images are traced on the host, whose paths are the device's.
TEST(ScatterModels, AReflectanceByWavelengthTakesItsShareOfEachLine) {
    const auto instrument = ideal_microscope();
    specimen::Material white{{{"lambertian", 1, {}}}};
    specimen::Material coloured = white;
    coloured.lobes[0].reflectance = {{0.4, 0.5, 0.75}, {0.9, 0.5, 0.25}};
    // The reflectance is linear between the points: 0.7 at 0.45 um and 0.35 at 0.65 um.
    const double wanted = fluxes[0] * 0.7 + fluxes[1] * 0.35;
    const auto share = share_of(expose(instrument, flat(coloured), Estimator::backward, 1 << 14, true),
                                expose(instrument, flat(white), Estimator::backward, 1 << 14, true));
    EXPECT_NEAR(share.value, wanted, 4 * share.error + 1e-3);
    EXPECT_LT(share.error, 0.01);
    EXPECT_GT(std::abs(share.value - 0.5 * (0.7 + 0.35)), 4 * share.error + 1e-3); // twin: lines of equal flux
}

// Unpolarised, the reflectance is that of normal incidence to 1e-4 within the objective's cone.
TEST(ScatterModels, AMetalReflectsItsShare) {
    const auto instrument = ideal_microscope(false);
    const std::complex<double> index(2.9, 3.1);
    const double wanted = std::norm(index - 1.0) / std::norm(index + 1.0);
    const specimen::Material metal{{{"conductor", 1, {index.real(), index.imag()}}}}, mirror{{{"mirror", 1, {}}}};
    const auto share = share_of(expose(instrument, flat(metal), Estimator::backward, 1 << 14, true),
                                expose(instrument, flat(mirror), Estimator::backward, 1 << 14, true));
    EXPECT_NEAR(share.value, wanted, 4 * share.error + 1e-4);
    EXPECT_LT(share.error, 0.01);
    EXPECT_GT(std::abs(share.value - 1), 4 * share.error); // twin: an ideal mirror
}
