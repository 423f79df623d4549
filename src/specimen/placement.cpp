#include "specimen/placement.hpp"

#include <fmt/format.h>
#include <glm/gtc/matrix_transform.hpp>

#include <algorithm>
#include <cmath>

namespace vkfv::specimen {
namespace {

constexpr const char* key = "specimen.placement";

glm::dvec2 turned(glm::dvec2 point, double angle) {
    return {point.x * std::cos(angle) - point.y * std::sin(angle),
            point.x * std::sin(angle) + point.y * std::cos(angle)};
}

// The triangles of a height field, as the trace splits its cells (HeightField).
Mesh mesh_of(const HeightField& field) {
    const int columns = field.heights.columns, rows = field.heights.rows;
    Mesh mesh;
    mesh.vertices.reserve(field.heights.values.size());
    for (int row = 0; row < rows; ++row) {
        for (int column = 0; column < columns; ++column) {
            mesh.vertices.emplace_back(field.x_min + column * field.pitch_x, field.y_min + row * field.pitch_y,
                                       field.heights(column, row));
        }
    }
    mesh.triangles.reserve(2 * static_cast<std::size_t>(columns - 1) * static_cast<std::size_t>(rows - 1));
    for (int row = 0; row + 1 < rows; ++row) {
        for (int column = 0; column + 1 < columns; ++column) {
            const auto corner = static_cast<std::uint32_t>(row * columns + column);
            const auto above = corner + static_cast<std::uint32_t>(columns);
            mesh.triangles.emplace_back(corner, corner + 1, above + 1);
            mesh.triangles.emplace_back(corner, above + 1, above);
        }
    }
    return mesh;
}

void move(Mesh& mesh, const Placement& placement) {
    const glm::dmat3 turn = placement.turn();
    std::ranges::transform(mesh.vertices, mesh.vertices.begin(), [&](const glm::vec3& vertex) {
        return glm::vec3(turn * glm::dvec3(vertex) + placement.shift);
    });
}

void move(HeightField& field, glm::dvec3 shift) {
    field.x_min += shift.x;
    field.y_min += shift.y;
    std::ranges::transform(field.heights.values, field.heights.values.begin(),
                           [&](float height) { return static_cast<float>(height + shift.z); });
}

void require_that_it_turns(const HeightField& field, const SourceLocation& where) {
    const double facets = 2.0 * (field.heights.columns - 1) * (field.heights.rows - 1);
    if (facets > most_turned_facets) {
        throw InputError({where, key, fmt::format("a turn of {:.3g} facets", facets),
                          fmt::format("at most {:.3g} facets, which become a mesh", most_turned_facets),
                          "Choose a larger specimen.pitch_um or a smaller specimen, or do not turn it."});
    }
    if (!field.interpolated.empty()) {
        throw InputError({where, key, "a turn of a surface with points that were not measured",
                          "a whole surface, or a placement without rotation and tilt",
                          "Turn the surface before it is read, or fill its gaps."});
    }
}

} // namespace

glm::dmat3 Placement::turn() const {
    const glm::dmat4 about_z = glm::rotate(glm::dmat4(1), rotation, glm::dvec3(0, 0, 1));
    const glm::dvec2 slope(std::tan(tilt_x), std::tan(tilt_y));
    const double steepness = glm::length(slope);
    if (steepness == 0) {
        return glm::dmat3(about_z);
    }
    // The axis is z x n for the normal n = (-slope, 1) of the tilted level.
    const glm::dvec3 axis(slope.y / steepness, -slope.x / steepness, 0);
    return glm::dmat3(glm::rotate(glm::dmat4(1), std::atan(steepness), axis) * about_z);
}

void place(Specimen& specimen, const Placement& placement, const SourceLocation& where) {
    if (placement == Placement{}) {
        return;
    }
    if (std::holds_alternative<Analytic>(specimen.geometry)) {
        throw InputError({where, key, "a placement of an analytic surface", "a surface of facets, or a mesh",
                          "Choose specimen.representation = \"facets\"."});
    }
    if (auto* field = std::get_if<HeightField>(&specimen.geometry)) {
        if (!placement.turns()) {
            move(*field, placement.shift);
        } else {
            require_that_it_turns(*field, where);
            specimen.geometry = mesh_of(*field);
        }
    }
    if (auto* mesh = std::get_if<Mesh>(&specimen.geometry)) {
        move(*mesh, placement);
    }
    if (specimen.reflectance) {
        auto& record = specimen.reflectance->record;
        const glm::dvec2 centre = turned({record.centre_x, record.centre_y}, placement.rotation);
        const glm::dvec2 axis = turned({record.axis_x, record.axis_y}, placement.rotation);
        record.centre_x = centre.x + placement.shift.x;
        record.centre_y = centre.y + placement.shift.y;
        record.axis_x = axis.x;
        record.axis_y = axis.y;
    }
}

std::optional<dimensions::Feature> placed(std::optional<dimensions::Feature> feature, const Placement& placement) {
    if (!feature || placement == Placement{}) {
        return feature;
    }
    if (auto* plateaus = std::get_if<dimensions::Plateaus>(&*feature)) {
        if (placement.turns()) {
            return std::nullopt;
        }
        plateaus->nominal.x0 += placement.shift.x;
        plateaus->nominal.y0 += placement.shift.y;
    }
    std::visit(
        [&](auto& one) {
            if constexpr (requires { one.frame; }) {
                const glm::dvec2 middle = turned({one.frame.x, one.frame.y}, placement.rotation);
                one.frame.x = middle.x + placement.shift.x;
                one.frame.y = middle.y + placement.shift.y;
                one.frame.angle += placement.rotation;
            }
        },
        *feature);
    return feature;
}

} // namespace vkfv::specimen
