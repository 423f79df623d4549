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

// Triangles of vertices at different places, none with a vertex twice.
struct Facets {
    std::vector<glm::dvec3> vertices; // mm
    std::vector<glm::uvec3> triangles;
};

struct MeshElement {
    enum class Kind { glass, mirror, absorber } kind = Kind::absorber;
    std::string name;
    Facets facets; // in its own frame
    // Of that frame, in the specimen frame with its origin in the paraxial object plane (mm); the light's way folded.
    Pose pose;
    Medium glass = Medium::air();       // inside
    Medium surrounding = Medium::air(); // outside
    double reflectance = 1;             // of a mirror
};

// As it stands in the room, in the frame of the other elements (Element of instrument.hpp).
struct PlacedMesh {
    MeshElement::Kind kind = MeshElement::Kind::absorber;
    std::string name;
    Facets facets;
    bool closed = false;
    physics::f64::Surface surface{}; // index_before outside, index_after inside
};

// Equal vertices as one, without triangles that then have one twice.
Facets welded(const std::vector<glm::dvec3>& vertices, const std::vector<glm::uvec3>& triangles);

// What a mesh lacks to be closed: every edge lies between two facets that go round the same way.
struct Openness {
    std::size_t open_edges = 0;   // with a facet on one side alone
    std::size_t turned_edges = 0; // whose facets go round different ways, or of more than two facets
    glm::dvec3 first{0};          // an end of the first such edge

    bool closed() const { return open_edges == 0 && turned_edges == 0; }
};
Openness openness_of(const Facets& facets);

// Of a closed mesh: its facets go round counter-clockwise seen from outside, those of a hole's wall seen from within
// the hole. Each body and hole by itself, however the file has them.
Facets turned_outward(Facets facets);

// Unit vectors, to where the corners go round counter-clockwise. Slivers, of which rounding decides, have that of their
// neighbour.
std::vector<glm::dvec3> normals_of(const Facets& facets);

} // namespace vkfv::optics
