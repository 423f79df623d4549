#include "physics/physics.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <complex>

namespace {

namespace f64 = vkfv::physics::f64;
namespace f32 = vkfv::physics::f32;

constexpr double glass = 1.5168;  // N-BK7 at d, Schott's catalogue
constexpr double fluoride = 1.38; // MgF2
constexpr double design = 0.55;   // um

double square(double x) {
    return x * x;
}

// The unpolarised reflectance of one layer by its characteristic matrix (Born and Wolf, section 1.6.2) in complex
// admittances, which needs no case for total reflection.
double matrix_reflectance(double before, double layer, double after, double sine, double thickness, double wavelength) {
    using complex = std::complex<double>;
    const auto cosine = [&](double index) { return std::sqrt(complex(1 - square(before * sine / index))); };
    const complex phase = 2 * M_PI * layer * thickness / wavelength * cosine(layer);
    double sum = 0;
    for (const bool p : {false, true}) {
        const auto admittance = [&](double index) { return p ? index / cosine(index) : index * cosine(index); };
        const complex i(0, 1);
        const complex electric = std::cos(phase) + i * std::sin(phase) * admittance(after) / admittance(layer);
        const complex magnetic = i * admittance(layer) * std::sin(phase) + admittance(after) * std::cos(phase);
        sum += 0.5 * std::norm((admittance(before) * electric - magnetic) / (admittance(before) * electric + magnetic));
    }
    return sum;
}

double layer_at(double sine, double wavelength, double thickness = design / (4 * fluoride)) {
    return f64::layer_reflectance(1, fluoride, glass, std::sqrt(1 - sine * sine), thickness, 1 / wavelength);
}

} // namespace

TEST(Fresnel, NormalIncidence) {
    const double expected = square((glass - 1) / (glass + 1));
    EXPECT_NEAR(f64::fresnel_reflectance(1, glass, 1), expected, 1e-15);
    EXPECT_NEAR(f64::fresnel_reflectance(glass, 1, 1), expected, 1e-15);
    EXPECT_NEAR(expected, 0.04216, 5e-6); // its value, by hand
}

// The reflectance is the same from either side along one path, and that of the characteristic matrix without a layer.
TEST(Fresnel, EitherSideAndTheMatrixAgree) {
    for (int i = 0; i < 90; ++i) {
        const double sine = std::sin(i * M_PI / 180);
        const double there = f64::fresnel_reflectance(1, glass, std::sqrt(1 - sine * sine));
        const double back = f64::fresnel_reflectance(glass, 1, std::sqrt(1 - square(sine / glass)));
        EXPECT_NEAR(there, back, 1e-13) << i;
        EXPECT_NEAR(there, matrix_reflectance(1, glass, glass, sine, 0, design), 1e-13) << i;
        EXPECT_GE(there, 0.0421);
        EXPECT_LE(there, 1);
    }
}

// At tan(theta) = n the p wave is not reflected, and the s wave by (n^2 - 1) / (n^2 + 1) in amplitude.
TEST(Fresnel, BrewstersAngle) {
    const auto at = [](double angle) { return f64::fresnel_reflectance(1, glass, std::cos(angle)); };
    const double s = (glass * glass - 1) / (glass * glass + 1);
    EXPECT_NEAR(at(std::atan(glass)), 0.5 * s * s, 1e-15);
    EXPECT_GT(std::abs(at(std::atan(1.001 * glass)) - 0.5 * s * s), 1e-5); // wrong twin
}

