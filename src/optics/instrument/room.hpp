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
    // All elements, surfaces first, then meshes. Frame and unit: Element of instrument.hpp.
    std::vector<physics::f64::Element> elements;
    std::size_t surfaces = 0;       // number of elements that are surfaces
    std::vector<std::string> names; // "objective: 10x_0.28 3", ...
    // The facets of the meshes, element by element; corners are rounded to single precision, so that host and device
    // trace the same facets.
    std::vector<physics::f64::Facet> facets;
    BoxTree facet_tree; // only for the host: empty until grow_facet_tree()
    physics::f64::SourceFrame source;

    using Box = BoxTree::Box;
    Box bounds(std::size_t element) const; // box around a surface element, its mount and rim
    void add_mesh(const PlacedMesh& mesh);
    void grow_facet_tree(); // builds the tree over the facets of all meshes
};

BoxTree::Box bounds_of(const physics::f64::Facet& facet);

Room furnish(const Instrument& instrument);

// The nearest element that a ray meets, for physics::trace_nonsequential on the host. It tests every surface, and the
// facets by their tree, which must be grown.
physics::f64::ElementHit nearest_element(const Room& room, glm::dvec3 origin, glm::dvec3 direction,
                                         physics::f64::PathPlace from);

} // namespace vkfv::optics
