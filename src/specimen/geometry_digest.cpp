#include "specimen/geometry_digest.hpp"

#include "core/files/digest.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <span>

namespace vkfv::specimen {

std::string geometry_digest(const Specimen& specimen) {
    Digest digest;
    const auto add_field = [&](const HeightField& field) {
        digest.add(fmt::format("{} {} {} {} {} {};", field.heights.columns, field.heights.rows, field.x_min,
                               field.y_min, field.pitch_x, field.pitch_y));
        digest.add_values(std::span<const float>(field.heights.values));
    };
    if (const auto* field = std::get_if<HeightField>(&specimen.geometry)) {
        add_field(*field);
    } else if (const auto* mesh = std::get_if<Mesh>(&specimen.geometry)) {
        digest.add_values(std::span<const glm::vec3>(mesh->vertices));
        digest.add_values(std::span<const glm::uvec3>(mesh->triangles));
    } else if (const auto* analytic = std::get_if<Analytic>(&specimen.geometry)) {
        digest.add(fmt::format("{} {} {} {} {} {};", analytic->shape, fmt::join(analytic->parameters, " "),
                               analytic->x_min, analytic->y_min, analytic->x_max, analytic->y_max));
        if (analytic->lattice) {
            add_field(*analytic->lattice);
        }
    }
    // The digest includes the reflectance map's values from files or random numbers; its other parameters are keys,
    // which the identity contains already.
    if (specimen.reflectance && !specimen.reflectance->values.values.empty()) {
        const Grid<float>& values = specimen.reflectance->values;
        digest.add(fmt::format("reflectance {} {};", values.columns, values.rows));
        digest.add_values(std::span<const float>(values.values));
    }
    return digest.text();
}

} // namespace vkfv::specimen
