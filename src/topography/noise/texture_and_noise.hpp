// The propagation of the noise of a stack's images into its focus curves, from the spectra of texture and noise that
// its probes show, without a model of either.
//
// A measure's response at a pixel is t to the texture and n to the noise, in every mask and channel. Over the window,
// with weights w of sum 1, the square of the measure is F^2 = <(t + n)^2> = S + N, and the noise of F beside a texture
// is that of <t n> / F. Texture and noise have different spectra: the part of either that a mask passes, and the number
// of independent places in the window, follow from both. So <t n> is computed directly: t from a probe in focus, n from
// a patch of noise elsewhere in the stack, which is the second difference along z of quiet images over sqrt(6). Noise
// in t would count as texture; it does not if two means of the images around are taken, of the even and of the odd
// ones:
//
//   mean of <t_even n> <t_odd n> = S X v,   mean of <t_even t_odd> = S,
//
// for noise of variance v. Without texture F^2 = <n^2>, whose variance follows from two patches n, m of independent
// noise, since the mean of <n m>^2 is half that of <n^2> about its mean, whatever the correlation of pixels in the
// window.
//
// The modified Laplacian adds magnitudes: signs take the place of t and of one n. For Gaussian responses of covariance
// C of the texture and R of the noise, magnitudes have the covariance K(C + R) - K(C), where K' = 2/pi asin; it is
// approximated by the mean of both slopes.
#pragma once

#include <vector>

namespace vkfv::topography {

// Properties of texture and noise, for noise of a pixel whose standard deviation is that of NoiseModel; F, S and N are
// dimensionless, over brightness.
struct TextureAndNoise {
    // Values by the distance, in images, from the focus curve's maximum, of the weighted means of images of which
    // curves are made. Beyond the last distance the last value holds.
    std::vector<double> energy; // S, over its value at the maximum
    std::vector<double> beside; // X: variance of F is v X S / F^2, by texture alone, in a whole window
    double noise_energy = 0;    // N / v of a single image
    double alone = 0;           // variance of F over v, of noise without texture, in a whole window
    // Means over the probes, at the maximum: S / F^2, and v.
    double share = 0;
    double variance = 0;
    // Variance, over the probes, of the bend of the twice averaged curve: twice the largest value less both its
    // neighbours, over the largest; it includes noise.
    double bend_variance = 0;

    double energy_at(double distance) const { return between(energy, distance); }
    double beside_at(double distance) const { return between(beside, distance); }

  private:
    static double between(const std::vector<double>& values, double distance);
};

} // namespace vkfv::topography
