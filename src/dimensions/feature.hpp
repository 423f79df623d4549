// What is measured on standards: their nominal geometry, and where it lies on them.
#pragma once

#include "surface/height_map.hpp"

#include <cmath>
#include <variant>
#include <vector>

namespace vkfv::dimensions {

// A feature's own axes: u across it, v along it, from its middle. mm; the angle from x to u in rad.
struct Frame {
    double x = 0;
    double y = 0;
    double angle = 0;

    double u(double px, double py) const { return (px - x) * std::cos(angle) + (py - y) * std::sin(angle); }
    double v(double px, double py) const { return (py - y) * std::cos(angle) - (px - x) * std::sin(angle); }
    bool operator==(const Frame&) const = default;
};

// Lengths in mm, angles in rad. The names of types are those of ISO 25178-70.

// One edge between two levels.
struct Step {
    Frame frame;       // its origin on the edge
    double height = 0; // of the level at u > 0 over that at u < 0
};

// Type PGR (A1 of ISO 5436-1), along v.
struct Groove {
    Frame frame;
    double width = 0; // at half depth
    double depth = 0; // negative: a ridge
};

// Type PRI: two flanks along v, a roof or, of negative height, a V-groove.
struct Prism {
    Frame frame;
    double height = 0;
    double flank_angle = 0; // of either flank against the plane
    double top_width = 0;   // of the level between the flanks
};

// Lines along v. Their middles lie at u = k * period.
struct Grating {
    Frame frame;
    double period = 0;
    double depth = 0;      // of the ground below the lines
    double line_width = 0; // of the upper level; 0: there are no levels (a triangular shape)
};

// Type ACG: squares or grooves in two directions.
struct CrossGrating {
    Frame frame;        // u across the first set of lines
    double pitch_u = 0; // of the lines that the first wave vector is across
    double pitch_v = 0;
    double angle = 0; // between the two wave vectors
};

// Type PPS, along u.
struct Sinusoid {
    Frame frame;
    double amplitude = 0;
    double period = 0;
};

// Type ACS: the sum of two sinusoids across each other.
struct CrossSinusoid {
    Frame frame;
    double amplitude = 0; // of either
    double period_u = 0;
    double period_v = 0;
};

// Type ARS: concentric waves about the frame's origin.
struct RadialSinusoid {
    Frame frame;
    double amplitude = 0;
    double period = 0;
};

// Sinusoid along u whose frequency changes linearly from u = start on, where its phase is 0 and rises.
struct Chirp {
    Frame frame;
    double amplitude = 0;
    double start = 0;  // u
    double length = 0; // along u
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
    double radius = 0; // 0: not known, and all of the map is on it
    double height = 0; // of the cap over the plane; negative: a dimple
};

// Type AFL.
struct Flat {};

// Plateaus of any outline over a level ground.
struct Plateaus {
    surface::HeightMap nominal; // the ground at 0
};

using Feature = std::variant<Step, Groove, Prism, Grating, CrossGrating, Sinusoid, CrossSinusoid, RadialSinusoid, Chirp,
                             Star, SphereCap, Flat, Plateaus>;

} // namespace vkfv::dimensions
