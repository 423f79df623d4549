// place: 17
#pragma once

#include "specimen/specimen.hpp"

#include <filesystem>
#include <vector>

namespace vkfv {
class Key;
class Section;
} // namespace vkfv

namespace vkfv::specimen {

// Heights from the grey values of an image.
struct Image {
    std::filesystem::path file{};
    double pitch = 0;  // mm, pitch of the pixels
    double height = 0; // mm, height of the value 1 above the value 0

    static constexpr const char* name = "image";
    static constexpr const char* meaning = "Heights as the grey values of an image.";
    static std::vector<const Key*> keys();
    static Image read(const Section& section);
    HeightField heights(const SourceLocation& mention) const;
    bool operator==(const Image&) const = default;
};

} // namespace vkfv::specimen
