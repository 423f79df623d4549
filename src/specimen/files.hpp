// Readers of specimen files. Each throws InputError that names the file and the byte offset or line of the
// damage.
#pragma once

#include "core/error.hpp"
#include "core/grid.hpp"

#include <glm/glm.hpp>

#include <cstdint>
#include <filesystem>
#include <string>
#include <vector>

namespace vkfv::specimen {

// Triangles as a file has them, in its own unit and frame. Every index is valid and every coordinate finite;
// equal vertices of an STL are one.
struct FileMesh {
    std::vector<glm::dvec3> vertices;
    std::vector<glm::uvec3> triangles;
};

// The whole file. `mention` is where the configuration names it.
std::string read_file(const std::filesystem::path& file, const SourceLocation& mention);

// Binary where the size fits the count of triangles (84 + 50 n bytes), else ASCII.
FileMesh read_stl(const std::filesystem::path& file, const SourceLocation& mention);

// The default scene of a .gltf or .glb with its nodes' transforms. Coordinates are taken as they are: what a
// viewer shows from the front, x to the right and y up, is what the objective sees, with z towards it.
FileMesh read_gltf(const std::filesystem::path& file, const SourceLocation& mention);

// Grey values, integers scaled to 0..1 and floats as they are. The file's top row is the grid's last (highest
// y).
Grid<float> read_image(const std::filesystem::path& file, const SourceLocation& mention);

struct HeightField;
struct Description;

// The surface in any file that surface::read_surface() knows, cropped around its centre, which comes to x = y = 0, and
// levelled. Not-measured points cannot be traced: they are interpolated, and the log says how many.
HeightField read_surface_field(const Description& description);

// More points than this are a mistake in the file or the configuration (1 GiB of heights).
inline constexpr std::uint64_t largest_point_count = std::uint64_t{1} << 28;

} // namespace vkfv::specimen
