#include "specimen/kinds/stl.hpp"

#include "specimen/file_keys.hpp"

namespace vkfv::specimen {
namespace {

// STL files state no unit; millimetres are customary.
const ChoiceKey<double> stl_unit_key = unit_key(1.0, "Of the file, which does not say it.");

} // namespace

std::vector<const Key*> Stl::keys() {
    return mesh_file_keys(mesh_key, stl_unit_key);
}

Stl Stl::read(const Section& section) {
    Stl mesh;
    read_mesh_file(section, mesh_key, stl_unit_key, mesh);
    return mesh;
}

Mesh Stl::mesh(const SourceLocation& mention) const {
    return placed_mesh(read_stl(file, mention), *this, mention);
}

} // namespace vkfv::specimen
