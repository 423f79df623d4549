#include "specimen/mesh_file.hpp"

#include "specimen/file_keys.hpp"

namespace vkfv::specimen {
namespace {

const FileKey file_key = needed_file_key("The mesh; +z is towards the objective.");

const BooleanKey centre_key("centre", true,
                            "Whether the bounding box's centre comes to x = y = 0 and the mean height to z = 0.");

} // namespace

std::vector<const Key*> mesh_file_keys(const ChoiceKey<double>& unit) {
    return {&file_key, &unit, &centre_key};
}

void read_mesh_file(const Section& section, const ChoiceKey<double>& unit, MeshFile& mesh) {
    mesh.file = section.file(file_key);
    mesh.unit = section.choice(unit);
    mesh.centre = section.boolean(centre_key);
}

} // namespace vkfv::specimen
