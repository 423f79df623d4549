#include "specimen/kinds/gltf.hpp"

#include "specimen/file_keys.hpp"

namespace vkfv::specimen {
namespace {

// The glTF standard prescribes metres.
const ChoiceKey<double> gltf_unit_key = unit_key(1e3, "Of the file; a glTF is to be in metres.");

} // namespace

std::vector<const Key*> Gltf::keys() {
    return mesh_file_keys(mesh_key, gltf_unit_key);
}

Gltf Gltf::read(const Section& section) {
    Gltf mesh;
    read_mesh_file(section, mesh_key, gltf_unit_key, mesh);
    return mesh;
}

Mesh Gltf::mesh(const SourceLocation& mention) const {
    return placed_mesh(read_gltf(file, mention), *this, mention);
}

} // namespace vkfv::specimen
