// place: 21
#pragma once

#include "specimen/mesh_file.hpp"

namespace vkfv::specimen {

// The Delaunay triangulation of the points in x and y, without triangles that have an edge longer than `longest_edge`.
struct Points : MeshFile {
    static constexpr const char* name = "points";
    static constexpr const char* meaning = "Scattered points x, y, z from a text file, with triangles between them.";
    double height_unit = 0;  // mm per unit of z; 0: as for x and y
    double longest_edge = 0; // mm, in x and y; 0: unlimited
    static std::vector<const Key*> keys();
    static Points read(const Section& section);
    Mesh mesh(const SourceLocation& mention) const;
    bool operator==(const Points&) const = default;
};

} // namespace vkfv::specimen
