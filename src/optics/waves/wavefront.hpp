// The wavefront of the imaging train, traced in double. Lengths in mm.
//
// All quantities belong to the object space. p = (px, py) are the direction cosines of light that leaves the specimen
// times the index n of the specimen's medium, in the axes of the specimen frame. For one point of the detector the
// light of every p comes from a point x(p) of the object plane; with V(p) the optical path from there, Hamilton's mixed
// characteristic V + p . x has the gradient x (Born and Wolf, "Principles of Optics", section 4.1). So
//   W(p) = V_c - V - p . (x - x_c),   grad W = t(p) = x_c - x(p),   c: the chief ray.
// t is the landing place of light from a common object point, in the object, inversion removed. An amplitude point
// spread is the integral of exp(i k (W(p) - p . x)) over the pupil.
#pragma once

#include "core/mathematics/plane_polynomial.hpp"
#include "optics/instrument/image_quality.hpp"

#include <cmath>
#include <span>
#include <vector>

namespace vkfv::optics {

struct DetectorView;

// The unit vector at an azimuth in rad from the x axis.
inline glm::dvec2 direction_of(double azimuth) {
    return {std::cos(azimuth), std::sin(azimuth)};
}

// The wavefront of one wavelength and one point of the detector. A pupil that no light passes has the rim 0 and no
// wavefront.
class Wavefront {
  public:
    // field: mm in the object; the point of the detector is its paraxial image, on the axis the detector's middle.
    // height: mm, of the object plane above best focus on the axis (z = 0 of a scan).
    Wavefront(const Instrument& instrument, const SpectralNode& wavelength, glm::dvec2 field = glm::dvec2(0),
              double height = 0);
    // Traces the wavefront with the plane of best focus `focus` (mm) above the paraxial object plane.
    Wavefront(const Imaging& imaging, double magnification, double focus, const SpectralNode& wavelength,
              glm::dvec2 field = glm::dvec2(0), double height = 0);

    // The wavefront for another object plane: a plane higher by z (mm) adds z sqrt(n^2 - p^2), Debye's defocus.
    Wavefront at_height(double height) const;

    double wavelength() const { return wavelength_; } // mm, in vacuum
    double weight() const { return weight_; }         // wavelength's share of the flux
    double index() const { return index_; }           // refractive index of the specimen's medium
    double height() const { return height_; }         // mm, height of the object plane
    // The height of the object plane (mm above z = 0) with the least variance of W over the pupil's rays.
    double sharpest_height() const { return -defocus_; }
    // p of the paraxial chief ray; if that is stopped, p of the centroid of the light.
    glm::dvec2 chief() const { return turned(chief_); }
    glm::dvec2 object_point() const; // x of the chief ray, mm

    // The largest |p - chief| that passes all apertures at an azimuth (rad from x); it is continuous in the azimuth.
    // Holes in pupils are ignored.
    double rim(double azimuth) const;
    double largest_rim() const { return largest_rim_; }
    double smallest_rim() const { return smallest_rim_; }
    bool passes(glm::dvec2 p) const;
    bool round() const { return round_; }                        // true on the axis of a symmetric train
    bool mirrored() const { return mirrored_ && along_.y == 0; } // true at a point of a symmetric train's x axis
    double area() const;                                         // area of the pupil in p
    // The difference between the largest and the least W (mm), sampled along 24 radii.
    double range() const;

    // W and t at a p that passes.
    double path(glm::dvec2 p) const;             // W, mm; 0 at the chief ray
    glm::dvec2 displacement(glm::dvec2 p) const; // t, mm
    // The derivatives of W and of t by the height of the object plane.
    double path_of_height(glm::dvec2 p) const;
    glm::dvec2 displacement_of_height(glm::dvec2 p) const;
    // The slope (dx/dz, dy/dz) of the light at the detector relative to that of the chief ray, in the frame of
    // physics::Detection.
    glm::dvec2 image_slope(glm::dvec2 p) const;
    glm::dvec2 chief_slope() const { return turned(chief_slope_); } // of the chief ray at the detector
    glm::dvec2 detector_point() const { return detector_point_; }   // mm, in the frame of physics::Detection

  private:
    // Internally the x axis of p points along the field, and results are rotated back: a symmetric train images all
    // points at one distance from the axis alike, and by mirror symmetry half of the pupil is enough.
    glm::dvec2 turned(glm::dvec2 own) const { return own.x * along_ + own.y * glm::dvec2(-along_.y, along_.x); }
    glm::dvec2 own(glm::dvec2 p) const { return {along_.x * p.x + along_.y * p.y, along_.x * p.y - along_.y * p.x}; }
    double own_rim(double azimuth) const;
    double own_path(glm::dvec2 p) const;
    struct Samples;
    Samples sample(const DetectorView& view, int rings, int spokes, double turn) const;

    double defocus(glm::dvec2 p) const; // sqrt(n^2 - p^2), without piston and tilt at the chief ray
    void fit(const Imaging& imaging, glm::dvec2 detector, double magnification, double focus);

    double wavelength_ = 0;
    double weight_ = 1;
    double index_ = 1;
    double height_ = 0;
    double defocus_ = 0; // mm, factor of defocus() in W at height 0; kept apart, as it is no polynomial
    glm::dvec2 along_ = glm::dvec2(1, 0); // direction of the internal x axis
    glm::dvec2 chief_ = glm::dvec2(0);
    glm::dvec2 object_point_ = glm::dvec2(0);
    glm::dvec2 chief_slope_ = glm::dvec2(0);
    glm::dvec2 detector_point_ = glm::dvec2(0);
    std::vector<double> rims_; // at azimuths i * 2 pi / count
    double largest_rim_ = 0;
    double smallest_rim_ = 0;
    double axial_chief_ = 1; // sqrt(n^2 - p^2) at the chief ray
    // Polynomials in (p - chief) / largest rim: W without its defocus, and the slopes.
    PlanePolynomial path_;
    PlanePolynomial slope_x_;
    PlanePolynomial slope_y_;
    // On the axis W is a polynomial in the squared radius, and the slope is the radius times another: a fast form of
    // what is computed most often.
    bool round_ = false;
    bool mirrored_ = false;
    std::vector<double> round_path_;
    std::vector<double> round_slope_;
};

// Traces the wavefront of each wavelength in parallel. field: mm in the object.
std::vector<Wavefront> wavefronts_of(const Instrument& instrument, std::span<const SpectralNode> wavelengths,
                                     glm::dvec2 field = glm::dvec2(0));

} // namespace vkfv::optics
