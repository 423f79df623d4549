#include "images/image_file.hpp"
#include "specimen/files.hpp"

namespace vkfv::specimen {

Grid<float> parse_image(std::string_view bytes, const std::filesystem::path& file) {
    return images::parse_grey(bytes, largest_point_count, file);
}

Grid<float> read_image(const std::filesystem::path& file, const SourceLocation& mention) {
    return parse_image(specimen_bytes(file, mention), file);
}

} // namespace vkfv::specimen
