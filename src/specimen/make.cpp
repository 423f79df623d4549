#include "specimen/description.hpp"
#include "specimen/generated.hpp"
#include "specimen/kinds.hpp"
#include "specimen/refined.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace vkfv::specimen {
namespace {

using physics::f64::SpecimenRecord;
using Geometry = decltype(Specimen::geometry);

// Refuses a surface that floats cannot hold, as a device needs them.
void check_extent(const Specimen& specimen, const SourceLocation& where) {
    const SpecimenRecord r = record_of_geometry(specimen);
    const double farthest = std::max({std::abs(r.x_min), std::abs(r.x_max), std::abs(r.y_min), std::abs(r.y_max),
                                      std::abs(r.bottom), std::abs(r.top)});
    const double narrowest = std::min(r.x_max - r.x_min, r.y_max - r.y_min);
    // The negated conditions also refuse NaN.
    if (!(farthest <= largest_length && narrowest >= smallest_length)) {
        throw InputError({where, "specimen",
                          fmt::format("a surface of {:.6g} x {:.6g} mm, from {:.6g} to {:.6g} mm high",
                                      r.x_max - r.x_min, r.y_max - r.y_min, r.bottom, r.top),
                          fmt::format("lengths from {} to {} mm", smallest_length, largest_length),
                          "Correct the lengths in [specimen], or the unit of its file."});
    }
}

template <class OneKind>
Geometry generated(const OneKind& kind, const Description& d) {
    static_assert(FunctionKind<OneKind> != RaisedKind<OneKind>, "specimen/kinds.hpp says what a kind has");
    Recipe recipe{.square = kind};
    if constexpr (FunctionKind<OneKind>) {
        recipe.representation = kind.representation;
        recipe.function = [&] { return kind.function(d.where); };
    } else {
        recipe.raise = [&](HeightField& field, double asked_pitch) { kind.raise(field, asked_pitch, d.where); };
    }
    if constexpr (requires { kind.random_heights(); }) {
        recipe.random = kind.random_heights();
    }
    return generate(recipe, d.roughness, d.where);
}

HeightField with_roughness(HeightField field, const Description& d) {
    if (d.roughness) {
        check_roughness(field.x_max() - field.x_min, field.y_max() - field.y_min, *d.roughness, d.where);
        // Roughness finer than the file's grid needs more points in between.
        if (d.roughness->pitch > 0 && d.roughness->pitch < std::max(field.pitch_x, field.pitch_y) * (1 - 1e-9)) {
            field = refined(field, d.roughness->pitch, d.where);
        }
        add_roughness(field, *d.roughness, d.where);
    }
    return field;
}

template <class OneKind>
Geometry geometry_of(const OneKind& kind, const Description& d) {
    if constexpr (MeshKind<OneKind>) {
        return kind.mesh(d.where);
    } else if constexpr (HeightsKind<OneKind>) {
        return with_roughness(kind.heights(d.where), d);
    } else {
        return generated(kind, d);
    }
}

} // namespace

Specimen make(const Description& d) {
    check_material(d.material, d.where);
    if (d.roughness && !kinds()[d.shape.index()].takes_roughness) {
        throw InputError({d.where, "specimen.roughness", "roughness on a mesh", "a height field or a generated kind",
                          "Remove [specimen.roughness], or put the roughness into the mesh."});
    }
    Specimen specimen;
    specimen.material = d.material;
    specimen.geometry = std::visit([&](const auto& kind) { return geometry_of(kind, d); }, d.shape);
    check_extent(specimen, d.where);
    if (d.reflectance) {
        const Footprint r = footprint(specimen);
        specimen.reflectance = make_reflectance_map(*d.reflectance, {r.x_min, r.y_min, r.x_max, r.y_max}, d.where);
    }
    place(specimen, d.placement, d.where);
    check_extent(specimen, d.where);
    return specimen;
}

std::optional<dimensions::Feature> feature_of(const Description& d) {
    return placed(feature_of(d.shape), d.placement);
}

} // namespace vkfv::specimen
