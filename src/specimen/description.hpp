// What a configuration says of the specimen, and the specimen made from it. Lengths in mm, angles in rad.
#pragma once

#include "specimen/roughness.hpp"
#include "specimen/shape.hpp"
#include "specimen/specimen.hpp"

#include "core/mathematics/pixel_grid.hpp"
#include "core/messages/error.hpp"
#include "surface/height_map.hpp"

#include <glm/glm.hpp>

#include <functional>
#include <optional>

namespace vkfv::specimen {

struct Description {
    Shape shape{};                        // of one of the kinds in specimen/kinds/
    std::optional<Roughness> roughness{}; // added to any kind but a mesh
    Material material{};
    std::optional<Reflectance> reflectance{};
    SourceLocation where{}; // of the [specimen] table or its `file`, for messages

    bool operator==(const Description&) const = default;
};

// Throws InputError: missing or damaged files (with the byte offset), empty meshes, non-finite numbers, a footprint of
// no extent, lengths that no device can hold apart, and more points than fit into memory, told before any is made. Keys
// are those of the configuration ("specimen.pitch_um").
Specimen make(const Description& description);

// What a pixel sees of the object plane, mm: a parallelogram.
struct PixelArea {
    glm::dvec2 middle = glm::dvec2(0);
    glm::dvec2 along_row = glm::dvec2(0);    // its sides: from one column to the next,
    glm::dvec2 along_column = glm::dvec2(0); // and from one row to the next
};

// Truth on the detector's pixels: the mean of the surface's height over each pixel's area (5 x 5 points), seen from
// +z (the uppermost surface). Points off the specimen are NaN. The map stands on the grid, wherever the pixels look;
// area_of is called by several threads.
surface::HeightMap truth(const Specimen& specimen, const PixelGrid& grid,
                         const std::function<PixelArea(int column, int row)>& area_of);
// Where the pixels look at the grid's own points.
surface::HeightMap truth(const Specimen& specimen, int columns, int rows, double x0, double y0, double pitch_x,
                         double pitch_y);

// The record the trace takes (bounds, kind, shape, lattice); top and bottom enclose the surface.
physics::f64::SpecimenRecord record(const Specimen& specimen, int max_bounces);
// The same without the material.
physics::f64::SpecimenRecord record_of_geometry(const Specimen& specimen);

// What it covers of the object plane, mm.
struct Footprint {
    double x_min, y_min, x_max, y_max;
};
Footprint footprint(const Specimen& specimen);

} // namespace vkfv::specimen
