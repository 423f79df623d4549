#include "specimen/specimen.hpp"

#include "physics/scatter_registry.hpp"
#include "specimen/scatter_tables.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>

namespace vkfv::specimen {

namespace {

using physics::scatter_registry;

// Without its tables.
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

// Likewise.
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

} // namespace

void check_material(const Material& material, const SourceLocation& where) {
    (void)lobe_records(material, where);
}

physics::f64::Material material_record(const Material& material, const SourceLocation& where) {
    auto lobes = lobe_records(material, where);
    for (std::size_t k = 0; k < material.lobes.size(); ++k) {
        lobes[k] = tabulated(lobes[k]);
    }
    return {lobes[0], lobes[1], lobes[2], lobes[3]};
}

} // namespace vkfv::specimen
