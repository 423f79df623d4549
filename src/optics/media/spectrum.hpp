// The source's spectrum, in the form from which the trace draws wavelengths, and dispersion over it.
#pragma once

#include "optics/media/medium.hpp"
#include "physics/physics.hpp"

#include <vector>

namespace vkfv::optics {

// Half width of a Gaussian spectrum in standard deviations: 6e-5 of the flux beyond is cut off.
inline constexpr int gaussian_reach = 4;

struct Spectrum {
    // Shares of the flux, which sum to 1, in ascending order of wavelength (um).
    std::vector<physics::f64::SpectralBin> bins;
    // The reference wavelength, to which first-order data belong: the mean over the flux of a spectrum.
    double reference_um = 0;
    double shortest_um = 0;
    double longest_um = 0;

    bool monochromatic() const { return shortest_um == longest_um; }
    // Centre and half width define the spectral coordinate x (physics::Light), which is 0 at the reference wavelength.
    double centre() const { return 1 / (reference_um * reference_um); } // 1/um^2
    double half_width() const;                                          // 1/um^2; 1 for a single wavelength

    static Spectrum line(double wavelength_um);
    // A spectrum of single wavelengths with relative fluxes. Throws InputError.
    static Spectrum lines(const std::vector<double>& wavelengths_um, const std::vector<double>& weights);
    // A Gaussian in wavelength, of the given full width at half maximum, cut at gaussian_reach. Throws InputError.
    static Spectrum gaussian(double centre_um, double full_width_um);
    // A spectral flux that is linear between the points and zero outside. Throws InputError.
    static Spectrum table(const std::vector<double>& wavelengths_um, const std::vector<double>& densities);
    // The sum of several spectra, each with its flux. No kernel draws from it: it may have any number of bins.
    struct Part;
    static Spectrum mixture(const std::vector<Part>& parts);

    bool operator==(const Spectrum& other) const; // true for the same light
};

struct Spectrum::Part {
    double flux = 0; // > 0
    Spectrum spectrum;
};

// A wavelength of a quadrature over the spectrum.
struct SpectralNode {
    double spectral = 0; // spectral coordinate x of physics::Light
    double wavelength_um = 0;
    double weight = 0; // share of the flux; the weights sum to 1
};

// Quadrature nodes of a spectrum: each line is one node, a continuous spectrum has at least `fewest` nodes in its bins.
// centre, half_width: those of the Spectrum.
std::vector<SpectralNode> spectral_nodes(const std::vector<physics::f64::SpectralBin>& bins, double centre,
                                         double half_width, int fewest = 32);

// Joins neighbouring nodes until at most `most` are left, each with about the same share.
std::vector<SpectralNode> at_most(int most, const std::vector<SpectralNode>& nodes);

// Index of a medium over a spectrum: exact at x = 0, elsewhere a polynomial that agrees at six further wavelengths.
struct SpectralIndex {
    double centre = 1;
    physics::f64::Dispersion dispersion{};
};
SpectralIndex spectral_index(const Medium& medium, const Spectrum& spectrum);

} // namespace vkfv::optics
