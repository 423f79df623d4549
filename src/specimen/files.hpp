// Readers of specimen files. Each throws InputError that names the file and the byte offset or line of the
// damage.
#pragma once

#include "core/mathematics/grid.hpp"
#include "core/messages/error.hpp"

#include <glm/glm.hpp>

#include <array>
#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace vkfv::specimen {

// Triangles as a file has them, in its own unit and frame. Every index is valid and every coordinate finite;
// equal vertices of an STL are one.
struct FileMesh {
    std::vector<glm::dvec3> vertices;
    std::vector<glm::uvec3> triangles;
};

// All bytes of a regular file. `mention` is where the configuration names it: the place of the message where there is
// none; `key` the one by which it does.
std::string specimen_bytes(const std::filesystem::path& file, const SourceLocation& mention,
                           const std::string& key = "specimen.file");

// Binary where the size fits the count of triangles (84 + 50 n bytes), else ASCII, also with a byte-order mark and with
// any ends of lines.
FileMesh read_stl(const std::filesystem::path& file, const SourceLocation& mention);

// The default scene of a .gltf or .glb of version 2.0 with its nodes' transforms, instances (EXT_mesh_gpu_instancing)
// and morph targets at their weights. Coordinates are taken as they are: what a viewer shows from the front, x to the
// right and y up, is what the objective sees, with z towards it. What would change the triangles and is not known here
// (skins, compression, required extensions, later versions) is refused; what would not (animations, materials) is left
// out.
FileMesh read_gltf(const std::filesystem::path& file, const SourceLocation& mention);

// Points of a surface as a text file has them (csv, txt, xyz), a line each: x, y and z, in its own unit and frame; what
// further columns hold is left out. Lines with a gap in the first three (NaN, BAD, empty) are not measured.
struct FilePoints {
    std::vector<glm::dvec3> points;               // finite, at least one
    std::size_t not_measured = 0;                 // lines
    std::array<std::optional<double>, 3> units{}; // of x, y and z, mm; as the names of the columns say
    std::string column_names{};                   // that line; empty: there is none with units
};
FilePoints read_points(const std::filesystem::path& file, const SourceLocation& mention);

// Grey values, integers scaled to 0..1 and floats as they are. The file's top row is the grid's last (highest
// y). Of a file that is cut off nothing is taken.
Grid<float> read_image(const std::filesystem::path& file, const SourceLocation& mention);

// The same of a file's bytes; `file` names it in messages, and a glTF's other buffers lie beside it.
FileMesh parse_stl(std::string_view bytes, const std::filesystem::path& file);
FileMesh parse_gltf(std::string bytes, const std::filesystem::path& file);
FilePoints parse_points(std::string_view bytes, const std::filesystem::path& file);
Grid<float> parse_image(std::string_view bytes, const std::filesystem::path& file);

// More points than this are a mistake in the file or the configuration (1 GiB of heights).
inline constexpr std::uint64_t largest_point_count = std::uint64_t{1} << 28;

} // namespace vkfv::specimen
