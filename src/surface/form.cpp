#include "surface/form.hpp"

#include "surface/filter.hpp"
#include "surface/height_parameters.hpp"
#include "surface/polynomial.hpp"
#include "surface/sphere.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

namespace vkfv::surface {
namespace {

constexpr int largest_degree = 20; // limit of least_squares_polynomial()

} // namespace

std::optional<Form> parse_form(std::string_view text) {
    using enum Form::Kind;
    for (const Form::Kind kind : {none, plane, sphere, truth})
        if (const Form form{.kind = kind}; text == form_name(form))
            return form;
    for (int degree = 1; degree <= largest_degree; ++degree)
        if (const Form form{.kind = polynomial, .degree = degree}; text == form_name(form))
            return form;
    return std::nullopt;
}

std::string form_name(const Form& form) {
    using enum Form::Kind;
    return form.kind == none     ? "none"
           : form.kind == plane  ? "plane"
           : form.kind == sphere ? "sphere"
           : form.kind == truth  ? "truth"
                                 : "polynomial-" + std::to_string(form.degree);
}

double greatest_height(const HeightMap& map) {
    double greatest = 0;
    for (const double z : map.height.values)
        if (std::isfinite(z))
            greatest = std::max(greatest, std::abs(z));
    return greatest;
}

HeightMap without_rounding(HeightMap rest, double greatest) {
    // Fits of some million points leave a residual of about a tenth of this.
    constexpr double rounding = 1e-13;
    if (height_parameters(rest).sq <= rounding * greatest)
        for (double& z : rest.height.values)
            if (std::isfinite(z))
                z = 0;
    return rest;
}

HeightMap remove_form(HeightMap map, const Form& form) {
    using enum Form::Kind;
    if (form.kind == none || form.kind == truth)
        return map;
    const double greatest = greatest_height(map);
    if (form.kind == plane) {
        const Plane fitted = least_squares_plane(map);
        map = remove_plane(std::move(map), fitted);
    } else if (form.kind == polynomial) {
        const Polynomial fitted = least_squares_polynomial(map, form.degree);
        map = remove_polynomial(std::move(map), fitted);
    } else if (form.kind == sphere) {
        const Sphere fitted = least_squares_sphere(map);
        map = remove_sphere(std::move(map), fitted);
    }
    return without_rounding(std::move(map), greatest);
}

} // namespace vkfv::surface
