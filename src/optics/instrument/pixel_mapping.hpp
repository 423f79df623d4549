// The x-y mapping of the pixels: from a pixel to the place on the specimen whose light it receives in focus.
#pragma once

#include "core/mathematics/plane_polynomial.hpp"
#include "optics/instrument/instrument.hpp"

#include <glm/glm.hpp>

namespace vkfv::optics {

// The x-y mapping deviation (ISO 25178-600): the difference between the pixels' places and a regular grid of the
// nominal pitch. place = shift + A nominal is fitted by least squares over the field.
struct MappingDeviation {
    glm::dvec2 shift = glm::dvec2(0); // mm, place that the middle of the detector sees
    // Amplification coefficients of x and y: length by the nominal pitch over true length.
    glm::dvec2 amplification = glm::dvec2(1);
    double rotation = 0;         // rad, mean angle of rows and columns against the specimen's axes; from x towards y
    double perpendicularity = 0; // rad, excess over a right angle of the angle from the rows to the columns
    double residual = 0;         // mm, largest distance of a pixel's place from the fit: distortion
    double error = 0;            // mm, largest distance between interpolated and traced places
};

// The map from nominal positions to places on the specimen. A pixel's place is the centroid of the pencil that it
// receives, over pupil and spectrum and weighted by flux, in the plane where the pixel is in focus (focus_of_pencil()).
// Pencils are traced from a grid of points of the detector, and polynomials interpolate. Parts may be displaced; fold
// mirrors do not count, as positions are in the unfolded space (Placement). Meshes of the non-sequential mode are
// ignored. Lengths in mm, places in the specimen's frame.
//
// "nominal" is the place of a pixel for the paraxial magnification and no displacement: its distance from the
// detector's middle in pixels times the pitch in the object plane (PixelGrid::centred()), so that the inversion of the
// image is removed.
class PixelMapping {
  public:
    // Traces the mapping of `instrument`, which assemble() made from `description`.
    PixelMapping(const InstrumentDescription& description, const Instrument& instrument);

    // image_scale: magnification over that at z = 0, which ImageDeviations let change with the focal plane.
    glm::dvec2 place(glm::dvec2 nominal, double image_scale = 1) const;
    // The derivative of the place by `nominal`; columns belong to x and y.
    glm::dmat2 rate(glm::dvec2 nominal, double image_scale = 1) const;
    // Height of the place in focus above z = 0, the best focus on the axis of the undisplaced specimen plane.
    double focus(glm::dvec2 nominal, double image_scale = 1) const;
    const MappingDeviation& deviation() const { return deviation_; }

  private:
    // Where the light that is recorded at `nominal` arrives by the lenses alone, at the paraxial magnification.
    glm::dvec2 arrived(glm::dvec2 nominal, double image_scale) const;
    glm::dvec2 scaled(glm::dvec2 arrived) const { return arrived / scale_; } // into the unit disc
    glm::dvec2 place_by_lenses(glm::dvec2 arrived) const;

    physics::f64::Instrument image_{}; // of which ImageDeviations alone are used, in the object
    glm::dvec2 scale_ = glm::dvec2(1);
    // Polynomials in scaled() of place_by_lenses() - arrived, and of the focus there.
    PlanePolynomial aside_x_;
    PlanePolynomial aside_y_;
    PlanePolynomial focus_;
    MappingDeviation deviation_;
};

} // namespace vkfv::optics
