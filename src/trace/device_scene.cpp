#include "trace/device_scene.hpp"

#include <cmath>
#include <limits>

namespace vkfv::trace {

std::vector<vulkan::Box> boxes_of(const optics::Room& room) {
    constexpr float infinity = std::numeric_limits<float>::infinity();
    std::vector<vulkan::Box> boxes;
    boxes.reserve(room.elements.size());
    for (std::size_t element = 0; element < room.elements.size(); ++element) {
        const auto bounds = room.bounds(element);
        vulkan::Box box{glm::vec3(bounds.lower), glm::vec3(bounds.upper)};
        for (int axis = 0; axis < 3; ++axis) {
            box.minimum[axis] = std::nextafter(box.minimum[axis], -infinity);
            box.maximum[axis] = std::nextafter(box.maximum[axis], infinity);
        }
        boxes.push_back(box);
    }
    return boxes;
}

} // namespace vkfv::trace
