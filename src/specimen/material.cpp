#include "specimen/specimen.hpp"

#include "physics/scatter_registry.hpp"
#include "specimen/scatter_tables.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>

namespace vkfv::specimen {

namespace {

using physics::scatter_registry;

// The record of a lobe, without its tables.
physics::f64::Lobe lobe_record(const Lobe& lobe, const SourceLocation& where) {
    const auto model = std::ranges::find(scatter_registry, lobe.model, &physics::ScatterModel::name);
    if (model == scatter_registry.end() || model->parameters.size() != lobe.parameters.size()) {
        throw InputError({where, "specimen.material.scatter",
                          fmt::format("{} with {} parameters", lobe.model, lobe.parameters.size()),
                          "a model of shaders/physics/scatter with its parameters",
                          "Correct the name or the number of parameters."});
    }
    if (!(lobe.weight > 0 && lobe.weight <= 1)) {
        throw InputError({where, "specimen.material.weight", fmt::format("{}", lobe.weight), "a number in (0, 1]",
                          "Correct the weight, or leave the lobe out."});
    }
    if (model->from_file != lobe.bsdf.has_value()) {
        throw InputError({where, "specimen.material.file", lobe.bsdf ? "a table" : "no table",
                          fmt::format("{} for scatter = \"{}\"", model->from_file ? "a table" : "no table", lobe.model),
                          "Give the file of the table, or remove it."});
    }
    std::array<double, 4> parameters{};
    for (std::size_t k = 0; k < lobe.parameters.size(); ++k) {
        const auto& parameter = model->parameters[k];
        parameters[k] = lobe.parameters[k];
        if (!(parameters[k] >= parameter.minimum && parameters[k] <= parameter.maximum)) {
            throw InputError({where, fmt::format("specimen.material.{}", parameter.name),
                              fmt::format("{}", parameters[k]),
                              fmt::format("a number in [{}, {}]", parameter.minimum, parameter.maximum),
                              "Correct the value in the configuration."});
        }
    }
    physics::f64::Lobe result{};
    result.model = static_cast<std::uint32_t>(model - scatter_registry.begin());
    result.weight = lobe.weight;
    result.parameter_0 = parameters[0];
    result.parameter_1 = parameters[1];
    result.parameter_2 = parameters[2];
    result.parameter_3 = parameters[3];
    return result;
}

// The records of all lobes, without their tables.
std::array<physics::f64::Lobe, most_lobes> lobe_records(const Material& material, const SourceLocation& where) {
    if (material.lobes.size() > most_lobes) {
        throw InputError({where, "specimen.material.lobe", fmt::format("{} lobes", material.lobes.size()),
                          fmt::format("at most {}", most_lobes), "Leave the weakest out."});
    }
    std::array<physics::f64::Lobe, most_lobes> lobes{};
    double reflectance = 0;
    for (std::size_t k = 0; k < material.lobes.size(); ++k) {
        lobes[k] = lobe_record(material.lobes[k], where);
        reflectance += lobes[k].weight;
    }
    if (reflectance > 1 + weight_rounding) {
        throw InputError({where, "specimen.material.lobe", fmt::format("weights that add up to {:.6g}", reflectance),
                          "at most 1", "Choose smaller weights; what they leave of 1 is absorbed."});
    }
    return lobes;
}

// All wavelengths at which a function of the material has a point; a single one is doubled, as interpolation needs two.
std::vector<double> spectral_points(const Material& material) {
    std::vector<double> wavelengths;
    for (const Lobe& lobe : material.lobes) {
        for (const auto* function : {&lobe.reflectance, &lobe.refractive_index}) {
            wavelengths.insert(wavelengths.end(), function->wavelengths_um.begin(), function->wavelengths_um.end());
        }
    }
    std::ranges::sort(wavelengths);
    wavelengths.erase(std::unique(wavelengths.begin(), wavelengths.end()), wavelengths.end());
    if (wavelengths.size() == 1) {
        wavelengths.push_back(wavelengths.front() + 1);
    }
    return wavelengths;
}

// Appends a point of the spectrum in the layout that shaders/physics/reflectance.glsl reads.
void add_spectral_point(const Material& material, double wavelength_um, std::vector<float>& numbers) {
    numbers.push_back(static_cast<float>(wavelength_um));
    for (std::size_t k = 0; k < most_lobes; ++k) {
        std::array<double, 3> values = {1, 0, 0};
        if (k < material.lobes.size()) {
            const Lobe& lobe = material.lobes[k];
            if (!lobe.reflectance.values.empty()) {
                values[0] = lobe.reflectance.at(wavelength_um);
            }
            if (!lobe.refractive_index.values.empty()) {
                values[1] = lobe.refractive_index.at(wavelength_um);
                values[2] = lobe.extinction_coefficient.at(wavelength_um);
            } else if (lobe.parameters.size() >= 2) { // models without an index ignore them
                values[1] = lobe.parameters[0];
                values[2] = lobe.parameters[1];
            }
        }
        for (const double value : values) {
            numbers.push_back(static_cast<float>(value));
        }
    }
}

MaterialNumbers spectrum_of(const Material& material) {
    const std::vector<double> wavelengths = spectral_points(material);
    MaterialNumbers numbers{static_cast<int>(wavelengths.size()), {}};
    for (const double wavelength : wavelengths) {
        add_spectral_point(material, wavelength, numbers.numbers);
    }
    return numbers;
}

} // namespace

void check_material(const Material& material, const SourceLocation& where) {
    (void)lobe_records(material, where);
}

double SpectralFunction::at(double wavelength_um) const {
    if (wavelengths_um.size() == 1) {
        return values.front();
    }
    const auto next = std::upper_bound(wavelengths_um.begin() + 1, wavelengths_um.end() - 1, wavelength_um);
    const auto k = static_cast<std::size_t>(next - wavelengths_um.begin());
    const double share = (wavelength_um - wavelengths_um[k - 1]) / (wavelengths_um[k] - wavelengths_um[k - 1]);
    return std::lerp(values[k - 1], values[k], std::clamp(share, 0.0, 1.0));
}

MaterialNumbers material_numbers(const Material& material) {
    MaterialNumbers numbers = spectrum_of(material);
    for (const Lobe& lobe : material.lobes) {
        if (lobe.bsdf) {
            (void)with_numbers({}, *lobe.bsdf, numbers.numbers);
        }
    }
    return numbers;
}

physics::f64::Material material_record(const Material& material, const SourceLocation& where) {
    auto lobes = lobe_records(material, where);
    MaterialNumbers numbers = spectrum_of(material);
    for (std::size_t k = 0; k < material.lobes.size(); ++k) {
        lobes[k] = tabulated(lobes[k]);
        if (material.lobes[k].bsdf) {
            lobes[k] = with_numbers(lobes[k], *material.lobes[k].bsdf, numbers.numbers);
        }
    }
    return {lobes[0], lobes[1], lobes[2], lobes[3]};
}

} // namespace vkfv::specimen
