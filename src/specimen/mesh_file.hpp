// What the kinds of specimens share that are a mesh of a file.
#pragma once

#include "specimen/files.hpp"
#include "specimen/specimen.hpp"

#include <filesystem>
#include <vector>

namespace vkfv {
class Key;
class Section;
template <class Value>
class ChoiceKey;
} // namespace vkfv

namespace vkfv::specimen {

struct MeshFile {
    std::filesystem::path file{};
    double unit = 1;    // mm per unit of the file
    bool centre = true; // move the bounding box's centre to x = y = 0, mean height to z = 0

    bool operator==(const MeshFile&) const = default;
};

// In mm and in float, centred if the description asks for it; triangles without area are dropped, and the log says how
// many. Throws InputError where a vertex lies too far off for the others to be told apart. mention: where the
// configuration names the file.
Mesh placed_mesh(FileMesh source, const MeshFile& description, const SourceLocation& mention);

std::vector<const Key*> mesh_file_keys(const ChoiceKey<double>& unit);
void read_mesh_file(const Section& section, const ChoiceKey<double>& unit, MeshFile& mesh);

} // namespace vkfv::specimen
