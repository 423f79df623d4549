// A monochrome camera by the linear model of EMVA Standard 1288, release 4.0 linear, sections 2 and 4: light becomes
// photons, photons become electrons (a Poisson variable), and these a grey value (DN).
#pragma once

#include "core/mathematics/grid.hpp"
#include "optics/media/spectrum.hpp"

#include <cstdint>
#include <vector>

namespace vkfv::camera {

// The quantum efficiency (electrons per photon): one value for all wavelengths, or points in ascending wavelength,
// linear between them.
struct QuantumEfficiency {
    std::vector<double> wavelengths_um; // empty: one value for all
    std::vector<double> values{1.0};    // in (0, 1]

    double at(double wavelength_um) const;
    // True if the points cover these wavelengths.
    bool covers(double shortest_um, double longest_um) const;
};

// The choice of the exposure time: a given time, or one for which the brightest light reaches a share of the saturation
// capacity, over the whole stack or in its first image.
enum class ExposureControl { time, stack, first };

struct CameraOptions {
    QuantumEfficiency quantum_efficiency;
    double full_well = 0;      // e-, saturation capacity (saturation.hpp)
    double read_noise = 0;     // e-, temporal standard deviation in the dark without quantisation
    double dark_current = 0;   // e- per second
    double gain = 1;           // DN per e-, K of the standard
    double offset = 0;         // DN, grey value of zero charge
    int bit_depth = 12;        // grey values are 0 ... 2^bit_depth - 1
    double dark_signal = 0;    // e-, DSNU: standard deviation of the pixels' dark signals
    double photo_response = 0; // PRNU: standard deviation of the pixels' responses, a share of their mean
    ExposureControl control = ExposureControl::stack;
    double exposure_time = 0;     // s, for ExposureControl::time
    double saturation = 0;        // share of the saturation charge, for the other controls
    int frames = 1;               // number averaged to one image
    std::uint32_t seed = 1;       // seed of the fixed patterns
    std::uint32_t noise_seed = 1; // seed of temporal noise
};

// An image's brightness, and its noise by source, in photoelectrons: means over its pixels (root mean square for
// noise).
struct ImageLight {
    double mean = 0;            // e-
    double camera_noise = 0;    // e-, temporal noise of shot, dark current, reading and quantisation, after averaging
    double ray_noise = 0;       // e-, Monte Carlo standard error of the light itself
    double saturated_share = 0; // share of pixels with more light than the saturation charge; these add no noise
};

// The fixed pattern: each pixel's deviation from the others, the same in every image.
struct FixedPattern {
    Grid<double> response;    // around 1
    Grid<double> dark_signal; // e-, around 0
};

class Camera {
  public:
    // A camera for light whose power on the pixels has this spectrum.
    Camera(const CameraOptions& options, const optics::Spectrum& spectrum);

    FixedPattern fixed_pattern(int columns, int rows) const;
    // The image as grey values, averaged over the frames; whole numbers for a single frame. flux: W per pixel;
    // exposure_time: s; image: key of the temporal noise; pattern: the camera's own, of the same size. A pixel's bits
    // depend only on its light, its index and these arguments.
    Grid<float> image(const Grid<double>& flux, double exposure_time, std::uint32_t image,
                      const FixedPattern& pattern) const;
    // The brightness and noise of an image. standard_error: of the flux, W; empty: unknown, without ray noise.
    ImageLight light_of(const Grid<double>& flux, const Grid<double>& standard_error, double exposure_time) const;
    // The time (s) in which a pixel of this flux (W) collects this share of the saturation charge.
    double time_to(double share, double flux) const;

    // The camera without averaging of frames.
    Camera of_single_frames() const;

    const CameraOptions& options() const { return options_; }
    double photons_per_joule() const { return photons_per_joule_; }
    double electrons_per_joule() const { return electrons_per_joule_; }
    // The mean quantum efficiency over the spectrum, electrons per photon.
    double quantum_efficiency() const { return electrons_per_joule_ / photons_per_joule_; }
    double clip() const { return clip_; }             // e-, the largest charge of a pixel
    double highest_value() const { return highest_; } // DN
    // The charge (e-) at the highest grey value; the converter saturates first if it is below the clip.
    double converter_end() const;
    double saturation_charge() const;              // e-, smaller one of capacity and converter_end()
    double quantisation_noise() const;             // e-
    double temporal_noise(double electrons) const; // e-, of one frame at this mean charge
    // The largest signal-to-noise ratio, the square root of the saturation capacity. The dynamic range is the capacity
    // over least_electrons(), the charge at which the signal-to-noise ratio is 1 (absolute sensitivity threshold times
    // the quantum efficiency).
    double largest_signal_to_noise() const;
    double dynamic_range() const;
    double least_electrons() const;

  private:
    CameraOptions options_;
    double photons_per_joule_ = 0;
    double electrons_per_joule_ = 0;
    double clip_ = 0;
    double highest_ = 0;
};

} // namespace vkfv::camera