// Below the critical angle 1 - R falls off as the cosine of the refracted angle: 2 (n + 1/n) cos' / sqrt(n^2 - 1) ...
// with n cos = sqrt(n^2 - 1) there, and the error is of its square.
TEST(Fresnel, CriticalAngle) {
    const auto at = [](double sine) { return f64::fresnel_reflectance(glass, 1, std::sqrt(1 - sine * sine)); };
    EXPECT_EQ(at(1 / glass * (1 + 1e-12)), 1);
    EXPECT_EQ(at(0.9), 1);
    for (const double refracted : {1e-2, 1e-3, 1e-4}) {
        const double sine = std::sqrt(1 - refracted * refracted) / glass;
        const double root = std::sqrt(glass * glass - 1);
        // For s light 1 - R = 4 cos' / (n cos), for p light 4 n cos' / cos; both are halved for their mean.
        const double lost = 2 * refracted * (1 / root + glass * glass / root);
        EXPECT_NEAR(1 - at(sine), lost, lost * lost) << refracted;
    }
    EXPECT_LT(at(1 / glass * 0.99), 0.5); // wrong twin: a degree before it most light passes
}

TEST(Fresnel, GrazingIncidence) {
    for (const double cosine : {1e-3, 1e-5, 1e-7}) {
        const double lost = 2 * cosine * (1 + glass * glass) / std::sqrt(glass * glass - 1);
        EXPECT_NEAR(1 - f64::fresnel_reflectance(1, glass, cosine), lost, lost * lost);
        EXPECT_NEAR(1 - f64::layer_reflectance(1, fluoride, glass, cosine, 0.1, 2), 0, 20 * cosine);
    }
}

// A quarter wave gives ((n0 ns - n1^2) / (n0 ns + n1^2))^2; with a half wave it is as if there were no layer.
TEST(QuarterWaveLayer, NormalIncidence) {
    const double quarter = square((glass - fluoride * fluoride) / (glass + fluoride * fluoride));
    EXPECT_NEAR(layer_at(0, design), quarter, 1e-15);
    const double bare = square((glass - 1) / (glass + 1));
    EXPECT_NEAR(layer_at(0, design / 2), bare, 1e-15);
    EXPECT_GT(layer_at(0, design * 1.02), quarter + 1e-6); // wrong twin: the minimum is at the design wavelength
    EXPECT_GT(layer_at(0, design / 1.02), quarter + 1e-6);
}

// The matrix agrees from both sides, at all angles, and for thicknesses up to many waves, total reflection included.
TEST(QuarterWaveLayer, AgreesWithTheCharacteristicMatrix) {
    double twin = 0;
    for (const double thickness : {0.0, 0.03, design / (4 * fluoride), 0.31, 7.7}) {
        for (const double wavelength : {0.45, 0.5876, 0.7}) {
            for (int i = 0; i < 90; ++i) {
                const double sine = std::sin(i * M_PI / 180);
                const double cosine = std::cos(i * M_PI / 180);
                for (const bool inward : {true, false}) {
                    const double before = inward ? 1 : glass;
                    const double after = inward ? glass : 1;
                    const double expected = matrix_reflectance(before, fluoride, after, sine, thickness, wavelength);
                    const double found =
                        f64::layer_reflectance(before, fluoride, after, cosine, thickness, 1 / wavelength);
                    // The tolerance is for rounding of a phase of up to 200 rad, and of 1 - R near grazing.
                    EXPECT_NEAR(found, expected, 1e-12) << thickness << " " << wavelength << " " << i << inward;
                    EXPECT_GE(found, 0);
                    EXPECT_LE(found, 1 + 1e-15);
                    if (thickness == 0) {
                        EXPECT_NEAR(found, f64::fresnel_reflectance(before, after, cosine), 1e-12);
                    }
                    const double off =
                        f64::layer_reflectance(before, fluoride, after, cosine, 1.01 * thickness, 1 / wavelength);
                    twin = std::max(twin, std::abs(off - expected));
                    // In the device's arithmetic the phase rounds to 2^-24 of its size, that of 7.7 um to 1e-5 rad.
                    EXPECT_NEAR(f32::layer_reflectance(float(before), float(fluoride), float(after), float(cosine),
                                                       float(thickness), float(1 / wavelength)),
                                expected, std::abs(i - 41) < 2 && !inward ? 1e-3 : 2e-5);
                }
            }
        }
    }
    EXPECT_GT(twin, 1e-4);
}
