// What the URIs of a glTF's buffers stand for.
#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <string_view>

namespace vkfv::specimen::gltf {

bool is_data_uri(std::string_view uri);

// The bytes within a data URI; nothing if it is not in base64, or cut off.
std::optional<std::string> decoded_data_uri(std::string_view uri);

// A path from the folder of the file that names it; nothing for an absolute one, and for a URI with a scheme, as in
// "https://host/buffer.bin".
std::optional<std::filesystem::path> relative_path_of(std::string_view uri);

} // namespace vkfv::specimen::gltf
