// The sinusoids of a capability map, and how well each is measured.
#pragma once

#include "measurement/calibration/characteristic.hpp"
#include "measurement/capability/limits.hpp"

#include <filesystem>
#include <string>
#include <vector>

namespace vkfv::measurement {

// A node of the map. Lengths in mm; NaN: nothing was measured.
struct CapabilityNode {
    SurfaceWave wave;
    std::string stack;                            // its folder, relative to the map's
    double measured_share = 0;                    // of the points
    double bias = surface::undefined;             // measured over true amplitude, minus 1
    double bias_uncertainty = surface::undefined; // its standard uncertainty, by uncertainty_of() the amplitude
    double rms_error = surface::undefined;        // of the heights, their median deviation taken off
    double noise = surface::undefined;            // median of the heights' stated noise
    double uncertainty = surface::undefined;      // median of their stated standard uncertainty
    double beyond = surface::undefined;           // share of the measured points farther than 3 u from the truth
    std::vector<std::string> limits{};            // keys of the limits that the wave lies beyond

    // 95 % of the points are measured within 3 u of the truth, at most 1 % of the measured ones farther from it, and
    // the amplitude is right to 10 %.
    bool robust() const;
};

// Throws InputError, at keys of this file, where the scan or the field holds no map: a scan shorter than four standard
// deviations of a focus curve and four steps, or a field narrower than four focus windows.
void require_room_for_waves(const Conditions& conditions, const std::filesystem::path& file);

// So many wavelengths from one focus window to 30 or half of the field, times so many amplitudes from the noise of a
// height to a quarter of the scan, at least two each, both in equal ratios and to four digits. noise: mm; the least
// amplitude is it to two digits, within a thousandth and a tenth of the largest amplitude, and a thousandth if it is
// not known (NaN).
std::vector<SurfaceWave> waves_of_map(const Conditions& conditions, double noise, int wavelengths, int amplitudes);

// The trial of a flat with the waves' print, which shows the noise.
Trial flat_trial(const Conditions& conditions);
// The trial of a wave. number: from 0, of its texture and noise.
Trial trial_of(const Conditions& conditions, const SurfaceWave& wave, int number);

// How well a trial measured the wave.
CapabilityNode node_of(const Conditions& conditions, const SurfaceWave& wave, const TrialResult& result);

} // namespace vkfv::measurement
