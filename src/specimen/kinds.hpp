// The kinds of specimens, one file each in specimen/kinds/, which the build finds (kinds.cmake). A kind is a struct
// named after its file, an aggregate that compares its members, with
//   name, meaning               the value of `kind` in the configuration, and a sentence
//   keys()                      the kind's keys of [specimen], besides `kind`
//   read(section)               the shape by these keys, in the order in which they are to be written
// and with the one of these members that makes it, which throws InputError for invalid values:
//   Analytic function(where)    a function over a square (Continuous), also for facets
//   raise(field, pitch, where)  heights on the level field of a square (Square)
//   HeightField heights(where)  heights from a file
//   Mesh mesh(where)            a mesh from a file; it takes no roughness
// Further members are random_heights(), if the kind has some, and feature(), the feature to be measured, if it is a
// measurement standard. where: place of the [specimen] table, or of its `file`. A line "// place: 3" states the kind's
// place among the others; without one it comes last.
#pragma once

#include "specimen/shape.hpp"

#include "dimensions/feature.hpp"
#include "surface/form.hpp"

#include <concepts>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

namespace vkfv::specimen {

template <class Kind>
concept FunctionKind = std::derived_from<Kind, Continuous> && requires(const Kind& kind, const SourceLocation& where) {
    { kind.function(where) } -> std::same_as<Analytic>;
};
template <class Kind>
concept RaisedKind = std::derived_from<Kind, Square> &&
    requires(const Kind& kind, HeightField& field, const SourceLocation& where) {
    kind.raise(field, 1.0, where);
};
template <class Kind>
concept HeightsKind = requires(const Kind& kind, const SourceLocation& where) {
    { kind.heights(where) } -> std::same_as<HeightField>;
};
template <class Kind>
concept MeshKind = requires(const Kind& kind, const SourceLocation& where) {
    { kind.mesh(where) } -> std::same_as<Mesh>;
};

// The description of a kind.
struct Kind {
    std::string name;
    std::string meaning;
    std::vector<const Key*> keys;
    Shape (*read)(const Section& section);
    bool takes_roughness;
};

// All kinds, in the order of Shape's alternatives.
const std::vector<Kind>& kinds();

// The file of a shape; empty if it has none.
std::filesystem::path file_of(const Shape& shape);

// Side (mm) of the square that a shape covers or takes from its file; 0 if it has none.
double size_of(const Shape& shape);

// The feature to be measured on a shape; none unless it is a measurement standard.
std::optional<dimensions::Feature> feature_of(const Shape& shape);

// The form that is removed from measured heights before their comparison with the true ones, unless the user chooses
// another: for a standard with steps, waves or a sphere only the plane of the deviation ("truth"), as a plane through a
// step, or through a fractional number of waves, would remove a part of it; for all others the least-squares plane.
surface::Form usual_form(const Shape& shape);

// The shape with another pitch (mm), if it has a pitch.
Shape with_pitch(Shape shape, double pitch);

} // namespace vkfv::specimen
