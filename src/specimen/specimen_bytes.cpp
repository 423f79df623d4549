#include "specimen/files.hpp"

#include "core/files/file.hpp"

#include <fmt/format.h>

namespace vkfv::specimen {

std::string specimen_bytes(const std::filesystem::path& file, const SourceLocation& mention, const std::string& key) {
    try {
        return read_file(file, {.key = key, .expected = "a file that can be read"});
    } catch (const InputError& error) {
        InputProblem problem = error.problem();
        // A problem with a byte offset, such as a file truncated while it was read, keeps its own place.
        if (!problem.where.byte_offset && !mention.file.empty()) {
            problem.where = mention;
            problem.found = fmt::format("{} ({})", file.string(), problem.found);
        }
        throw InputError(problem);
    }
}

} // namespace vkfv::specimen
