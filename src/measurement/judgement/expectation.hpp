// The noise and uncertainty to expect of a stack's heights, before any of its images is traced.
//
// A sample of a few dozen pixels in the middle of the field, at the specimen's median height there, is traced backward
// in double on the host's cores: no device is opened. It tells the light of a pixel and the texture that focus is seen
// by. All other figures follow.
//
// Rays. Forward, each of N rays carries the same part of the flux that is sent out, P = sum of flux * aimed share *
// splitter factors. Light Phi of a pixel is then n = N Phi / P detected rays, and its relative variance is v = 1 / n (a
// Poisson variable). Backward, v is the variance of the sample, times the sample's rays a pixel over the image's. A
// camera adds the variance of its photoelectrons (camera.hpp) over the square of their mean.
//
// Texture. The focus measure F over the window has F^2 = S + N, S by texture and N = v N_1 by noise, where N_1 is by
// white noise of variance 1. N_1 is found by the measure itself, on an image of noise, and S is the rest of F^2.
//
// Heights, in steps of the scan. Focus curves are Gaussians of deviation w, and both averages along z have weights of
// deviation s. The averaged curve has the deviation W, W^2 = w^2 + 2 s^2, and the height A = sqrt(S) w / W. Its maximum
// moves by the noise of its slope over its curvature A / W^2. With the weights c of the slope of a curve averaged by a,
// c_k = (a_(k-1) - a_(k+1)) / 2, the correlation rho of averaged noise, rho(d) = sum over k of a_k a_(k+d), the gain g
// of the measure (noise_gain.hpp) and the texture's share q = A^2 / (A^2 + rho(0) N),
//
//   variance of the height / step^2 = v g^2 (W^4 / A^2) sum over k, l of c_k c_l (rho + (1 - q) / (2 q) rho^2 /
//   rho(0)),
//
// with rho at k - l, by JCGM 100:2008, 5.2.2, for the place of a maximum; the covariances are those of curve_noise.hpp.
// The uncertainty adds further independent contributions: relief of deviation r within a window, r sqrt(1 + 2 a / n)
// with n pixels in the window and a in a grain of the measure's responses, since the height of a point leaves the
// relief out and texture weighs the places unevenly; the curved field, p / sqrt(12) by p peak to valley, a uniform
// distribution; and the uncertainty that images of waves hide (PhaseLimits::height_uncertainty()).
//
// The expectation is the mean over stacks of this kind; the run itself tells the noise and uncertainty of each of its
// points.
#pragma once

#include "configuration/configuration.hpp"
#include "core/messages/warning.hpp"
#include "optics/instrument/instrument.hpp"
#include "specimen/specimen.hpp"

#include <array>
#include <limits>
#include <optional>
#include <string>
#include <vector>

namespace vkfv::measurement {

// The expected figures. Lengths in mm; NaN: not known.
struct Expectation {
    static constexpr double unknown = std::numeric_limits<double>::quiet_NaN();

    double light_per_pixel = unknown;    // W
    double detected_rays = unknown;      // of a pixel in an image; backward: rays launched for it
    double ray_noise = unknown;          // standard deviation of a pixel over its mean light, by the rays
    double camera_noise = 0;             // standard deviation over the mean light, by the camera; 0: there is none
    double light_electrons = unknown;    // of a pixel, with a camera
    double texture = unknown;            // standard deviation over the mean, of white texture with the same S
    double texture_error = unknown;      // its standard error
    double texture_over_noise = unknown; // A / sqrt(rho(0) N) of the averaged curve's maximum
    double height_noise = unknown;       // standard deviation of a height, by the images' noise
    double height_uncertainty = unknown; // standard uncertainty of a height, noise with all the rest
    // period_of_half_in_window(), at least the Airy radius.
    double lateral_resolution = unknown;
    double curve_deviation = unknown; // of focus curves

    // Shares, by slope, of the points in the field that the specimen covers, from the heights on the pixels.
    static constexpr std::array<double, 5> slope_bounds = {15, 30, 45, 60, 90}; // degrees, the upper ends
    std::array<double, 5> slope_shares{};
    double steepest = unknown;         // rad: steeper facets send back less than a hundredth of the most light
    double measurable_share = unknown; // of the field: seen, in the scan, not above `steepest`

    double image_noise() const; // of rays and camera together
};

// The expectation for a configuration with [scan] and [specimen]. hidden_uncertainty: standard uncertainty (mm) of
// heights that images of waves hide. An instrument that cannot be sampled (light without a given sequence, or that
// cannot be traced backward) has no expected texture, and its noise comes from a few rays traced forward. Takes
// seconds, without a device. Throws InputError.
Expectation expect(const Configuration& configuration, const optics::Instrument& instrument,
                   const specimen::Specimen& specimen, double hidden_uncertainty);

// The period (mm) of waves of which half of the amplitude is left in the mean over a window of this width (mm): sin x /
// x is 1/2 for a box at 1.66 widths, the transfer of a Gaussian at 1.07.
double period_of_half_in_window(topography::WindowShape shape, double width);

// Warnings about few rays, paths of light that waste them, noise that no camera hides or has, and missing texture.
std::vector<Warning> warnings_of(const Configuration& configuration, const Expectation& expected);

} // namespace vkfv::measurement
