// The features measured on standards: their nominal geometry and position.
#pragma once

#include "surface/height_map.hpp"

#include <cmath>
#include <variant>
#include <vector>

namespace vkfv::dimensions {

// A feature's coordinates: u across it, v along it, from its middle. mm; the angle from x to u in rad.
struct Frame {
    double x = 0;
    double y = 0;
    double angle = 0;

    double u(double px, double py) const { return (px - x) * std::cos(angle) + (py - y) * std::sin(angle); }
    double v(double px, double py) const { return (py - y) * std::cos(angle) - (px - x) * std::sin(angle); }
    bool operator==(const Frame&) const = default;
};

// In the features below lengths are in mm, angles in rad. The names of types are those of ISO 25178-70.

// A single edge between two levels.
struct Step {
    Frame frame;       // origin on the edge
    double height = 0; // height of the level at u > 0 above that at u < 0
};

// Type PGR (A1 of ISO 5436-1): a groove along v.
struct Groove {
    Frame frame;
    double width = 0; // width at half depth
    double depth = 0; // negative: a ridge
};

// Type PRI: two flanks along v, a roof or, of negative height, a V-groove.
struct Prism {
    Frame frame;
    double height = 0;
    double flank_angle = 0; // angle of either flank to the plane
    double top_width = 0;   // width of the level between the flanks
};

// Lines along v, centred on u = k * period.
struct Grating {
    Frame frame;
    double period = 0;
    double depth = 0;      // depth of the ground below the lines
    double line_width = 0; // width of the upper level; 0: no levels (a triangular profile)
};

// Type ACG: squares or grooves in two directions.
struct CrossGrating {
    Frame frame;        // u across the first set of lines
    double pitch_u = 0; // pitch along the first wave vector
    double pitch_v = 0;
    double angle = 0; // angle between the two wave vectors
};

// Type PPS: a sinusoid along u.
struct Sinusoid {
    Frame frame;
    double amplitude = 0;
    double period = 0;
};

// Type ACS: the sum of two sinusoids at right angles.
struct CrossSinusoid {
    Frame frame;
    double amplitude = 0; // amplitude of each sinusoid
    double period_u = 0;
    double period_v = 0;
};

// Type ARS: concentric waves about the frame's origin.
struct RadialSinusoid {
    Frame frame;
    double amplitude = 0;
    double period = 0;
};

// A sinusoid along u whose frequency changes linearly from u = start, where its phase is 0 and it rises.
struct Chirp {
    Frame frame;
    double amplitude = 0;
    double start = 0;  // u of the beginning
    double length = 0; // length along u
    double period_start = 0;
    double period_stop = 0;
};

// Type ASG: raised sectors about the frame's origin.
struct Star {
    Frame frame;
    int petals = 0;
    double radius = 0;
    double height = 0;
};

// Type ASP: the cap of a sphere on a plane, or a dimple in it.
struct SphereCap {
    Frame frame;
    double radius = 0; // 0: unknown, with the whole map on the sphere
    double height = 0; // height of the cap above the plane; negative: a dimple
};

// Type AFL: a flat.
struct Flat {};

// Plateaus of any outline on a level ground.
struct Plateaus {
    surface::HeightMap nominal; // nominal heights, the ground at 0
};

using Feature = std::variant<Step, Groove, Prism, Grating, CrossGrating, Sinusoid, CrossSinusoid, RadialSinusoid, Chirp,
                             Star, SphereCap, Flat, Plateaus>;

} // namespace vkfv::dimensions
