// The reference arm of an interferometer: what light meets that does not go to the specimen. Lengths in mm.
#pragma once

#include "optics/media/medium.hpp"

#include <glm/glm.hpp>

#include <optional>

namespace vkfv::fields {

struct ReferenceArm {
    // linnik: an objective of its own; michelson: the splitter stands below the objective; mirau: the mirror stands in
    // the middle of the objective's front lens and obscures the pupil.
    enum class Kind { linnik, michelson, mirau } kind = Kind::michelson;
    double reflectance = 1;          // of the mirror
    glm::dvec2 tilt = glm::dvec2(0); // slopes dz/dx and dz/dy of the mirror's image in the object
    double defocus = 0;              // distance of the mirror from the reference objective's focus
    double obscuration = 0;          // radius of the mirau's obscuration over that of the pupil
    // Glass that light of the reference arm passes twice beyond what light of the object's arm does; its delay at the
    // reference wavelength is balanced by the mirror's place, so that its dispersion is left.
    double glass_thickness = 0;
    std::optional<optics::Medium> glass{};
};

} // namespace vkfv::fields
