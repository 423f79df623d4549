#include "specimen/square.hpp"

#include "core/keys/section.hpp"

#include <algorithm>

namespace vkfv::specimen {
namespace {

constexpr double default_pitch_um = 0.5; // below the resolution of any objective

const NumberKey size_key =
    for_example("0.3", NumberKey("size_mm", NumberRange::positive(), needed,
                                 "Side of the square that the specimen covers, centred on the axis."));

const NumberKey pitch_key("pitch_um", NumberRange::positive(),
                          Default::in_words("that of [specimen.roughness], or 0.5 without one"),
                          "Distance of neighbouring points of the facets' grid; the finer of this and the roughness's "
                          "is taken, and adjusted to divide the size.");

const ChoiceKey<Representation>
    representation_key("representation",
                       {{Representation::facets, "facets", "Triangles between the points of a grid."},
                        {Representation::analytic, "analytic", "The continuous function itself, without facets."}},
                       Representation::facets, "What light meets.");

std::vector<const Key*> joined(std::vector<const Key*> first, const std::vector<const Key*>& others) {
    first.insert(first.end(), others.begin(), others.end());
    return first;
}

} // namespace

Analytic Continuous::function_of(std::uint32_t shape, const std::array<double, 4>& parameters) const {
    Analytic function;
    function.shape = shape;
    std::ranges::copy(parameters, function.parameters);
    function.x_min = function.y_min = -0.5 * size;
    function.x_max = function.y_max = 0.5 * size;
    return function;
}

std::vector<const Key*> square_keys(const std::vector<const Key*>& of_the_kind) {
    return joined({&size_key, &pitch_key}, of_the_kind);
}

std::vector<const Key*> continuous_keys(const std::vector<const Key*>& of_the_kind) {
    return joined({&size_key, &pitch_key, &representation_key}, of_the_kind);
}

const Key& square_pitch_key() {
    return pitch_key;
}

double read_square_pitch(const Section& section) {
    // By default facets are as fine as the roughness needs.
    const auto roughness = section.table().optional_table("roughness");
    const auto of_roughness =
        roughness ? roughness->optional_number("pitch_um", NumberRange::positive()) : std::nullopt;
    return from_um(section.number(pitch_key, of_roughness.value_or(default_pitch_um)));
}

void read_square(const Section& section, Square& square) {
    square.size = section.number(size_key);
    square.pitch = read_square_pitch(section);
}

void read_continuous(const Section& section, Continuous& continuous) {
    continuous.representation = section.choice(representation_key);
    read_square(section, continuous);
}

} // namespace vkfv::specimen
