#include "trace/device_scene.hpp"

#include <bit>
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

TracerIdentity DeviceScene::identity() const {
    return device_identity(device.report(), traversal_name(traversal), instrument);
}

bool DeviceScene::is_specialised() const {
    // A processor compiles such kernels in 2 to 3 s at every start and then saves about 0.4 us a ray; a GPU compiles
    // them in 1.4 s once, as they are kept (vulkan/pipeline_cache.hpp), and saves 25 ps a ray.
    constexpr std::uint64_t rays_that_pay = 20000000;
    const bool pays = !software() || rays >= rays_that_pay;
    return instrument.surfaces.size() <= std::size_t{physics::f32::KNOWN_SURFACES} &&
           instrument_in_constants.value_or(pays);
}

std::vector<vulkan::SpecializationConstant> DeviceScene::specialised_constants(std::uint32_t stop_after, int first,
                                                                               int count) const {
    auto all = kernel_constants(stop_after);
    const auto add = [&](std::uint32_t id, auto value) { all.push_back({id, std::bit_cast<std::uint32_t>(value)}); };
    add(88, first);
    add(89, count);
    add(90, constants.instrument.illumination_first);
    add(91, constants.instrument.illumination_count);
    add(92, constants.instrument.imaging_first);
    add(93, constants.instrument.imaging_count);
    add(94, constants.specimen.max_bounces);
    const auto& lobe = constants.specimen.material.lobe_0;
    add(95, lobe.parameter_0);
    add(96, lobe.parameter_1);
    add(97, lobe.parameter_2);
    add(98, lobe.parameter_3);
    std::uint32_t id = 100;
    const auto block = surface_block(instrument);
    for (int k = 0; k < count; ++k) {
        const auto& surface = block[static_cast<std::size_t>(first + k)];
        add(id, surface.curvature);
        add(id + 1, surface.conic);
        add(id + 2, surface.semi_diameter_squared);
        add(id + 3, surface.distance);
        add(id + 4, surface.index_after);
        add(id + 5, surface.a4);
        add(id + 6, surface.a6);
        add(id + 7, surface.a8);
        add(id + 8, surface.a10);
        add(id + 9, surface.a12);
        add(id + 10, surface.a14);
        add(id + 11, surface.a16);
        add(id + 12, surface.flags);
        add(id + 13, surface.bend_residual);
        id += 16;
    }
    return all;
}

} // namespace vkfv::trace
