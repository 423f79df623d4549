// The noise of a height, propagated from that of a stack's images through both averages and the peak's method.
//
// A single image's noise has the relative variance v. Images k and l of those that are averaged share noise by
// rho(k - l), the autocorrelation of the average's weights, so their measures have (texture_and_noise.hpp)
//
//   cov(F_k, F_l) = v (rho X_kl sqrt(q_k q_l) + rho^2 / rho(0) A sqrt((1 - q_k) (1 - q_l))),
//
// with q = S / F^2 the texture's share of the energy and A the variance without texture. X_kl and S_k S_l are taken at
// the distance sqrt((k^2 + l^2) / 2) from the maximum, as for texture that fades as a Gaussian. The curve is averaged
// and its maximum found by the method; the derivatives of this, times cov, are the variance of the place (JCGM 100,
// 5.2.2). They need the curvature of the curve at its maximum, which its own noise hides where nothing is averaged: the
// bend that is found has the weight of the share of its variance that noise does not explain, that of the stack the
// rest. Noise also acts beyond a linear propagation (a maximum one image further, a bend near zero): this is simulated
// once for the stack (JCGM 101).
#pragma once

#include "topography/noise/texture_and_noise.hpp"
#include "topography/peak_method.hpp"
#include "topography/places_of_maxima.hpp"

#include <array>
#include <vector>

namespace vkfv::topography {

class CurveNoise {
  public:
    // axial_weights: of both averages (axial_average.hpp). No place scatters further than places that are random in the
    // scan of so many images.
    CurveNoise(const TextureAndNoise& found, const std::vector<double>& axial_weights, const PeakFinder& finder,
               int images);

    // Standard deviation of the maximum's place, in steps of the scan. variance: of a pixel's noise in a single image,
    // over its brightness squared; window_share: pixels of the window that lie in the image, over those of a whole one.
    double place(const focus::f64::CurveRecord& curve, double variance, double window_share) const;

  private:
    static constexpr int shares = 12, bends = 24;

    // The largest value of the averaged curve over the measure's at the maximum, and variances over v, each by the
    // texture's share q of the energy there.
    struct OfShare {
        double share = 1;
        double largest = 1;
        double bend = 0; // twice the largest value less both its neighbours, over the largest: without noise
        std::array<std::array<double, 2>, bends>
            place{}; // variances times the largest value's square; at 0 and at the last offset
    };
    template <class ValueOf>
    double at_share(double share, const ValueOf& value_of) const;
    // The texture's share of the energy where the averaged curve has this largest value; noise: N there.
    double share_of(double largest, double noise) const;
    double place_variance(const OfShare& here, double bend, double offset) const;
    void simulate(const std::vector<double>& axial_weights, const PeakFinder& finder);

    TextureAndNoise found_;
    double most_;     // largest standard deviation, in steps
    double kept_ = 1; // rho(0), share of the variance that the average keeps
    std::vector<OfShare> by_share_;
    double bend_variance_ = 0; // variance of the points' bends, without noise
    // Results of the simulation by the linear standard deviation of the place: `factor`, the simulated over the linear
    // one; and the bias and variance of the bend over the largest value at a maximum that noise has chosen.
    struct Simulated {
        double linear = 0;
        double factor = 1;
        double bend_bias = 0;
        double bend_variance = 0;
    };
    Simulated simulated_at(double linear) const;
    // The factor on a bend that removes its bias at a maximum that noise has chosen.
    static double unchosen(double bend, const Simulated& found);
    std::vector<Simulated> simulated_;
};

} // namespace vkfv::topography
