// Figures of the images that waves make of points of the field: transfer functions, point spreads and wavefronts, by
// integrals over the traced pupils. Lengths in mm in the object unless a name says otherwise.
#pragma once

#include "core/mathematics/grid.hpp"
#include "optics/waves/point_waves.hpp"

#include <complex>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

namespace vkfv::measurement {

// The axes that all points of the field share.
struct WaveAxes {
    std::vector<double> heights;     // of the object plane above best focus on the axis
    std::vector<double> frequencies; // cycles per mm, from 0 to the cutoff on the axis
    std::vector<double> places;      // across a point spread, from its centre
};

// The image by light from one point of the field. "Radial" is the direction along the line from the axis (x on the
// axis).
struct WavePoint {
    std::string name; // "axis", "edge", "corner"
    glm::dvec2 field{0};
    glm::dvec2 radial{1, 0};
    double aperture = 0; // NA of a disc with the pupil's area
    // The wavelength in the middle of the flux, for which the wavefront at z = 0 holds.
    double wavelength_um = 0;
    // The wavefront is without the piston and tilt of the whole pupil (optics/waves/levelled_wavefront.hpp).
    std::vector<double> zernike; // waves, Noll's numbers from 1
    double wavefront_rms = 0;    // waves
    Grid<double> wavefront;      // waves, over the square about the pupil; NaN outside it
    double pupil_radius = 0;     // half the side of that square, in p
    // These figures hold at z = 0, over the spectrum.
    double strehl = 0;
    std::vector<double> dark_rings;
    std::vector<double> encircled_in_rings;
    std::vector<glm::dvec2> encircled; // radius and share of the light within it
    Grid<double> spread;               // relative to the ideal peak; columns are places along the radial direction
    // Transfer functions over the spectrum, with a row for each height.
    Grid<std::complex<double>> radial_transfer;
    Grid<std::complex<double>> tangential_transfer; // across the radial direction
    Grid<double> spread_through_focus;              // over places along the radial direction
    std::vector<double> strehl_of_height;
};

struct WaveFigures {
    WaveAxes axes;
    std::vector<WavePoint> points;
};

// The figures of the axis, the middle of a side and the corner of the field, for heights from -reach to reach (mm).
// Points that no light comes from are left out.
WaveFigures wave_figures(const optics::Instrument& instrument, double reach);

// A line for each point of the field, for a terminal.
std::string summary(const WaveFigures& figures);

// JSON with Strehl ratios, dark rings and Zernike coefficients.
nlohmann::ordered_json wave_json(const WaveFigures& figures);

} // namespace vkfv::measurement
