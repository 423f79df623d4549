// The specimen as a configuration describes it, and the specimen made from it. Lengths in mm, angles in rad.
#pragma once

#include "specimen/placement.hpp"
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
    Shape shape{};                        // one of the kinds in specimen/kinds/
    std::optional<Roughness> roughness{}; // added to all kinds but meshes
    Material material{};
    std::optional<Reflectance> reflectance{};
    Placement placement{};
    SourceLocation where{}; // place of the [specimen] table or of its `file`, for messages

    bool operator==(const Description&) const = default;
};

// The feature to be measured, where it lies; none unless the specimen is a measurement standard.
std::optional<dimensions::Feature> feature_of(const Description& description);

// Makes the specimen. Throws InputError, before any point is made, for missing or damaged files (with the byte offset),
// empty meshes, non-finite numbers, a footprint without extent, lengths that a device's floats cannot distinguish, and
// more points than fit into memory. Keys are those of the configuration ("specimen.pitch_um").
Specimen make(const Description& description);

// The area of the object plane that a pixel sees (mm): a parallelogram.
struct PixelArea {
    glm::dvec2 middle = glm::dvec2(0);
    glm::dvec2 along_row = glm::dvec2(0);    // side from one column to the next
    glm::dvec2 along_column = glm::dvec2(0); // side from one row to the next
};

// The true height on the detector's pixels: the mean of the surface's height over each pixel's area (5 x 5 points),
// seen from +z (the uppermost surface). Points off the specimen are NaN. The map has the grid's coordinates, wherever
// the pixels look; area_of is called by several threads.
surface::HeightMap truth(const Specimen& specimen, const PixelGrid& grid,
                         const std::function<PixelArea(int column, int row)>& area_of);
// The true height for pixels that look at the grid's own points.
surface::HeightMap truth(const Specimen& specimen, int columns, int rows, double x0, double y0, double pitch_x,
                         double pitch_y);

// The record that the trace takes (bounds, kind, shape, lattice); top and bottom enclose the surface.
physics::f64::SpecimenRecord record(const Specimen& specimen, int max_bounces);
// The record without the material.
physics::f64::SpecimenRecord record_of_geometry(const Specimen& specimen);

// The rectangle of the object plane that the specimen covers, mm.
struct Footprint {
    double x_min, y_min, x_max, y_max;
};
Footprint footprint(const Specimen& specimen);

} // namespace vkfv::specimen
