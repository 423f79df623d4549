// What the kinds of specimens share that are a mesh of a file.
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

// In mm and in float, centred if the description asks for it; triangles without area are dropped, and the log says how
// many. Throws InputError where a vertex lies too far off for the others to be told apart. mention: where the
// configuration names the file.
Mesh placed_mesh(FileMesh source, const MeshFile& description, const SourceLocation& mention);

// file: the key that names it; unit: of its lengths.
std::vector<const Key*> mesh_file_keys(const FileKey& file, const ChoiceKey<double>& unit);
void read_mesh_file(const Section& section, const FileKey& file, const ChoiceKey<double>& unit, MeshFile& mesh);
extern const FileKey mesh_key; // `file` of the kinds whose file is a mesh

} // namespace vkfv::specimen
