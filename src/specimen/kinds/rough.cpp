#include "specimen/kinds/rough.hpp"

#include "core/keys/section.hpp"

namespace vkfv::specimen {
namespace {

const NumberKey rough_sq_key = for_example(
    "1.0", NumberKey("sq_um", NumberRange::at_least(0),
                     Default::in_words("0 with [specimen.roughness]; else it is needed"), "Root mean square height."));

} // namespace

std::vector<const Key*> Rough::keys() {
    return continuous_keys(random_heights_keys(rough_sq_key));
}

Rough Rough::read(const Section& section) {
    Rough rough;
    read_continuous(section, rough);
    // The lattice of [specimen.roughness] may be the only roughness, so sq_um is optional beside it.
    const bool has_roughness = section.table().optional_table("roughness").has_value();
    const double sq = has_roughness ? section.number(rough_sq_key, 0.0) : section.number(rough_sq_key);
    rough.random = read_random_heights(section, from_um(sq), rough.pitch);
    return rough;
}

Analytic Rough::function(const SourceLocation&) const {
    return function_of(physics::f64::SHAPE_PLANE);
}

} // namespace vkfv::specimen
