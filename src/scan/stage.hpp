// Errors of a real instrument's stage: of its scale, its bearings, its surroundings, and of the lamp meanwhile. All of
// them follow from a seed and the number of the image, so that any image can be made alone.
#pragma once

#include "trace/interface/tracer.hpp"

#include <cstdint>
#include <span>
#include <vector>

namespace vkfv::scan {

// Lengths in mm, times in s, angles in rad; no errors by default. Images are taken one after another, an interval
// apart, upwards or downwards; the time is 0 at the first one.
struct Stage {
    // Errors of the scale: its reading minus the stage's position. The stage goes to where the scale reads the nominal
    // position, so that a scale error e makes heights 1 + e times as large.
    double scale_error = 0;                  // relative
    std::vector<double> linearity_positions; // ascending, with an error each; linear between, constant beyond
    std::vector<double> linearity_errors;
    double periodic_amplitude = 0; // amplitude of a sine over the position
    double periodic_period = 0;
    double periodic_phase = 0; // at position 0

    // Deviation of the stage's rest position from where the scale would read the nominal position. The scale reads it.
    double jitter = 0;   // standard deviation, independent for each position
    double backlash = 0; // on the way down: the stage lags, but stands at the topmost position first

    // Motion between objective and specimen that no scale reads.
    double drift = 0; // mm/s, of the focal plane upwards
    struct Vibration {
        double amplitude = 0;
        double frequency = 0; // Hz
        bool operator==(const Vibration&) const = default;
    };
    std::vector<Vibration> vibrations; // with random phases
    // One-sided power spectral density of further vibration: linear between its points, zero outside.
    std::vector<double> vibration_frequencies; // Hz, ascending
    std::vector<double> vibration_densities;   // mm^2/Hz

    // Lateral motion of the specimen, at right angles to the axis.
    glm::dvec2 lateral_drift{0}; // mm/s
    glm::dvec2 tilt{0};          // tangents of the angles between the stage's way and the optical axis, towards x and y
    double runout = 0;           // radius of a circular motion
    double runout_period = 0;    // way of the stage for one turn of it

    double light_noise = 0; // relative standard deviation of the lamp's power, independent for each image

    bool downwards = false;
    double interval = 0.1;      // from one image to the next
    double exposure_time = 0;   // vibrations blur the image within it
    int moments = 8;            // number of moments at which the exposure of a vibrating stage is sampled
    double reading_noise = 0;   // standard deviation of the scale's reading beyond its errors
    bool evaluate_read = false; // true: heights by the positions that the scale read, false: by the nominal ones
    std::uint32_t seed = 1;

    bool still() const; // true: no error moves anything
    bool operator==(const Stage&) const = default;
};

// The true positions of a scan's images.
class StageMotion {
  public:
    // positions: nominal, mm, ascending.
    StageMotion(const Stage& stage, std::vector<double> positions);

    // The number of moments of an exposure: 1 if nothing moves during it.
    int moments() const;
    // The position of focal plane and specimen at a moment of an image's exposure. nominal: mm; an image beyond the
    // scan's images stands at its own position.
    trace::FocalPosition at(double nominal, std::uint32_t image, int moment = 0) const;
    // The mean position over all moments.
    trace::FocalPosition mean(double nominal, std::uint32_t image) const;
    // The scale's reading, mm.
    double reading(double nominal, std::uint32_t image) const;
    // The largest distance of the focal plane from its nominal position, mm. nominal: the scan's positions in order,
    // then those of images beyond it, which all have the number after the scan's last.
    double farthest(std::span<const double> nominal) const;
    // The lamp's power over its mean, for an image.
    double light(std::uint32_t image) const;

  private:
    void add_spectrum();
    double time_of(std::uint32_t image) const;
    double settled(double nominal, std::uint32_t image) const; // nominal position with jitter and backlash
    double normal(std::uint32_t image, std::uint32_t purpose) const;
    double uniform(std::uint32_t image, std::uint32_t purpose) const;

    Stage stage_; // with its spectrum as vibrations
    std::vector<double> positions_;
};

} // namespace vkfv::scan
