// place: 19
#pragma once

#include "specimen/mesh_file.hpp"

namespace vkfv::specimen {

struct Stl : MeshFile {
    static constexpr const char* name = "stl";
    static constexpr const char* meaning = "A mesh from an STL file.";
    static std::vector<const Key*> keys();
    static Stl read(const Section& section);
    Mesh mesh(const SourceLocation& mention) const;
    bool operator==(const Stl&) const = default;
};

} // namespace vkfv::specimen
