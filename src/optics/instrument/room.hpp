// The instrument's elements as the non-sequential trace takes them: with mounts and barrels, so that no light passes
// beside the lenses.
#pragma once

#include "core/mathematics/box_tree.hpp"
#include "optics/instrument/instrument.hpp"

#include <glm/glm.hpp>

#include <string>
#include <vector>

namespace vkfv::optics {

struct Room {
    // Frame and unit: Element of instrument.hpp. First those that are surfaces, then those that are meshes.
    std::vector<physics::f64::Element> elements;
    std::size_t surfaces = 0;       // how many of the first
    std::vector<std::string> names; // "objective: 10x_0.28 3", ...
    // Of the meshes, element by element; corners are numbers of single precision, so that host and device meet the
    // same.
    std::vector<physics::f64::Facet> facets;
    BoxTree facet_tree; // for the host alone: empty until it is grown
    physics::f64::SourceFrame source;

    using Box = BoxTree::Box;
    Box bounds(std::size_t element) const; // of a surface: encloses it, its mount and rim
    void add_mesh(const PlacedMesh& mesh);
    void grow_facet_tree(); // of all meshes
};

BoxTree::Box bounds_of(const physics::f64::Facet& facet);

Room furnish(const Instrument& instrument);

// The nearest element that a ray meets, for physics::trace_nonsequential on the host. Tries every surface; needs the
// facets' tree.
physics::f64::ElementHit nearest_element(const Room& room, glm::dvec3 origin, glm::dvec3 direction,
                                         physics::f64::PathPlace from);

} // namespace vkfv::optics
