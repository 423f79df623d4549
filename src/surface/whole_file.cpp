#include "surface/whole_file.hpp"

#include "core/error.hpp"

#include <fstream>

namespace vkfv::surface {

std::string whole_file(const std::filesystem::path& path) {
    std::error_code error;
    std::ifstream stream;
    if (std::filesystem::is_regular_file(path, error))
        stream.open(path, std::ios::binary);
    if (!stream.is_open())
        throw InputError({.where = {.file = path, .line = 0, .column = 0, .byte_offset = {}},
                          .key = "",
                          .found = "no file that can be read",
                          .expected = "a surface or image file",
                          .remedy = "Check the path; it is relative to the file that names it."});
    std::string bytes(std::filesystem::file_size(path), '\0');
    stream.read(bytes.data(), static_cast<std::streamsize>(bytes.size()));
    bytes.resize(static_cast<std::size_t>(stream.gcount()));
    return bytes;
}

} // namespace vkfv::surface
