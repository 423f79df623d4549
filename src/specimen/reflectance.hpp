// The variation of a specimen's reflectance over x and y: patterns, noise, and the grey values of an image.
#pragma once

#include "core/mathematics/grid.hpp"
#include "core/messages/error.hpp"
#include "physics/physics.hpp"

#include <cstdint>
#include <filesystem>

namespace vkfv::specimen {

// A reflectance pattern as a configuration describes it. Lengths in mm, angles in rad, specimen frame. It also
// describes a transmission pattern of the light, in the plane that the light passes.
struct Reflectance {
    enum class Kind { even, grating, checkerboard, star, noise, image };
    Kind kind = Kind::grating;
    double lowest = 0; // limits of the factor on the material's reflectance, in [0, 1]; unused for noise
    double highest = 1;
    double x = 0; // origin of the pattern; unused for noise
    double y = 0;
    double angle = 0;    // direction, from +x towards +y
    bool square = false; // true: rectangular profile of a grating or star; false: sinusoidal
    double period = 0;   // period of a grating
    double side = 0;     // side of a checkerboard's squares
    int cycles = 0;      // cycles of a star in one turn
    double pitch = 0;    // pitch of the points of noise, or of the image's pixels
    double mean = 0;     // for noise; this and the next are met exactly before clipping to [0, 1]
    double standard_deviation = 0;
    double correlation_length = 0; // for noise; 0: white noise
    std::uint32_t seed = 0;
    std::filesystem::path file{}; // file of the image

    bool operator==(const Reflectance&) const = default;
};

// The reflectance map as the trace takes it: shaders/physics/reflectance.glsl.
struct ReflectanceMap {
    physics::f64::Pattern record{};
    Grid<float> values{}; // values of a grid, in [0, 1]; row 0 at the lowest y
};

// A rectangle of the specimen frame, mm.
struct Rectangle {
    double x_min = 0, y_min = 0, x_max = 0, y_max = 0;
};

// Makes the map of a pattern; the pattern `even` is 1 everywhere. footprint: the specimen's, which noise covers; beyond
// an image's edge its pixels are continued by reflection. Noise is a normal random field with the autocorrelation
// exp(-(r/l)^2), l the correlation length, clipped to [0, 1]; its bits depend only on its parameters and the footprint.
// Throws InputError (keys of [specimen.reflectance]) for invalid values, pixels outside [0, 1] and missing or damaged
// files. where: place of the [specimen] table.
ReflectanceMap make_reflectance_map(const Reflectance& reflectance, const Rectangle& footprint,
                                    const SourceLocation& where);

} // namespace vkfv::specimen
