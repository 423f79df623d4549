// Images of an interferometer against Abbe's sum, closed forms and rays.
#include "fields/interferometers.hpp"
#include "topography/fringes.hpp"
#include "trace/host/host_tracer.hpp"

#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <numeric>
#include <optional>
#include <vector>

namespace vkfv {
namespace {

using test::fringe;

// The sum over source points, pupil points and wavelengths by tests/references/fringe_reference.py: a step of 0.4 um at
// the places 0.03, 0.22, 0.53 and 1.28 um beside it, on the upper level, at four focal heights (um).
constexpr std::array heights_um{-0.3, 0.0, 0.25, 0.9};
constexpr std::array<int, 4> places{0, 3, 8, 20}; // in points of 1/16 um
using Signals = std::array<std::array<std::complex<double>, 4>, 4>;
const Signals narrow_band{{{{{-0.20237, 0.14388}, {-0.07129, 0.43189}, {0.07766, 0.75079}, {0.13741, 0.88012}}},
                           {{{-0.24484, 0.05596}, {-0.24484, 0.37319}, {-0.24484, 0.72612}, {-0.24484, 0.86965}}},
                           {{{-0.14775, 0.20417}, {0.05414, 0.44815}, {0.27648, 0.72138}, {0.36699, 0.83182}}},
                           {{{-0.14372, -0.20199}, {-0.44087, -0.11354}, {-0.77373, -0.02517}, {-0.90293, 0.01084}}}}};
const Signals white{{{{{-0.38076, -0.07285}, {-0.29911, 0.3044}, {-0.26247, 0.47667}, {-0.27592, 0.51321}}},
                     {{{-0.43393, 0.08987}, {-0.43393, 0.535}, {-0.43393, 0.73986}, {-0.43393, 0.78193}}},
                     {{{-0.0291, 0.4719}, {0.27832, 0.73268}, {0.41933, 0.85156}, {0.45812, 0.8607}}},
                     {{{-0.14381, 0.16395}, {-0.19751, 0.28089}, {-0.21952, 0.32975}, {-0.19937, 0.33895}}}}};

double worst_of(const fields::FringeFields& fields, const Signals& expected) {
    double worst = 0;
    const int middle = fields.pixels.columns / 2, row = fields.pixels.rows / 2;
    for (std::size_t height = 0; height < heights_um.size(); ++height) {
        for (std::size_t place = 0; place < places.size(); ++place) {
            worst = std::max(worst, std::abs(fringe(fields, middle + places[place], row, heights_um[height]) -
                                             expected[height][place]));
        }
    }
    return worst;
}

TEST(Interferometer, AStepHasTheFringesOfAbbesSum) {
    constexpr double pitch_um = 1.0 / 16;
    const auto step = test::step_of(0.4, 40);
    const auto line = test::interferometer(0.3, pitch_um, 64, 4, optics::Spectrum::line(0.55));
    EXPECT_LT(worst_of(test::fields_of(line, step, -1, 1), narrow_band), 0.006);
    auto wide = test::interferometer(0.55, pitch_um, 64, 4, optics::Spectrum::gaussian(0.55, 0.1));
    EXPECT_LT(worst_of(test::fields_of(wide, step, -1, 1), white), 0.006);
    wide.source.radius *= 0.9; // the wrong twin
    EXPECT_GT(worst_of(test::fields_of(wide, step, -1, 1), white), 0.02);
}

// The share of the light that a tilted flat reflects into the pupil, by numpy (800 x 800 points of the pupil).
TEST(Interferometer, ATiltedFlatHasTheFringesOfTheLightThatItSendsIntoThePupil) {
    struct Row {
        double aperture, degrees, amplitude;
    };
    for (const auto& [aperture, degrees, amplitude] :
         {Row{0.3, 4, 0.7157}, Row{0.3, 8, 0.4418}, Row{0.8, 10, 0.807}, Row{0.8, 20, 0.580}, Row{0.8, 30, 0.3498}}) {
        const double pitch_um = aperture < 0.5 ? 0.1 : 0.02; // so small that a pixel averages no fringes
        const auto line = test::interferometer(aperture, pitch_um, 32, 8, optics::Spectrum::line(0.55));
        const double tilt = degrees * radians_per_degree;
        const auto fields = test::fields_of(line, test::flat_of(tilt, 30), -2, 2);
        const double height_um = 0.5 * pitch_um * std::tan(tilt); // of the pixel beside the middle
        EXPECT_NEAR(std::abs(fringe(fields, 16, 4, height_um)), amplitude, 0.005) << aperture << " " << degrees;
    }
}

// Fringes of the mirror's tilt are those of a specimen tilted the other way.
TEST(Interferometer, ATiltedMirrorIsASpecimenTiltedTheOtherWay) {
    const auto white_light = test::interferometer(0.3, 0.5, 32, 8, optics::Spectrum::gaussian(0.55, 0.1));
    const double tilt = 0.01;
    // The share of two discs of radius 0.3 that overlap, 2 sin(tilt) apart: 1 - 4 / pi times the distance over 4 radii.
    const double share = 1 - 4 / pi * 2 * tilt / (2 * 0.3);
    const auto by_mirror = test::fields_of(white_light, test::flat_of(0, 60), -2, 2, {.tilt = {-std::tan(tilt), 0}});
    const auto by_specimen = test::fields_of(white_light, test::flat_of(tilt, 60), -2, 2);
    for (const int column : {4, 12, 27}) {
        for (const double height_um : {-0.6, 0.0, 0.4}) {
            EXPECT_LT(
                std::abs(share * fringe(by_mirror, column, 4, height_um) - fringe(by_specimen, column, 4, height_um)),
                0.01); // the light that is lost is oblique, which changes the fringes of the rest
        }
    }
}

// Heights 0.039 um from the edge of a step, on its upper level, less that level, in light of 0.55 um, 0.1 um wide. By
// the slope of the phase: of the signals by tests/references/fringe_reference.py. The envelope's maximum is as far off
// as P. de Groot and X. Colonna de Lega's model has it.
TEST(Interferometer, AStepHasBatwings) {
    constexpr double pitch_um = 0.078, step_um = 0.05;
    constexpr int images = 161;
    const auto light = test::interferometer(0.3, pitch_um, 64, 4, optics::Spectrum::gaussian(0.55, 0.1));
    const auto band = fields::fringe_band(light.spectrum, 0.3, 1);
    const topography::FringeBandTransform transform(images, from_um(step_um), band.least, band.most);
    struct Row {
        double step_um, by_slope_um;
        std::optional<double> by_maximum_um;
    };
    for (const auto& [of_step, by_slope, by_maximum] :
         {Row{0.1375, 0.4039, 0.346}, Row{0.4, 0.187, {}}, Row{1.0, 0.2317, 0.132}, Row{0.275, -0.1275, {}}}) {
        const auto fields = test::fields_of(light, test::step_of(of_step, 40), -4, 4);
        std::vector<double> signal;
        for (int image = 0; image < images; ++image) {
            signal.push_back(fringe(fields, 32, 2, -4 + image * step_um).real());
        }
        const auto fit = transform.fit(signal, from_um(-4));
        EXPECT_NEAR(fit.envelope_height * um_per_mm - of_step / 2, by_slope, 0.01) << of_step;
        if (by_maximum) {
            const auto envelope = transform.envelope(signal);
            const auto at = static_cast<std::size_t>(fit.image);
            const double before = envelope[at - 1], here = envelope[at], after = envelope[at + 1];
            const double offset = (before - after) / (2 * (before - 2 * here + after));
            EXPECT_NEAR(-4 + step_um * (fit.image + offset) - of_step / 2, *by_maximum, 0.01) << of_step;
        }
    }
}

TEST(Interferometer, AMirrorHasTheLightThatRaysBring) {
    auto description = test::interferometer(0.3, 2, 16, 16, optics::Spectrum::line(0.55));
    description.turned = true;
    const specimen::Specimen flat = test::flat_of(0, 400);
    const auto instrument = optics::assemble(description);
    trace::TraceOptions options;
    options.estimator = trace::Estimator::backward;
    options.rays = 200'000;
    const auto rays = trace::make_host_tracer(instrument, flat, options)->expose(0.0, 0);
    const double by_rays = std::accumulate(rays.flux.values.begin(), rays.flux.values.end(), 0.0);
    const fields::ReferenceArm dark{.reflectance = 1e-12}; // the object's arm alone, which passes a splitter twice
    const auto image =
        fields::make_host_interferometer(instrument, description, flat, dark, {-0.001, 0.001})->expose(0.0, 0);
    const double by_fields = 4 * std::accumulate(image.flux.values.begin(), image.flux.values.end(), 0.0);
    EXPECT_NEAR(by_fields / by_rays, 1, 1e-3);
}

TEST(Interferometer, ItsLedgerCloses) {
    const auto description = test::interferometer(0.3, 0.5, 16, 16, optics::Spectrum::gaussian(0.55, 0.1));
    const auto tracer = fields::make_host_interferometer(optics::assemble(description), description,
                                                         test::step_of(0.4, 40), {}, {-0.002, 0.002});
    double sum = 0;
    for (const double height : {-0.0003, 0.0, 0.0001}) {
        const auto image = tracer->expose(height, 0);
        EXPECT_NEAR(image.ledger.residual(), 0, 1e-12);
        EXPECT_EQ(image.flux.values, tracer->expose(height, 7).flux.values); // the same bits whenever it is asked
        sum += image.ledger.entries.front().power;
    }
    EXPECT_GT(sum, 0);
    EXPECT_THROW((void)tracer->expose(0.5, 0), RunError);
}

TEST(Interferometer, SaysWhatItsFieldsDoNotHoldFor) {
    const auto description = test::interferometer(0.3, 0.5, 16, 16, optics::Spectrum::line(0.55));
    const auto refusal_of = [&](const specimen::Specimen& specimen, const optics::InstrumentDescription& of) {
        return test::refusal([&] { (void)test::fields_of(of, specimen, -1, 1); });
    };
    const auto rough = [](double sq_um, double length_um) {
        specimen::Rough shape;
        shape.size = from_um(40);
        shape.pitch = from_um(0.1);
        shape.random = {.sq = from_um(sq_um), .correlation_length = from_um(length_um), .seed = 5};
        return specimen::make({.shape = shape, .material = test::mirror()});
    };
    EXPECT_EQ(refusal_of(rough(0.02, 4), description), "");
    EXPECT_NE(refusal_of(rough(3, 6), description).find("slopes"), std::string::npos);
    EXPECT_NE(refusal_of(rough(0.15, 0.3), description).find("curvature"), std::string::npos);
    specimen::Plane plane;
    plane.size = from_um(40);
    plane.pitch = from_um(1);
    const auto matt = specimen::make({.shape = plane, .material = specimen::Material::henyey_greenstein(0.5)});
    EXPECT_NE(refusal_of(matt, description).find("specimen.material.scatter"), std::string::npos);
    const specimen::Specimen mesh{specimen::Mesh{{{-1, -1, 0}, {1, -1, 0}, {0, 1, 0}}, {{0, 1, 2}}}, test::mirror()};
    EXPECT_NE(refusal_of(mesh, description).find("specimen.kind"), std::string::npos);
}

} // namespace
} // namespace vkfv
