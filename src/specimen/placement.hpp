// The place in which a specimen lies under the objective.
#pragma once

#include "core/messages/error.hpp"
#include "dimensions/feature.hpp"
#include "specimen/specimen.hpp"

#include <glm/glm.hpp>

#include <optional>

namespace vkfv::specimen {

// A rigid motion of the specimen from the middle of the frame: turned about z, then tilted, then displaced. mm, rad.
struct Placement {
    glm::dvec3 shift{0};
    double rotation = 0; // about z, from +x towards +y
    // Slope angles along x and y of a surface that was level. The tilt turns the specimen about the horizontal axis of
    // this slope.
    double tilt_x = 0;
    double tilt_y = 0;

    bool turns() const { return rotation != 0 || tilt_x != 0 || tilt_y != 0; }
    bool operator==(const Placement&) const = default;

    // The rotation and tilt together.
    glm::dmat3 turn() const;
};

// Puts the specimen there. Facets that are turned become a mesh of the same triangles. A reflectance map is displaced
// and turned with its specimen; it stays a function of x and y, and is not foreshortened by a tilt. Throws InputError
// (placed at `where`) for an analytic surface, which only its own keys can move, and for turns of a surface with points
// that were not measured or with more facets than `most_turned_facets`.
void place(Specimen& specimen, const Placement& placement, const SourceLocation& where);

inline constexpr double most_turned_facets = 1e8;

// The feature where the placement puts it. None for plateaus that are turned, whose outlines are known on their own
// grid alone.
std::optional<dimensions::Feature> placed(std::optional<dimensions::Feature> feature, const Placement& placement);

} // namespace vkfv::specimen
