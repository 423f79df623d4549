// Where the pixels look: from a pixel to the place on the specimen whose light it receives in focus.
#pragma once

#include "core/mathematics/plane_polynomial.hpp"
#include "optics/instrument/instrument.hpp"

#include <glm/glm.hpp>

namespace vkfv::optics {

// How far a regular grid of pixels at the nominal pitch is from where the pixels look: figures of the x-y mapping
// deviation of ISO 25178-600. place = shift + A nominal is fitted by least squares over the field.
struct MappingDeviation {
    glm::dvec2 shift = glm::dvec2(0); // mm: where the middle of the detector looks
    // Amplification coefficients of x and y: lengths by the nominal pitch over true lengths.
    glm::dvec2 amplification = glm::dvec2(1);
    double rotation = 0;         // rad, of rows and columns in the mean, against the specimen's axes; from x towards y
    double perpendicularity = 0; // rad, by which the angle from the rows to the columns exceeds a right angle
    double residual = 0;         // mm, largest distance of a pixel's place from the fit: distortion
    double error = 0;            // mm, largest distance between interpolated and traced places
};

// A pixel's place is the centroid of the pencil that it receives, over pupil and spectrum and weighted by flux, in the
// plane where the pixel is in focus (focus_of_pencil()). Pencils are traced from a grid of points of the detector, and
// polynomials interpolate. Parts may be displaced; fold mirrors do not count, as the instrument shows the straight
// space (Placement). Meshes of the non-sequential mode are not passed. Lengths in mm, places in the specimen's frame.
//
// "nominal" is where a pixel would look if the magnification were the paraxial one and nothing were displaced: its
// distance from the detector's middle in pixels times the pitch in the object plane (PixelGrid::centred()), so that the
// inversion of the image is removed.
class PixelMapping {
  public:
    // `instrument` as assemble() made it of `description`.
    PixelMapping(const InstrumentDescription& description, const Instrument& instrument);

    glm::dvec2 place(glm::dvec2 nominal) const;
    glm::dmat2 rate(glm::dvec2 nominal) const; // of the place with `nominal`; its columns belong to x and y
    // Height of what is in focus above z = 0, best focus on the axis of the undisplaced specimen plane.
    double focus(glm::dvec2 nominal) const;
    const MappingDeviation& deviation() const { return deviation_; }

  private:
    glm::dvec2 scaled(glm::dvec2 nominal) const { return nominal / scale_; } // into the unit disc

    glm::dvec2 scale_ = glm::dvec2(1);
    // In scaled(): place - nominal, and focus().
    PlanePolynomial aside_x_;
    PlanePolynomial aside_y_;
    PlanePolynomial focus_;
    MappingDeviation deviation_;
};

} // namespace vkfv::optics
