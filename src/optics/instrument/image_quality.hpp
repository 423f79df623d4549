// How well the instrument images, traced through its real apertures: what --check reports besides first-order data.
// Inside mm and rad, wavelengths in um.
#pragma once

#include "core/messages/warning.hpp"
#include "optics/aim/apertures.hpp"
#include "optics/instrument/instrument.hpp"

#include <span>
#include <string>
#include <vector>

namespace vkfv::optics {

// Lines one by one, a continuous spectrum by at least `fewest` nodes in its bins.
std::vector<SpectralNode> spectral_nodes(const Instrument& instrument, int fewest = 32);

// The image of one point of the field, by light that fills the cone of all apertures with uniform density in direction
// cosines: a Lambertian specimen's, and where the sine condition holds a uniformly lit exit pupil.
struct PointImage {
    glm::dvec2 position = glm::dvec2(0); // of the object, on the plane of best focus
    glm::dvec2 centroid = glm::dvec2(0); // of its light on the detector
    double rms_spot = 0;                 // RMS distance from the centroid, on the detector, over cone and spectrum
    double relative_light = 0;           // area of its cone over that on the axis
};

// Of the outline's point at `height` above the paraxial object plane; NaN where no light arrives. relative_light stays
// 0.
PointImage point_image(const Imaging& imaging, const Outline& outline, double height,
                       std::span<const SpectralNode> spectrum);

// The imaging train of an instrument.
Imaging imaging_of(const Instrument& instrument);

// Of a part on its own, from its own vertices, in the direction of the imaging (mm).
struct CardinalPoints {
    double focal_length = 0;
    double front_principal_plane = 0; // behind the first vertex
    double back_principal_plane = 0;  // behind the last vertex
};

// Which edges limit the cone from a point of the field, and what share of its rim each.
struct Clipping {
    std::string surface; // as the ledger names it
    double share = 0;
    bool aperture_stop = false;
};

struct ImageQuality {
    CardinalPoints objective;
    CardinalPoints tube_lens;
    // Seen from the specimen: above the paraxial object plane (infinite: telecentric).
    double entrance_pupil_height = 0;
    double entrance_pupil_radius = 0;
    // Of the objective alone, seen from behind: from its last vertex towards the tube lens. What the source must fill.
    double back_pupil_distance = 0;
    double back_pupil_radius = 0;
    // Of the axial cone's beam behind the objective, traced: n sin times f where the sine condition holds, from which
    // the paraxial pupil's radius differs at high aperture.
    double beam_radius = 0;
    // Of the whole microscope: in front of the detector.
    double exit_pupil_distance = 0;
    double exit_pupil_radius = 0;

    double wavelength_um = 0;  // the reference
    double magnification = 0;  // signed, of the centroids of light from near the axis
    double image_aperture = 0; // numerical aperture at the detector, of the rim of the axial cone
    double f_number = 0;       // 1 / (2 image_aperture)
    double airy_radius = 0;    // in the object: first zero, 0.6098 lambda / NA
    double detector_airy_radius = 0;
    double detector_depth_of_field = 0; // n e / NA with the pixel pitch e in the object: what one pixel blurs
    glm::dvec2 field{0};                // sides of the rectangle that the detector sees
    double field_diagonal = 0;

    // At z = 0. Edge: the middle of a longer side; corner. Of several sides (a displaced train) the one with the
    // largest spot.
    PointImage axis;
    PointImage edge;
    PointImage corner;
    // Of the centroid's way from that of the axis against the paraxial magnification, signed share; positive:
    // pincushion.
    double edge_distortion = 0;
    double corner_distortion = 0;
    // Between the wavelengths that 5 and 95 % of the flux lie below; 0 for a single one.
    double axial_colour = 0;   // best focus at the longer above that at the shorter
    double lateral_colour = 0; // at the edge, in the object: how much farther out the longer is imaged

    std::vector<Clipping> axis_clipping;
    std::vector<Clipping> corner_clipping;
    std::vector<Warning> warnings;
};

// `instrument` as assemble() made it of `description`.
ImageQuality image_quality(const InstrumentDescription& description, const Instrument& instrument);

} // namespace vkfv::optics
