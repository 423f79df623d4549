#include "surface_files/ply.hpp"

#include "core/messages/error.hpp"
#include "core/parsing/byte_reader.hpp"

#include <array>
#include <sstream>

namespace vkfv::surface {

std::string ply_bytes(const HeightMap& map, const Provenance& provenance) {
    if (map.height.values.size() > static_cast<std::size_t>(std::numeric_limits<std::int32_t>::max()))
        throw RunError("the surface has too many points for PLY. Choose another format.");
    Grid<std::int32_t> vertex(map.columns(), map.rows(), -1);
    std::string vertices, faces;
    std::int32_t vertex_count = 0;
    for (int row = 0; row < map.rows(); ++row)
        for (int column = 0; column < map.columns(); ++column)
            if (const double height = map.height(column, row); std::isfinite(height)) {
                vertex(column, row) = vertex_count++;
                for (const double coordinate : {map.x(column), map.y(row), height})
                    append(vertices, static_cast<float>(coordinate));
            }
    std::size_t face_count = 0;
    for (int row = 0; row + 1 < map.rows(); ++row)
        for (int column = 0; column + 1 < map.columns(); ++column) {
            const std::int32_t from = vertex(column, row), to = vertex(column + 1, row + 1);
            for (const auto& corners :
                 {std::array{from, vertex(column + 1, row), to}, std::array{from, to, vertex(column, row + 1)}})
                if (corners[0] >= 0 && corners[1] >= 0 && corners[2] >= 0) {
                    append(faces, static_cast<std::uint8_t>(corners.size()));
                    append(faces, corners);
                    ++face_count;
                }
        }
    std::string text = "ply\nformat binary_little_endian 1.0\ncomment lengths in mm, z towards the objective\n";
    std::istringstream lines(provenance_text(provenance));
    for (std::string line; std::getline(lines, line);)
        text += fmt::format("comment {}\n", line);
    text += fmt::format("element vertex {}\nproperty float x\nproperty float y\nproperty float z\n"
                        "element face {}\nproperty list uchar int vertex_indices\nend_header\n",
                        vertex_count, face_count);
    return text + vertices + faces;
}

} // namespace vkfv::surface
