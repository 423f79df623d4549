// A monochrome camera by the linear model of EMVA Standard 1288, release 4.0 linear, sections 2 and 4: light becomes
// photons, photons electrons (a Poisson variable), these a grey value (DN).
#pragma once

#include "core/mathematics/grid.hpp"
#include "optics/media/spectrum.hpp"

#include <cstdint>
#include <vector>

namespace vkfv::camera {

// Electrons a photon: one value for all wavelengths, or points in ascending wavelength, linear between them.
struct QuantumEfficiency {
    std::vector<double> wavelengths_um; // empty: of all
    std::vector<double> values{1.0};    // in (0, 1]

    double at(double wavelength_um) const;
    // Whether the points reach over these wavelengths.
    bool covers(double shortest_um, double longest_um) const;
};

// How long light is collected: a given time, or such that the brightest light takes a share of the saturation
// capacity, over the whole stack or in its first image.
enum class ExposureControl { time, stack, first };

struct CameraOptions {
    QuantumEfficiency quantum_efficiency;
    double full_well = 0;      // e-, the saturation capacity (saturation.hpp)
    double read_noise = 0;     // e-, temporal standard deviation in the dark without quantisation
    double dark_current = 0;   // e- a second
    double gain = 1;           // DN an e-, the standard's K
    double offset = 0;         // DN, the grey value of no charge
    int bit_depth = 12;        // grey values are 0 ... 2^bit_depth - 1
    double dark_signal = 0;    // e-, DSNU: standard deviation of the pixels' dark signals
    double photo_response = 0; // PRNU: standard deviation of the pixels' responses, a share of their mean
    ExposureControl control = ExposureControl::stack;
    double exposure_time = 0;     // s, of ExposureControl::time
    double saturation = 0;        // a share of the saturation charge, of the others
    int frames = 1;               // averaged to one image
    std::uint32_t seed = 1;       // of the fixed patterns
    std::uint32_t noise_seed = 1; // of temporal noise
};

// An image's brightness, and its noise by source, in photoelectrons: means over its pixels (noise: root mean square).
struct ImageLight {
    double mean = 0;            // e-
    double camera_noise = 0;    // e-, temporal: of shot, dark current, reading and quantisation, after averaging
    double ray_noise = 0;       // e-, Monte Carlo standard error of the light itself
    double saturated_share = 0; // of the pixels, whose light is above the saturation charge; these have no noise
};

// The fixed pattern: how each pixel differs from the others, the same in every image.
struct FixedPattern {
    Grid<double> response;    // about 1
    Grid<double> dark_signal; // e-, about 0
};

class Camera {
  public:
    // The spectrum is that of the light on the pixels, by power.
    Camera(const CameraOptions& options, const optics::Spectrum& spectrum);

    FixedPattern fixed_pattern(int columns, int rows) const;
    // Grey values, the mean of the frames: whole numbers of one frame. flux: W a pixel; exposure_time: s; image: keys
    // the temporal noise; pattern: of this camera and as many pixels. A pixel's bits depend on its light, its place and
    // these alone.
    Grid<float> image(const Grid<double>& flux, double exposure_time, std::uint32_t image,
                      const FixedPattern& pattern) const;
    // standard_error: of the flux, W; empty: not known, no ray noise.
    ImageLight light_of(const Grid<double>& flux, const Grid<double>& standard_error, double exposure_time) const;
    // s, in which a pixel of this flux (W) collects this share of the saturation charge.
    double time_to(double share, double flux) const;

    // The same without averaging.
    Camera of_single_frames() const;

    const CameraOptions& options() const { return options_; }
    double photons_per_joule() const { return photons_per_joule_; }
    double electrons_per_joule() const { return electrons_per_joule_; }
    // Over the spectrum, electrons a photon.
    double quantum_efficiency() const { return electrons_per_joule_ / photons_per_joule_; }
    double clip() const { return clip_; }             // e-, at which a pixel's charge ends
    double highest_value() const { return highest_; } // DN
    double converter_end() const;                     // e-, whose grey value is that: below the clip it saturates first
    double saturation_charge() const;                 // e-, the capacity, or where grey values end before it
    double quantisation_noise() const;                // e-
    double temporal_noise(double electrons) const;    // e-, of one frame, of this mean charge
    // sqrt of the saturation capacity, and that over the charge whose signal to noise ratio is 1 (absolute sensitivity
    // threshold, times the quantum efficiency).
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
