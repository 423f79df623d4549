// The photon transfer measurement of EMVA Standard 1288, release 4.0 linear, on images that a camera takes of uniform
// light: sections 6 (sensitivity, linearity and noise), 7 (dark current) and 8 (spatial nonuniformity).
#pragma once

#include "camera/camera.hpp"

#include <functional>
#include <string>
#include <vector>

namespace vkfv::camera {

struct PhotonTransferOptions {
    int columns = 512; // size of each image
    int rows = 512;
    int exposures = 60; // pairs of images from dark to beyond saturation; the standard requires at least 50
    int averaged = 64;  // images in the dark, and as many at half saturation, for nonuniformity
};

// The statistics of a pair or a stack of images: sums over a band of rows, so that any band can be left out.
struct PairSums {
    double pixels = 0, sum = 0, difference = 0, squared_difference = 0; // sums of a + b, a - b, (a - b)^2
};
struct StackSums {
    double pixels = 0, mean = 0, squared_mean = 0, variance = 0; // sums over the pixels' means and variances
};

// Two images at one irradiation.
struct PairLevel {
    double photons = 0;       // per pixel
    double exposure_time = 0; // s
    std::vector<PairSums> bands;
};

struct PhotonTransferData {
    std::vector<PairLevel> series; // irradiations in equal steps from zero
    std::vector<PairLevel> peak;   // finer steps about the largest variance
    std::vector<PairLevel> dark;   // ascending exposure times; empty without dark current
    std::vector<StackSums> dark_stack, flat_stack;
    double flat_photons = 0;
    int averaged = 0;
};

// The description of an image of the measurement; file: its name, "flat_012_a".
struct TakenImage {
    std::string file, series; // "transfer", "search", "middle", "peak", "dark current", "dark stack", "flat stack"
    double photons = 0;
    double exposure_time = 0; // s
};
using ImageTaker = std::function<void(const TakenImage& what, const Grid<float>& image)>;

// Measures a camera with single frames, whatever number it averages. `take` is called with every image. Uniform light
// has the spectrum's mean wavelength, by the camera's own conversion from W.
PhotonTransferData measure_photon_transfer(const Camera& camera, const PhotonTransferOptions& options,
                                           const ImageTaker& take = {});

// A figure and its statistical standard error, by the jackknife over the bands.
struct MeasuredFigure {
    double value = 0;
    double error = 0;
    bool bounded = false; // true: only an upper bound, without an error
};

struct PhotonTransferFigures {
    MeasuredFigure gain;               // DN/e-
    MeasuredFigure quantum_efficiency; // electrons per photon
    // The read noise sigma_d (e-). If quantisation dominates (a variance below 0.24 DN^2 in the dark), its bound is
    // 0.40 DN, and the threshold uses 0.49 DN as the deviation in the dark, as the standard prescribes.
    MeasuredFigure read_noise;
    MeasuredFigure capacity;           // e-, mu_e.sat
    MeasuredFigure signal_to_noise_db; // largest
    MeasuredFigure dynamic_range_db;
    MeasuredFigure threshold;       // photons, mu_p.min
    MeasuredFigure dark_signal;     // e-, DSNU
    MeasuredFigure photo_response;  // PRNU, relative
    MeasuredFigure dark_current;    // e- per second; NaN if not measured
    MeasuredFigure linearity_error; // mean relative deviation from a line, 5 to 95 % of saturation
};
PhotonTransferFigures photon_transfer_figures(const PhotonTransferData& data);

// The mean value and the temporal variance of a level over all bands but one (-1: all).
double mean_value(const PairLevel& level, int left_out = -1);        // DN
double temporal_variance(const PairLevel& level, int left_out = -1); // DN^2

// The photons at which a cubic fitted to the temporal variances has its maximum.
double photons_of_peak(const std::vector<PairLevel>& levels, int left_out = -1);

// The figures that the measurement should find for a camera: the configuration's values, and those that follow from
// them.
PhotonTransferFigures expected_figures(const Camera& camera);

} // namespace vkfv::camera
