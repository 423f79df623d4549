// The kinds of specimens, one file each in specimen/kinds/, which the build finds (kinds.cmake). A kind is a struct
// named after its file, an aggregate that compares its members, with
//   name, meaning               as the configuration has it, and a sentence
//   keys()                      those of [specimen] that it has, besides `kind`
//   read(section)               itself, by these keys, in the order in which they are to be written
// and of these members the one that makes it, which throws InputError where a value does not fit:
//   Analytic function(where)    over a square (Continuous): facets too
//   raise(field, pitch, where)  heights on the level field of a square (Square)
//   HeightField heights(where)  of a file
//   Mesh mesh(where)            of a file; takes no roughness
// and random_heights(), if it has some, and feature(), what is measured on it, if it is a standard. where: of the
// [specimen] table, or of its `file`. A line "// place: 3" says where the kind comes among the others; without one it
// comes last.
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

// What is said of a kind.
struct Kind {
    std::string name;
    std::string meaning;
    std::vector<const Key*> keys;
    Shape (*read)(const Section& section);
    bool takes_roughness;
};

// In the order of Shape's alternatives.
const std::vector<Kind>& kinds();

// The file that it is of; empty: none.
std::filesystem::path file_of(const Shape& shape);

// Side of the square that it covers or takes of its file, mm; 0: it has none.
double size_of(const Shape& shape);

// What is measured on it; none of kinds that are no standards.
std::optional<dimensions::Feature> feature_of(const Shape& shape);

// What is removed from its heights before they are compared with the true ones, unless the user says otherwise: of a
// standard with steps, waves or a sphere nothing but the plane of the deviation ("truth"), since a plane through a step
// takes a part of it, and through a broken number of waves too; of all others the least-squares plane.
surface::Form usual_form(const Shape& shape);

// The same with another pitch, mm, if it has one.
Shape with_pitch(Shape shape, double pitch);

} // namespace vkfv::specimen
