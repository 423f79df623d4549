// Parts shared by the kinds of specimens that are a mesh from a file.
#pragma once

#include "specimen/files.hpp"
#include "specimen/specimen.hpp"

#include <filesystem>
#include <vector>

namespace vkfv {
class FileKey;
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

// The mesh in mm and in float, centred if the description asks for it. Triangles without area are dropped, and the log
// says how many. Throws InputError if a vertex lies so far off that the others cannot be distinguished. mention: place
// in the configuration that names the file.
Mesh placed_mesh(FileMesh source, const MeshFile& description, const SourceLocation& mention);

// The keys of a mesh file, and their values. file: the key of its name; unit: the key of its length unit.
std::vector<const Key*> mesh_file_keys(const FileKey& file, const ChoiceKey<double>& unit);
void read_mesh_file(const Section& section, const FileKey& file, const ChoiceKey<double>& unit, MeshFile& mesh);
extern const FileKey mesh_key; // `file` of kinds whose file is a mesh

} // namespace vkfv::specimen
