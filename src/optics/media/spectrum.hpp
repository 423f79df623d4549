// The source's spectrum, in the form that the trace draws wavelengths from, and dispersion over it.
#pragma once

#include "optics/media/medium.hpp"
#include "physics/physics.hpp"

#include <vector>

namespace vkfv::optics {

// Of a Gaussian spectrum, in standard deviations on either side of its centre: 6e-5 of the flux lies beyond.
inline constexpr int gaussian_reach = 4;

struct Spectrum {
    // Shares of the flux, their sum 1, ascending in wavelength (um).
    std::vector<physics::f64::SpectralBin> bins;
    // The reference wavelength: the flux's mean for a spectrum. First-order data belong to it.
    double reference_um = 0;
    double shortest_um = 0;
    double longest_um = 0;

    bool monochromatic() const { return shortest_um == longest_um; }
    // Of the spectral coordinate x (physics::Light): x = 0 is the reference.
    double centre() const { return 1 / (reference_um * reference_um); } // 1/um^2
    double half_width() const;                                          // 1/um^2; 1 for a single wavelength

    static Spectrum line(double wavelength_um);
    // Relative fluxes of single wavelengths.
    static Spectrum lines(const std::vector<double>& wavelengths_um, const std::vector<double>& weights);
    // A Gaussian in wavelength, of the given full width at half maximum, cut at gaussian_reach.
    static Spectrum gaussian(double centre_um, double full_width_um);
    // A spectral flux that is linear between the points and zero outside. All three throw InputError.
    static Spectrum table(const std::vector<double>& wavelengths_um, const std::vector<double>& densities);
    // Light of several spectra together, each with its flux. No kernel draws from it: it may have any number of bins.
    struct Part;
    static Spectrum mixture(const std::vector<Part>& parts);

    bool operator==(const Spectrum& other) const; // the same light
};

struct Spectrum::Part {
    double flux = 0; // > 0
    Spectrum spectrum;
};

// A wavelength of a quadrature over the spectrum.
struct SpectralNode {
    double spectral = 0; // x of physics::Light
    double wavelength_um = 0;
    double weight = 0; // share of the flux; they add up to 1
};

// Lines one by one, a continuous spectrum by at least `fewest` nodes in its bins. centre, half_width: as Spectrum's.
std::vector<SpectralNode> spectral_nodes(const std::vector<physics::f64::SpectralBin>& bins, double centre,
                                         double half_width, int fewest = 32);

// Neighbouring nodes joined, so that at most this many are left, each with about the same share.
std::vector<SpectralNode> at_most(int most, const std::vector<SpectralNode>& nodes);

// Index of a medium over a spectrum: at x = 0 exactly, and a polynomial that agrees at six wavelengths more.
struct SpectralIndex {
    double centre = 1;
    physics::f64::Dispersion dispersion{};
};
SpectralIndex spectral_index(const Medium& medium, const Spectrum& spectrum);

} // namespace vkfv::optics
