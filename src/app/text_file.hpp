// Text files that are whole or not there.
#pragma once

#include <filesystem>
#include <string>

namespace vkfv::app {

// Written under another name and renamed; makes the folder. RunError where the disk fails.
void write_text_aside(const std::filesystem::path& path, const std::string& text);

} // namespace vkfv::app
