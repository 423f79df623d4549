#include "app/text_file.hpp"

#include "core/error.hpp"

#include <fmt/format.h>

#include <fstream>
#include <system_error>

namespace vkfv::app {

void write_text_aside(const std::filesystem::path& path, const std::string& text) {
    if (path.has_parent_path()) {
        std::filesystem::create_directories(path.parent_path());
    }
    const auto aside = path.parent_path() / ("." + path.filename().string() + ".part");
    std::ofstream stream(aside, std::ios::binary);
    stream << text << std::flush;
    std::error_code code;
    if (stream) {
        stream.close();
        std::filesystem::rename(aside, path, code);
    }
    if (!stream || code) {
        throw RunError(
            fmt::format("{}: cannot be written. Free space on the disk, check its permissions, and run the "
                        "same command again.",
                        path.string()));
    }
}

} // namespace vkfv::app
