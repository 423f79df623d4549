// Sizes (px) and colours of the instrument's picture.
#pragma once

#include "report/room_rays.hpp"

#include <array>
#include <string>

namespace vkfv::report {

constexpr double label_size = 13;
constexpr double label_spacing = 17;
constexpr double label_room = 37; // above a part that is labelled from above

// Colours are those of Okabe and Ito, which colour-blind people can distinguish.
constexpr const char* ink = "#222222";
constexpr const char* grey = "#8a8a8a";
struct BundleStyle {
    RoomRay::Bundle bundle;
    const char* colour;
    const char* meaning;
};
constexpr std::array<BundleStyle, 5> bundle_styles = {{
    {RoomRay::Bundle::illumination_rim, "#009e73", "illumination, rim of the source"},
    {RoomRay::Bundle::illumination_centre, "#e69f00", "illumination, middle of the source"},
    {RoomRay::Bundle::ring_light, "#cc79a7", "illumination, ring light"},
    {RoomRay::Bundle::imaging_edge, "#d55e00", "imaging, edge of the field"},
    {RoomRay::Bundle::imaging_axis, "#0072b2", "imaging, middle of the field"},
}};

// The width of a text by Helvetica's mean advance; wide enough to keep labels apart.
inline double width_of(const std::string& text, double size = label_size) {
    return 0.56 * size * static_cast<double>(text.size());
}

} // namespace vkfv::report
