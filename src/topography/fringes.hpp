// Heights by the fringes of an interferometer whose focal plane is scanned.
//
// Each pixel's images are the samples of a signal, background + 2 Re sum over K of F(K) exp(i K (z - h)), in equal
// steps of z. Its Fourier transform is taken at the multiples of one over the length of the scan that lie in the band
// of fringes. About the image where the envelope, the modulus of the sum over the band, is highest, a line is fitted to
// the phase over K with the weights |F|^2, the best ones for noise that is the same in all images (P. de Groot and L.
// Deck, "Surface profiling by analysis of white-light interferograms in the spatial frequency domain", J. Mod. Opt. 42,
// 389, 1995). The slope tells the envelope's height. The phase at the mean K, less its mean difference from the
// envelope over the field, tells the height within a fringe, whose order is the one nearest to the envelope's height.
//
// The uncertainty of a height is the noise's, what the phases' distance from the line may hide, and by how much more
// than by noise envelope and phase disagree: beside edges, and where slopes or dispersion change the fringes, they do.
#pragma once

#include "core/mathematics/grid.hpp"
#include "topography/focus_curves.hpp"
#include "topography/focus_measure.hpp"
#include "topography/topography.hpp"

#include <optional>
#include <vector>

namespace vkfv::topography {

// What the fringes of one pixel tell; lengths in mm, phases in rad.
struct FringeFit {
    double envelope_height = 0; // by the slope
    double phase = 0;           // at mean_wave_number, relative to the image at `at`
    double at = 0;              // height of the image with the highest envelope
    double mean_wave_number = 0;
    double wave_number_deviation = 0; // standard deviation of K, weighted
    double slope_deviation = 0;       // standard deviations by noise: of envelope_height, and of `phase`
    double phase_deviation = 0;
    double amplitude = 0; // of the envelope's maximum, in the images' unit
    double noise = 0;     // standard deviation of an image's value, by what lies outside of the band
    double residual = 0;  // root mean square of the phase's distance from the line, weighted, rad
    int image = 0;        // of the highest envelope
};

// The transform of signals of so many images in a band, prepared once for all pixels.
class FringeBandTransform {
  public:
    // least, most: wave numbers, rad/mm; step: of the scan, mm. At least two multiples of one over the scan lie in it.
    FringeBandTransform(int images, double step, double least, double most);

    int bins() const { return static_cast<int>(wave_numbers_.size()); }
    // signal: a value for each image. first: height of the first image, mm.
    FringeFit fit(const std::vector<double>& signal, double first) const;
    // The envelope, at each image.
    std::vector<double> envelope(const std::vector<double>& signal) const;

  private:
    struct Spectrum {
        std::vector<double> real, imaginary;
        double mean = 0, energy = 0; // of the signal less its mean
    };
    Spectrum transform(const std::vector<double>& signal) const;

    int images_;
    double step_;
    std::vector<double> wave_numbers_;
    std::vector<double> cosines_, sines_; // [bin * images + image]
};

// Evaluates a scan whose images come one at a time, and keeps them all: 4 bytes a value.
class FringeEvaluator {
  public:
    FringeEvaluator(const TopographyOptions& options, CurveGrid curve_grid) : options_(options), grid_(curve_grid) {}

    void add(const Channels& image, double z, std::optional<double> reading);
    Topography finish(double x0, double y0, double pitch);

  private:
    TopographyOptions options_;
    CurveGrid grid_;
    std::vector<Grid<float>> images_;
    std::vector<double> z_, readings_;
};

} // namespace vkfv::topography
