// The imaging quality of the instrument, traced through its real apertures: --check reports it besides first-order
// data. Lengths in mm and angles in rad, wavelengths in um.
#pragma once

#include "core/messages/warning.hpp"
#include "optics/aim/apertures.hpp"
#include "optics/instrument/instrument.hpp"

#include <span>
#include <string>
#include <vector>

namespace vkfv::optics {

// Quadrature nodes of the instrument's spectrum: each line is one node, a continuous spectrum has at least `fewest`
// nodes in its bins.
std::vector<SpectralNode> spectral_nodes(const Instrument& instrument, int fewest = 32);

// The image of one point of the field by light that fills the cone of all apertures with uniform density in direction
// cosines. A Lambertian specimen emits so; where the sine condition holds, the exit pupil is then lit uniformly.
struct PointImage {
    glm::dvec2 position = glm::dvec2(0); // position of the object on the plane of best focus
    glm::dvec2 centroid = glm::dvec2(0); // centroid of its light on the detector
    double rms_spot = 0;                 // RMS distance from the centroid on the detector, over cone and spectrum
    double relative_light = 0;           // area of its cone relative to that on the axis
};

// The image of the outline's point at `height` (mm) above the paraxial object plane; NaN if no light arrives.
// relative_light stays 0.
PointImage point_image(const Imaging& imaging, const Outline& outline, double height,
                       std::span<const SpectralNode> spectrum);

// The imaging train of an instrument.
Imaging imaging_of(const Instrument& instrument);

// The cardinal points of a part by itself, measured from its own vertices in the direction of imaging (mm).
struct CardinalPoints {
    double focal_length = 0;
    double front_principal_plane = 0; // behind the first vertex
    double back_principal_plane = 0;  // behind the last vertex
};

// An edge that limits the cone from a point of the field, and its share of the cone's rim.
struct Clipping {
    std::string surface; // name as in the ledger
    double share = 0;
    bool aperture_stop = false;
};

struct ImageQuality {
    CardinalPoints objective;
    CardinalPoints tube_lens;
    // The paraxial entrance pupil: height above the paraxial object plane (infinite: telecentric) and radius.
    double entrance_pupil_height = 0;
    double entrance_pupil_radius = 0;
    // The objective's own exit pupil, which the source must fill: distance from its last vertex towards the tube lens,
    // and radius.
    double back_pupil_distance = 0;
    double back_pupil_radius = 0;
    // The radius of the axial cone's beam behind the objective, traced. It is n sin times f where the sine condition
    // holds; the paraxial pupil's radius differs from it at high aperture.
    double beam_radius = 0;
    // The exit pupil of the whole microscope: distance in front of the detector, and radius.
    double exit_pupil_distance = 0;
    double exit_pupil_radius = 0;

    double wavelength_um = 0;  // reference wavelength
    double magnification = 0;  // signed, from centroids of light from near the axis
    double image_aperture = 0; // numerical aperture at the detector, from the rim of the axial cone
    double f_number = 0;       // 1 / (2 image_aperture)
    double airy_radius = 0;    // in the object: first zero, 0.6098 lambda / NA
    double detector_airy_radius = 0;
    // n e / NA with the pixel pitch e in the object: the depth over which defocus blurs by one pixel.
    double detector_depth_of_field = 0;
    glm::dvec2 field{0}; // sides of the detector's field in the object
    double field_diagonal = 0;

    // Images at z = 0: on the axis, at the middle of a longer side, and in a corner. Of several sides or corners (a
    // displaced train) the one with the largest spot.
    PointImage axis;
    PointImage edge;
    PointImage corner;
    // Relative deviation of the centroid's distance from the axial centroid from the paraxial magnification; positive:
    // pincushion.
    double edge_distortion = 0;
    double corner_distortion = 0;
    // Differences between the wavelengths below which 5 and 95 % of the flux lie; 0 for a single wavelength.
    double axial_colour = 0;   // best focus at the longer wavelength above that at the shorter
    double lateral_colour = 0; // at the edge, in the object: image position at the longer wavelength farther out

    std::vector<Clipping> axis_clipping;
    std::vector<Clipping> corner_clipping;
    std::vector<Warning> warnings;
};

// Measures `instrument`, which assemble() made from `description`.
ImageQuality image_quality(const InstrumentDescription& description, const Instrument& instrument);

} // namespace vkfv::optics
