// The photon transfer measurement of EMVA Standard 1288, release 4.0 linear, on images that a camera takes of uniform
// light: sections 6 (sensitivity, linearity and noise), 7 (dark current) and 8 (spatial nonuniformity).
#pragma once

#include "camera/camera.hpp"

#include <functional>
#include <string>
#include <vector>

namespace vkfv::camera {

struct PhotonTransferOptions {
    int columns = 512; // of each image
    int rows = 512;
    int exposures = 60; // pairs of images from dark to beyond saturation; the standard asks for 50 at least
    int averaged = 64;  // images in the dark, and at half saturation, for nonuniformity
};

// What a pair of images or a stack of them is told by: sums over a band of rows, so that any band can be left out.
struct PairSums {
    double pixels = 0, sum = 0, difference = 0, squared_difference = 0; // of a + b, a - b, (a - b)^2
};
struct StackSums {
    double pixels = 0, mean = 0, squared_mean = 0, variance = 0; // of the pixels' means over the stack and variances
};

// Two images at one irradiation.
struct PairLevel {
    double photons = 0;       // a pixel
    double exposure_time = 0; // s
    std::vector<PairSums> bands;
};

struct PhotonTransferData {
    std::vector<PairLevel> series; // irradiations in equal steps, the first is none
    std::vector<PairLevel> peak;   // finer ones about the largest variance
    std::vector<PairLevel> dark;   // of growing exposure time; empty without dark current
    std::vector<StackSums> dark_stack, flat_stack;
    double flat_photons = 0;
    int averaged = 0;
};

// What an image of the measurement is; file: a name for it, "flat_012_a".
struct TakenImage {
    std::string file, series; // "transfer", "peak", "dark current", "dark stack", "flat stack"
    double photons = 0;
    double exposure_time = 0; // s
};
using ImageTaker = std::function<void(const TakenImage& what, const Grid<float>& image)>;

// Takes the images, one frame each, whatever the camera averages. `take` sees every image. Uniform light falls at the
// spectrum's mean wavelength, by the camera's own conversion from W.
PhotonTransferData measure_photon_transfer(const Camera& camera, const PhotonTransferOptions& options,
                                           const ImageTaker& take = {});

// A figure and its statistical standard error: the jackknife's over the bands.
struct MeasuredFigure {
    double value = 0;
    double error = 0;
    bool bounded = false; // only that it lies below the value is known, and there is no error
};

struct PhotonTransferFigures {
    MeasuredFigure gain;               // DN/e-
    MeasuredFigure quantum_efficiency; // electrons a photon
    // e-, sigma_d. Where quantisation dominates (a variance below 0.24 DN^2 in the dark) it is bounded by 0.40 DN, and
    // the threshold takes 0.49 DN for the deviation in the dark, as the standard says for this case.
    MeasuredFigure read_noise;
    MeasuredFigure capacity;           // e-, mu_e.sat
    MeasuredFigure signal_to_noise_db; // largest
    MeasuredFigure dynamic_range_db;
    MeasuredFigure threshold;       // photons, mu_p.min
    MeasuredFigure dark_signal;     // e-, DSNU
    MeasuredFigure photo_response;  // PRNU, a share
    MeasuredFigure dark_current;    // e- a second; NaN where none was measured
    MeasuredFigure linearity_error; // mean relative deviation from a line, 5 to 95 % of saturation
};
PhotonTransferFigures photon_transfer_figures(const PhotonTransferData& data);

// Of a level, over all bands but one (-1: all).
double mean_value(const PairLevel& level, int left_out = -1);        // DN
double temporal_variance(const PairLevel& level, int left_out = -1); // DN^2

// Photons at which a cubic through the temporal variances is largest.
double photons_of_peak(const std::vector<PairLevel>& levels, int left_out = -1);

// What the measurement should find of a camera: the configuration's values, and what follows from them.
PhotonTransferFigures expected_figures(const Camera& camera);

} // namespace vkfv::camera
