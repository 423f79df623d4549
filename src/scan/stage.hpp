// What the stage of a real instrument does to the focal positions: errors of its scale, its bearings, its surroundings,
// and of the lamp that shines meanwhile. All of it follows from a seed and the number of the image, so that any image
// can be taken alone.
#pragma once

#include "trace/interface/tracer.hpp"

#include <cstdint>
#include <span>
#include <vector>

namespace vkfv::scan {

// Lengths in mm, times in s, angles in rad; nothing of it by default. Images are taken one after another, an interval
// apart, upwards or downwards; the time is 0 at the first of them.
struct Stage {
    // Errors of the scale: what it reads, less where the stage is. The stage goes to where the scale reads the nominal
    // position, so that a scale error e makes heights 1 + e times as large.
    double scale_error = 0;                  // relative
    std::vector<double> linearity_positions; // ascending, with an error each; linear between, constant beyond
    std::vector<double> linearity_errors;
    double periodic_amplitude = 0; // of a sine over the position
    double periodic_period = 0;
    double periodic_phase = 0; // at position 0

    // Where the stage comes to stand, against where the scale should read the nominal position. The scale reads them.
    double jitter = 0;   // standard deviation, of each position by itself
    double backlash = 0; // on the way down: the stage lags, but stands at the topmost position first

    // What no scale reads: between objective and specimen.
    double drift = 0; // mm/s, of the focal plane upwards
    struct Vibration {
        double amplitude = 0;
        double frequency = 0; // Hz
        bool operator==(const Vibration&) const = default;
    };
    std::vector<Vibration> vibrations; // of random phases
    // One-sided power spectral density of further vibration: linear between its points, nothing beyond.
    std::vector<double> vibration_frequencies; // Hz, ascending
    std::vector<double> vibration_densities;   // mm^2/Hz

    // Of the specimen at right angles to the axis.
    glm::dvec2 lateral_drift{0}; // mm/s
    glm::dvec2 tilt{0};          // of the way of the stage against the optical axis, towards x and y: tangents
    double runout = 0;           // radius of a circle that is gone round ...
    double runout_period = 0;    // ... once in this way

    double light_noise = 0; // relative standard deviation of the lamp's power, of each image by itself

    bool downwards = false;
    double interval = 0.1;      // from image to image
    double exposure_time = 0;   // within which vibrations blur
    int moments = 8;            // of the exposure at which a vibrating stage is looked at
    double reading_noise = 0;   // standard deviation of what the scale says beyond its errors
    bool evaluate_read = false; // heights by the positions that the scale read, not by the nominal ones
    std::uint32_t seed = 1;

    bool still() const; // no error moves anything
    bool operator==(const Stage&) const = default;
};

// Where images of a scan are really taken.
class StageMotion {
  public:
    // positions: nominal, mm, ascending.
    StageMotion(const Stage& stage, std::vector<double> positions);

    // How many moments an exposure has: 1 where nothing moves meanwhile.
    int moments() const;
    // Focal plane and specimen at a moment of an image's exposure. nominal: mm; an image beyond the scan's stands alone
    // at its own position.
    trace::FocalPosition at(double nominal, std::uint32_t image, int moment = 0) const;
    // Of all moments together.
    trace::FocalPosition mean(double nominal, std::uint32_t image) const;
    // What the scale reads, mm.
    double reading(double nominal, std::uint32_t image) const;
    // How far from its nominal position the focal plane is at most, mm. nominal: the scan's positions in their order,
    // then those of images beyond it, which all have the number after the scan's last.
    double farthest(std::span<const double> nominal) const;
    // The lamp's power over its mean, of an image.
    double light(std::uint32_t image) const;

  private:
    void add_spectrum();
    double time_of(std::uint32_t image) const;
    double settled(double nominal, std::uint32_t image) const; // by jitter and backlash: what the scale should read
    double normal(std::uint32_t image, std::uint32_t purpose) const;
    double uniform(std::uint32_t image, std::uint32_t purpose) const;

    Stage stage_; // its spectrum as vibrations too
    std::vector<double> positions_;
};

} // namespace vkfv::scan
