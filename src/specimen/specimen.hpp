// The object under test: its surface in the specimen frame (mm, +z towards the objective) and how it scatters.
#pragma once

#include "core/grid.hpp"
#include "physics/physics.hpp"
#include "surface/height_map.hpp"

#include <glm/glm.hpp>

#include <filesystem>
#include <optional>
#include <string>
#include <variant>
#include <vector>

namespace vkfv::specimen {

// Heights at the points of a grid, mm; each cell is two triangles, split from (i, j) to (i+1, j+1). Kept in float so
// that host and device trace the same facets.
struct HeightField {
    Grid<float> heights; // row 0 at the lowest y
    double x_min = 0;    // of column 0, mm
    double y_min = 0;
    double pitch_x = 0; // mm
    double pitch_y = 0;

    double x_max() const { return x_min + (heights.columns - 1) * pitch_x; }
    double y_max() const { return y_min + (heights.rows - 1) * pitch_y; }
};

// Any triangles, mm. Counter-clockwise seen from outside, though the trace orients normals by the ray.
struct Mesh {
    std::vector<glm::vec3> vertices;
    std::vector<glm::uvec3> triangles;
};

// The continuous function of shaders/physics/surface_function.glsl, with a lattice added to it where the specimen is
// irregular (same points as a HeightField's, interpolated without facets).
struct Analytic {
    std::uint32_t shape = physics::f64::SHAPE_PLANE;
    double parameters[4] = {0, 0, 0, 0};
    double x_min = 0, y_min = 0, x_max = 0, y_max = 0; // footprint, mm
    std::optional<HeightField> lattice;
};

struct Material {
    double g = 0; // Henyey-Greenstein asymmetry, in [-0.9, 1]; 1 is the mirror
};

struct Specimen {
    std::variant<HeightField, Mesh, Analytic> geometry;
    Material material;
};

} // namespace vkfv::specimen
