// What varies a specimen's reflectance over x and y: patterns, noise, and the grey values of an image.
#pragma once

#include "core/mathematics/grid.hpp"
#include "core/messages/error.hpp"
#include "physics/physics.hpp"

#include <cstdint>
#include <filesystem>

namespace vkfv::specimen {

// What a configuration says of it. Lengths in mm, angles in rad, specimen frame. Of light: in the plane that it passes.
struct Reflectance {
    enum class Kind { even, grating, checkerboard, star, noise, image };
    Kind kind = Kind::grating;
    double lowest = 0; // factors of the material's reflectance, in [0, 1]; not of noise
    double highest = 1;
    double x = 0; // of the pattern's origin; not of noise
    double y = 0;
    double angle = 0;    // from +x towards +y
    bool square = false; // the profile of a grating or star; else sinusoidal
    double period = 0;   // of a grating
    double side = 0;     // of a checkerboard's squares
    int cycles = 0;      // of a star, in one turn
    double pitch = 0;    // of the points of noise, or of the image's pixels
    double mean = 0;     // of noise: this and the next are met exactly before it is clipped to [0, 1]
    double standard_deviation = 0;
    double correlation_length = 0; // of noise; 0: it is white
    std::uint32_t seed = 0;
    std::filesystem::path file{}; // the image

    bool operator==(const Reflectance&) const = default;
};

// The map as the trace takes it: shaders/physics/reflectance.glsl.
struct ReflectanceMap {
    physics::f64::Pattern record{};
    Grid<float> values{}; // of a grid, in [0, 1]; row 0 at the lowest y
};

// A rectangle of the specimen frame, mm.
struct Rectangle {
    double x_min = 0, y_min = 0, x_max = 0, y_max = 0;
};

// even: 1 everywhere. footprint: the specimen's, which noise covers; beyond an image's edge its pixels go on mirrored.
// Noise is a normal random field with the autocorrelation exp(-(r/l)^2), l the correlation length, clipped; its bits
// depend on its numbers and the footprint alone. Throws InputError (keys of [specimen.reflectance]) for values that do
// not fit, pixels outside [0, 1] and missing or damaged files. where: of the [specimen] table.
ReflectanceMap make_reflectance_map(const Reflectance& reflectance, const Rectangle& footprint,
                                    const SourceLocation& where);

} // namespace vkfv::specimen
