// place: 18
#pragma once

#include "specimen/specimen.hpp"

#include <filesystem>
#include <vector>

namespace vkfv {
class Key;
class Section;
} // namespace vkfv

namespace vkfv::specimen {

// A surface from any file that surface::read_surface() supports, cropped around its centre, which is moved to x = y =
// 0, and levelled. Points that were not measured cannot be traced: they are interpolated, and the log says how many.
struct SurfaceFile {
    std::filesystem::path file{};
    double pitch = 0;  // mm, pitch of an image's pixels; 0: the file's own
    double size = 0;   // mm, side of the part to take; 0: all of it
    bool level = true; // remove the least-squares plane, mean height to z = 0
    double unit = 0;   // mm per unit of an image's values; 0: the file's own

    static constexpr const char* name = "surface";
    static constexpr const char* meaning = "A measured surface, from a file of an instrument or of vkfv.";
    static std::vector<const Key*> keys();
    static SurfaceFile read(const Section& section);
    HeightField heights(const SourceLocation& mention) const;
    bool operator==(const SurfaceFile&) const = default;
};

} // namespace vkfv::specimen
