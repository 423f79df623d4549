#include "measurement/scene/light_field.hpp"

#include "core/keys/section.hpp"

#include <string>
#include <utility>

namespace vkfv::measurement {

namespace {

constexpr int noise_points = 1024; // points along a side of the noise, which is mirrored beyond them
const std::string of_specimen = "specimen.reflectance", of_light = "illumination.field";

specimen::ReflectanceMap made_pattern(const specimen::Reflectance& pattern) {
    const double half = 0.5 * (noise_points - 1) * pattern.pitch;
    try {
        return make_reflectance_map(pattern, {-half, -half, half, half}, {});
    } catch (const InputError& error) {
        throw error.with_each([](InputProblem& problem) {
            if (problem.key.starts_with(of_specimen)) {
                problem.key.replace(0, of_specimen.size(), of_light);
            }
        });
    }
}

} // namespace

std::optional<optics::LightField> make_light_field(const Configuration& configuration) {
    if (!configuration.light_field) {
        return std::nullopt;
    }
    const LightFieldDescription& description = *configuration.light_field;
    optics::LightField field;
    at_its_place(configuration, {.file = configuration.file}, [&] {
        specimen::ReflectanceMap pattern = made_pattern(description.pattern);
        field.record.pattern = pattern.record;
        field.record.pattern.of_light = 1;
        field.points = std::move(pattern.values);
    });
    field.record.falloff = description.falloff;
    field.record.brightest_x = description.brightest.x;
    field.record.brightest_y = description.brightest.y;
    return field;
}

} // namespace vkfv::measurement
