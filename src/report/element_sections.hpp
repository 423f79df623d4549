// Sections of the instrument's elements by the plane of drawing. Lengths in mm; points are (y, z) of the plane.
#pragma once

#include "optics/instrument/instrument.hpp"
#include "report/layout_geometry.hpp"
#include "report/room_rays.hpp"

#include <optional>
#include <vector>

namespace vkfv::report {

// The direction across an element's axis in the plane of drawing; none if the element is seen along its axis.
std::optional<glm::dvec3> across(const optics::Pose& pose);
// The point at a distance across the axis and along it.
glm::dvec2 at(const optics::Pose& pose, double radius, double height);
// The circle about the axis, as it is seen in the drawing.
std::vector<glm::dvec2> rim(const optics::Pose& pose, double radius);
// True if the element's axis is nearer to the picture's vertical than to its horizontal.
bool is_upright(const optics::Pose& pose);
bool is_limited(const optics::Element& element);

class ElementSections {
  public:
    // Semi-diameters are the elements' own; an element that has none is as large as the rays need. The instrument must
    // outlive it.
    ElementSections(const optics::Instrument& instrument, const std::vector<RoomRay>& rays);

    const std::vector<optics::Element>& elements() const { return elements_; }
    double radius(std::size_t i) const { return radii_[i]; }
    double back(std::size_t i) const { return backs_[i]; }    // of a mirror: 1 if light comes towards its z, else -1
    double extent() const { return extent_; }                 // size of the instrument, to which housings are relative
    double slab_thickness() const { return 0.012 * extent_; } // thickness of the specimen's slab

    double sag(std::size_t i, double radius) const;
    glm::dvec2 on_surface(std::size_t i, double radius) const;
    std::vector<glm::dvec2> profile(std::size_t i, double from, double to) const;
    Box part_box(optics::Part part) const;
    double part_radius(optics::Part part) const;
    // The splitter's coating if the splitter is a cube, whose faces stand around it; a plate has none in front.
    std::optional<std::size_t> cube_coating() const;

  private:
    const std::vector<optics::Element>& elements_;
    std::vector<double> radii_;
    std::vector<double> backs_;
    double extent_ = 0;
};

} // namespace vkfv::report
