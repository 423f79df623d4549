// What a configuration says of the specimen, and the specimen made from it. Lengths in mm, angles in rad.
#pragma once

#include "specimen/specimen.hpp"

#include "core/error.hpp"

#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

namespace vkfv::specimen {

enum class Kind { plane, step, sphere, sinusoid, chirp, rough, plateaus, air, star, groove, image, surface, stl, gltf };
enum class Representation { facets, analytic }; // of generated surfaces; files are always facets

// What is shorter or longer, mm, is no specimen of a microscope, and its squares leave the numbers of a device: 0.1 pm,
// a kilometre.
inline constexpr double smallest_length = 1e-10, largest_length = 1e6;

// Along a side of a generated surface: with one point more they fill the largest image of a common device.
inline constexpr int most_facets = 16383;

// Gaussian white noise of standard deviation `noise` on a grid of `pitch`, filtered by a Gaussian of standard
// deviation `kernel`. What remains is about noise * pitch / (2 sqrt(pi) kernel); the log prints what it is.
struct Roughness {
    double noise = 0;
    double kernel = 0;
    double pitch = 0;
    std::uint32_t seed = 0;

    bool operator==(const Roughness&) const = default;
};

struct Description {
    Kind kind = Kind::plane;
    Representation representation = Representation::facets;
    double size = 0;  // side of the square footprint, centred on the axis; surface: 0 for all of it
    double pitch = 0; // of the facets' grid (generated kinds) or of the image's pixels; surface: 0 for the file's own
    double tilt_x = 0, tilt_y = 0;      // plane: slope angles along x and y
    double height = 0;                  // step: upper minus lower level (upper at x > 0); sphere: of the cap over the
                                        // plane (negative: a dimple); image: of the value 1 over the value 0
    double wall = 0;                    // step, groove: width of the flank; 0: one pitch
    double width = 0;                   // groove, between the middles of its flanks
    double depth = 0;                   // groove
    double radius = 0;                  // sphere; star: of its outer end
    double amplitude = 0;               // sinusoid, chirp (half the peak-to-valley height)
    double period = 0;                  // sinusoid along x; chirp: at the lowest x
    double period_stop = 0;             // chirp: at the highest x
    double sq = 0;                      // rough, plateaus, air: root mean square height of the roughness
    double correlation_length = 0;      // rough, plateaus: Gaussian autocorrelation exp(-(r/l)^2)
    std::uint32_t seed = 0;             // rough, plateaus, air
    std::string text;                   // plateaus: what they read; else they are those of `file`
    std::string font;                   // plateaus: a name that OpenImageIO finds, or a file
    double text_width = 0;              // plateaus
    std::vector<double> heights;        // plateaus: one for each, or one for all
    int tiles = 1;                      // air: sub-surfaces along each side
    double roll_off = 0;                // air: wavelength; longer ones have the power of it
    double shortest = 0;                // air: wavelength
    double hurst = 0;                   // air: Hurst exponent
    int petals = 0;                     // star
    std::filesystem::path file;         // plateaus, air, image, surface, stl, gltf
    double unit = 1;                    // stl, gltf: mm per unit of the file; surface: of an image's values, else 0
    bool level = true;                  // surface: remove the least-squares plane, mean height to z = 0
    bool centre = true;                 // stl, gltf: move the bounding box's centre to x = y = 0, mean height to z = 0
    std::optional<Roughness> roughness; // added to any kind but stl and gltf
    Material material;
    SourceLocation where; // of the [specimen] table, for messages

    bool operator==(const Description&) const = default;
};

// Throws InputError: missing or damaged files (with the byte offset), empty meshes, non-finite numbers, a footprint of
// no extent, lengths that no device can hold apart, and more points than fit into memory, told before any is made. Keys
// are those of the configuration ("specimen.pitch_um").
Specimen make(const Description& description);

// Truth on the detector's pixels: the mean of the surface's height over each pixel's area (5 x 5 points), seen from
// +z (the uppermost surface). Points off the specimen are NaN.
surface::HeightMap truth(const Specimen& specimen, int columns, int rows, double x0, double y0, double pitch_x,
                         double pitch_y);

// The record the trace takes (bounds, kind, shape, lattice); top and bottom enclose the surface.
physics::f64::SpecimenRecord record(const Specimen& specimen, int max_bounces);

} // namespace vkfv::specimen
