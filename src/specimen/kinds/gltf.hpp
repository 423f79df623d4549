// place: 20
#pragma once

#include "specimen/mesh_file.hpp"

namespace vkfv::specimen {

struct Gltf : MeshFile {
    static constexpr const char* name = "gltf";
    static constexpr const char* meaning = "A mesh from a glTF file.";
    static std::vector<const Key*> keys();
    static Gltf read(const Section& section);
    Mesh mesh(const SourceLocation& mention) const;
    bool operator==(const Gltf&) const = default;
};

} // namespace vkfv::specimen
