#include "specimen/mesh_file.hpp"

#include "specimen/file_keys.hpp"

namespace vkfv::specimen {
namespace {

const BooleanKey centre_key("centre", true,
                            "Whether the bounding box's centre comes to x = y = 0 and the mean height to z = 0.");

} // namespace

const FileKey mesh_key = needed_file_key("The mesh; +z is towards the objective.");

std::vector<const Key*> mesh_file_keys(const FileKey& file, const ChoiceKey<double>& unit) {
    return {&file, &unit, &centre_key};
}

void read_mesh_file(const Section& section, const FileKey& file, const ChoiceKey<double>& unit, MeshFile& mesh) {
    mesh.file = section.file(file);
    mesh.unit = section.choice(unit);
    mesh.centre = section.boolean(centre_key);
}

} // namespace vkfv::specimen
