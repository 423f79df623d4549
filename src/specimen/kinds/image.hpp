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

// Heights as grey values.
struct Image {
    std::filesystem::path file{};
    double pitch = 0;  // of the pixels, mm
    double height = 0; // of the value 1 over the value 0, mm

    static constexpr const char* name = "image";
    static constexpr const char* meaning = "Heights as the grey values of an image.";
    static std::vector<const Key*> keys();
    static Image read(const Section& section);
    HeightField heights(const SourceLocation& mention) const;
    bool operator==(const Image&) const = default;
};

} // namespace vkfv::specimen
