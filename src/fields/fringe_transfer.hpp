// The transfer function of an interferometer: how the waves of a height map make the coherent part of its image.
//
// With the direction cosines s of the source's light and p of the scattered light times the index, q = k (p - s) and
// q_z = k (gamma_s + gamma_p), gamma = sqrt(n^2 - |.|^2), the coherent part is
//   E(x, zeta) = sum over q_z of exp(i q_z zeta) IFFT[ H(q, q_z) FFT[ exp(-i q_z h) ] ],   I = background + 2 Re E,
// the sum over source, pupil and spectrum of Kirchhoff's integral for a surface of heights h (P. de Groot and X.
// Colonna de Lega, "Fourier optics modeling of interference microscopes", J. Opt. Soc. Am. A 37, B1, 2020). Its
// obliquity factor is taken as 1 everywhere here; facet.hpp makes up for it where the surface is tilted.
#pragma once

#include "fields/reference_arm.hpp"
#include "optics/waves/wavefront.hpp"

#include <complex>
#include <cstddef>
#include <span>
#include <vector>

namespace vkfv::fields {

// H for a pupil, a source and a wavefront that are round, so that it depends on |q|; 1 for a level mirror in focus:
// the sum over q_z of H(0, q_z) exp(i q_z centre) of a perfect, balanced interferometer without spectral width.
class FringeTransfer {
  public:
    // wavefronts: of the wavelengths, whose weights sum to 1, on the axis and round. source_fill: radius of the
    // source's image over that of the pupil, at most 1 counts. centre, half_range: middle and half of the range of zeta
    // - h (mm) for which H holds; the factor exp(i q_z centre) is part of H. reference_um: the wavelength at which the
    // delay by the reference's glass is balanced.
    FringeTransfer(std::span<const optics::Wavefront> wavefronts, const ReferenceArm& arm, double source_fill,
                   double centre, double half_range, double reference_um);

    int nodes() const { return nodes_; }
    double wave_number(int node) const { return first_ + node * spacing_; }     // q_z, rad/mm
    int steps() const { return steps_; }                                        // from frequency 0 to the cutoff
    const std::vector<std::complex<double>>& values() const { return values_; } // [step * nodes + node]
    double cutoff() const { return cutoff_; }                                   // |q| / 2 pi, cycles per mm
    std::complex<double> at(int node, double frequency) const;                  // frequency: |q| / 2 pi, cycles per mm

  private:
    class RadialPath;
    struct Pupil;
    void add(std::size_t step, const Pupil& pupil, double frequency);

    int nodes_ = 0;
    int steps_ = 0;
    double first_ = 0;
    double spacing_ = 0;
    double cutoff_ = 0;
    std::vector<std::complex<double>> values_; // [step * nodes + node]
};

// The number of wavelengths of a spectrum for which the sum over them is the integral, for zeta - h within +-
// half_range (mm): neighbouring ones are a radian apart at its ends.
int wavelengths_for(double shortest_um, double longest_um, double half_range);

} // namespace vkfv::fields
