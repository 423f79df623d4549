// A measured BSDF: shaders/physics/scatter/tabulated.glsl.
#pragma once

#include "physics/physics.hpp"

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

namespace vkfv::specimen {

// A BSDF, linear between tabulated angles (rad, ascending, at least two of each; scatter from 0 to pi/2, azimuth from 0
// to pi).
struct TabulatedBsdf {
    std::vector<double> incidences;
    std::vector<double> scatters;
    std::vector<double> azimuths; // relative to the mirror direction
    std::vector<double> values;   // 1/sr, [incidence][scatter][azimuth]

    bool operator==(const TabulatedBsdf&) const = default;

    double value(std::size_t incidence, std::size_t scatter, std::size_t azimuth) const {
        return values[(incidence * scatters.size() + scatter) * azimuths.size() + azimuth];
    }
    // The interpolated value (1/sr); beyond the last incidence the value there.
    double at(double incidence, double scatter, double azimuth) const;
    // The share of light that one incidence scatters: the integral of f cos(theta) over the hemisphere.
    double kept(std::size_t incidence) const;
    // The deviation from reciprocity: the sum of |f(i, o) - f(o, i)| over that of their mean, for i and o the
    // incidences given in the table, weighted by projected solid angles. None with one incidence.
    std::optional<double> reciprocity_deviation() const;

    std::size_t given_incidences = 0; // number in the file; further incidences repeat the last one up to grazing
};

// Reads a CSV file with the columns incidence_deg, scatter_deg, azimuth_deg and bsdf_per_sr, or without azimuth_deg if
// the scatter does not depend on it: every combination of its angles once, in any order. Beyond the smallest and
// largest scatter angle and azimuth the outermost values hold. At normal incidence, where the azimuth is undefined, the
// mean over it is taken. Throws InputError (with the line) for anything else, for negative values, for an incidence
// that scatters more light than it receives, and for a deviation from reciprocity above the limit. Logs the shares and
// the deviation.
TabulatedBsdf read_tabulated_bsdf(const std::filesystem::path& file, const std::string& key, double reciprocity_limit);

// Appends the table's numbers in the model's layout; returns the lobe with their place.
physics::f64::Lobe with_numbers(physics::f64::Lobe lobe, const TabulatedBsdf& bsdf, std::vector<float>& numbers);

} // namespace vkfv::specimen
