// Form removal chosen by name.
#pragma once

#include "surface/height_map.hpp"

#include <optional>
#include <string>
#include <string_view>

namespace vkfv::surface {

// The form of a surface, which is fitted by least squares and removed: the F-operator of ISO 25178-2.
struct Form {
    // `truth` removes nothing: a surface that is compared with its truth (topography/compare.hpp) is aligned to it by
    // offset and tilt, and a surface alone has no truth.
    enum class Kind { none, plane, polynomial, sphere, truth };
    Kind kind = Kind::plane;
    int degree = 0; // degree of a polynomial

    bool operator==(const Form&) const = default;
};

// Parses "none", "plane", "polynomial-1" to "polynomial-20", "sphere" or "truth"; none for any other text.
std::optional<Form> parse_form(std::string_view text);
// The form as text for parse_form().
std::string form_name(const Form& form);

// The greatest magnitude of a measured height; 0 without measured points.
double greatest_height(const HeightMap& map);

// The residual of a form or filter on heights of up to `greatest`. If it varies by no more than their rounding (Sq
// below 1e-13 of `greatest`), it is replaced by 0: rounding has no shape or direction of a surface.
HeightMap without_rounding(HeightMap rest, double greatest);

// Removes the form by filter.hpp, polynomial.hpp and sphere.hpp, then applies without_rounding(). If the points
// determine no sphere, all become not measured, as do points beyond the sphere's radius.
HeightMap remove_form(HeightMap map, const Form& form);

} // namespace vkfv::surface
