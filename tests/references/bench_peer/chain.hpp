// The chain of the peer: a tracer of its own kind to measure vkfv by, on all cores of the CPU, with the specimen in
// Embree and the lenses in double. vkfv reads and assembles the instrument that it traces, so that both see the same
// one; its way of tracing, from the random numbers to the pixel, shares nothing with vkfv's physics.
#pragma once

#include <cstdint>
#include <vector>

namespace peer {

inline constexpr double unlimited = 1e30;

// A surface of revolution about z in the frame of its own vertex, light towards +z; lengths in mm.
struct Surface {
    enum class Shape { plane, sphere, conic, asphere } shape = Shape::plane;
    double distance = 0; // from the previous vertex
    double curvature = 0;
    double conic = 0;
    std::vector<double> even;         // coefficients of r^4, r^6, ...
    double index_ratio = 1;           // before over after
    double semi_diameter_squared = 0; // `unlimited` where there is no edge
};

struct Chain {
    double source_radius = 0;       // Lambertian disc
    double source_distance = 0;     // to the first vertex of the illumination
    double emission_sine = 1;       // of the disc of directions emitted into
    double emission_half_width = 0; // of the rectangle of directions emitted into instead; 0: the disc
    double emission_half_height = 0;
    double emission_shift = 0;         // 1/mm, of their middle, over the place at the source
    std::vector<Surface> illumination; // ends at the objective's front vertex, light downwards
    std::vector<Surface> imaging;      // begins there, light upwards
    double top_distance = 0;           // from there to the specimen's top plane
    double top = 0;                    // that plane's height in the specimen's frame
    double g = 0;                      // Henyey-Greenstein
    int max_bounces = 1;
    // |gate_position (x, y) + gate_slope (dx/dz, dy/dz)| > gate_radius on the top plane: cannot reach the
    // detector
    double gate_position = 0;
    double gate_slope = 0;
    double gate_radius = 0;       // `unlimited`: no gate
    double detector_distance = 0; // from the last vertex
    double detector_half_width = 0;
    double detector_half_height = 0;
    int detector_columns = 0;
    int detector_rows = 0;
    bool inverted = false; // the image, which counting on pixels turns back
};

struct Triangles {
    std::vector<float> points;          // x, y, z of each, mm, the specimen's frame
    std::vector<std::uint32_t> corners; // three a triangle
};

struct Counts {
    std::vector<std::uint32_t> pixels; // rays; rows ascend with y
    std::uint64_t launched = 0;
    std::uint64_t arrived = 0; // at the specimen's top plane
    std::uint64_t met = 0;     // the specimen
    std::uint64_t gated = 0;   // left the specimen within the gate
    std::uint64_t detected = 0;
};

struct Settings {
    std::uint64_t rays = 0;
    std::uint64_t seed = 1;
    unsigned threads = 1;
    int packet = 16; // rays that Embree takes at once: 1, 8 or 16
    int block = 256; // rays that go through the lenses together, surface by surface; 1: ray by ray
};

// The specimen in an acceleration structure.
class Specimen {
  public:
    explicit Specimen(const Triangles& triangles);
    ~Specimen();
    Specimen(const Specimen&) = delete;
    Specimen& operator=(const Specimen&) = delete;
    void* scene() const { return scene_; }

  private:
    void* device_;
    void* scene_;
};

Counts trace(const Chain& chain, const Specimen& specimen, const Settings& settings);

} // namespace peer
