// Readers of specimen files. Each throws an InputError that names the file and the byte offset or line of the damage.
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

// The triangles of a file, in its own unit and frame. Every index is valid and every coordinate finite; equal vertices
// of an STL are merged.
struct FileMesh {
    std::vector<glm::dvec3> vertices;
    std::vector<glm::uvec3> triangles;
};

// The bytes of a regular file. `mention` is the place in the configuration that names it, and serves messages about a
// missing file; `key` is the key there.
std::string specimen_bytes(const std::filesystem::path& file, const SourceLocation& mention,
                           const std::string& key = "specimen.file");

// Reads an STL as binary if its size fits the count of triangles (84 + 50 n bytes), else as ASCII, with any line ends
// and with or without a byte-order mark.
FileMesh read_stl(const std::filesystem::path& file, const SourceLocation& mention);

// Reads the default scene of a .gltf or .glb of version 2.0 with its nodes' transforms, instances
// (EXT_mesh_gpu_instancing) and morph targets at their weights. Coordinates are unchanged: the side that a viewer shows
// from the front, x to the right and y up, faces the objective, with z towards it. Unsupported content that would
// change the triangles (skins, compression, required extensions, later versions) is refused; content that would not
// (animations, materials) is ignored.
FileMesh read_gltf(const std::filesystem::path& file, const SourceLocation& mention);

// The points of a surface in a text file (csv, txt, xyz), one per line: x, y and z, in the file's unit and frame.
// Further columns are ignored. Lines with a gap in the first three (NaN, BAD, empty) count as not measured.
struct FilePoints {
    std::vector<glm::dvec3> points;               // finite, at least one
    std::size_t not_measured = 0;                 // number of such lines
    std::array<std::optional<double>, 3> units{}; // units of x, y and z in mm, if the column names state them
    std::string column_names{};                   // line of the column names; empty if it states no units
};
FilePoints read_points(const std::filesystem::path& file, const SourceLocation& mention);

// Reads grey values: integers are scaled to 0..1, floats are unchanged. The file's top row becomes the grid's last
// (highest y). A truncated file is refused.
Grid<float> read_image(const std::filesystem::path& file, const SourceLocation& mention);

// Parse the bytes of a file as the readers above do; `file` names it in messages, and a glTF's other buffers are
// searched beside it.
FileMesh parse_stl(std::string_view bytes, const std::filesystem::path& file);
FileMesh parse_gltf(std::string bytes, const std::filesystem::path& file);
FilePoints parse_points(std::string_view bytes, const std::filesystem::path& file);
Grid<float> parse_image(std::string_view bytes, const std::filesystem::path& file);

// A larger number of points is taken for a mistake in the file or the configuration (1 GiB of heights).
inline constexpr std::uint64_t largest_point_count = std::uint64_t{1} << 28;

} // namespace vkfv::specimen
