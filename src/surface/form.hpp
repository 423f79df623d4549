// Form removal chosen by name.
#pragma once

#include "surface/height_map.hpp"

#include <optional>
#include <string>
#include <string_view>

namespace vkfv::surface {

// What is taken for the form of a surface, fitted by least squares: the F-operator of ISO 25178-2.
struct Form {
    // truth: nothing. Where a surface is compared with its truth (topography/compare.hpp) it is brought to it by offset
    // and tilt; of one alone there is none to remove.
    enum class Kind { none, plane, polynomial, sphere, truth };
    Kind kind = Kind::plane;
    int degree = 0; // of the polynomial

    bool operator==(const Form&) const = default;
};

// "none", "plane", "polynomial-1" to "polynomial-20", "sphere" or "truth"; nothing for any other text.
std::optional<Form> parse_form(std::string_view text);
// The text that parse_form() reads.
std::string form_name(const Form& form);

// The greatest magnitude of a measured height; 0 without any.
double greatest_height(const HeightMap& map);

// What a form or a filter left of heights of up to `greatest`. Where it varies by no more than the rounding of these
// (Sq below 1e-13 of them) it is level, 0: shape and direction of rounding are no surface's.
HeightMap without_rounding(HeightMap rest, double greatest);

// By filter.hpp, polynomial.hpp and sphere.hpp, and without_rounding(). Where the points settle no sphere none is left
// measured, and none beyond the sphere's radius.
HeightMap remove_form(HeightMap map, const Form& form);

} // namespace vkfv::surface
