// Elements whose form is a mesh of flat facets, for the non-sequential mode.
#pragma once

#include "optics/media/medium.hpp"
#include "optics/prescriptions/pose.hpp"
#include "physics/physics.hpp"

#include <glm/glm.hpp>

#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

namespace vkfv::optics {

// Triangles between distinct vertices; no triangle has a vertex twice.
struct Facets {
    std::vector<glm::dvec3> vertices; // mm
    std::vector<glm::uvec3> triangles;
};

struct MeshElement {
    enum class Kind { glass, mirror, absorber } kind = Kind::absorber;
    std::string name;
    Facets facets; // in the element's own frame
    // Pose of the element's frame in the specimen frame, with the origin in the paraxial object plane (mm); the path is
    // folded.
    Pose pose;
    Medium glass = Medium::air();       // medium inside a glass element
    Medium surrounding = Medium::air(); // medium outside
    double reflectance = 1;             // reflectance of a mirror, 0 to 1
};

// An element placed in the room, in the frame of the other elements (Element of instrument.hpp).
struct PlacedMesh {
    MeshElement::Kind kind = MeshElement::Kind::absorber;
    std::string name;
    Facets facets;
    bool closed = false;
    physics::f64::Surface surface{}; // index_before outside, index_after inside
};

// Merges equal vertices and drops triangles that then have a vertex twice.
Facets welded(const std::vector<glm::dvec3>& vertices, const std::vector<glm::uvec3>& triangles);

// The defects by which a mesh is not closed: in a closed mesh every edge joins two facets of the same orientation.
struct Openness {
    std::size_t open_edges = 0;   // edges of one facet alone
    std::size_t turned_edges = 0; // edges between facets of opposite orientation, or of more than two facets
    glm::dvec3 first{0};          // an end of the first such edge (mm)

    bool closed() const { return open_edges == 0 && turned_edges == 0; }
};
Openness openness_of(const Facets& facets);

// Orients the facets of a closed mesh counter-clockwise seen from outside; those of a hole's wall counter-clockwise
// seen from within the hole. Each body and hole is oriented by itself, whatever its orientation in the file.
Facets turned_outward(Facets facets);

// Unit normals, on the side from which the corners run counter-clockwise. A sliver, whose own normal would be rounding,
// has its neighbour's.
std::vector<glm::dvec3> normals_of(const Facets& facets);

} // namespace vkfv::optics
