// A measured bsdf: shaders/physics/scatter/tabulated.glsl.
#pragma once

#include "physics/physics.hpp"

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

namespace vkfv::specimen {

// Linear between its angles (rad, ascending, at least two of each; scatter from 0 to pi/2, azimuth from 0 to pi).
struct TabulatedBsdf {
    std::vector<double> incidences;
    std::vector<double> scatters;
    std::vector<double> azimuths; // against the mirror direction's
    std::vector<double> values;   // [incidence][scatter][azimuth], 1/sr

    bool operator==(const TabulatedBsdf&) const = default;

    double value(std::size_t incidence, std::size_t scatter, std::size_t azimuth) const {
        return values[(incidence * scatters.size() + scatter) * azimuths.size() + azimuth];
    }
    // Linear; beyond the last incidence that of the last.
    double at(double incidence, double scatter, double azimuth) const;
    // Share of the light that one incidence keeps: the integral of f cos(theta) over the hemisphere.
    double kept(std::size_t incidence) const;
    // How far it is from reciprocal: the sum of |f(i, o) - f(o, i)| over that of their mean, for i and o the incidences
    // that the table was given, by projected solid angles. None with one incidence.
    std::optional<double> reciprocity_deviation() const;

    std::size_t given_incidences = 0; // others hold the last one up to grazing incidence
};

// A CSV file with the columns incidence_deg, scatter_deg, azimuth_deg and bsdf_per_sr, or without azimuth_deg where the
// scatter does not depend on it: every combination of its angles once, in any order. Beyond the smallest and largest
// scatter angle and azimuth the outermost values hold. At normal incidence, where there is no azimuth, it takes the
// mean over it. Throws InputError (with the line) for anything else, for negative values, for an incidence that keeps
// more light than it is given, and for a deviation from reciprocity above the limit. Tells both.
TabulatedBsdf read_tabulated_bsdf(const std::filesystem::path& file, const std::string& key, double reciprocity_limit);

// Appends its numbers as the model reads them; gives the lobe with where they stand.
physics::f64::Lobe with_numbers(physics::f64::Lobe lobe, const TabulatedBsdf& bsdf, std::vector<float>& numbers);

} // namespace vkfv::specimen
