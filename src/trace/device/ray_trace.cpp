#include "trace/device/ray_trace.hpp"

#include "trace/interface/device_records.hpp"
#include "vulkan/kernel.hpp"

#include "spirv/trace_rays.h"

#include <cmath>
#include <limits>

namespace vkfv::trace {

namespace {

// The ends of a train: its surfaces, the index in front of it, and the plane behind it, mm from the last vertex.
struct TrainEnds {
    int first_surface;
    int surfaces;
    double index;
    double plane;
};

TrainEnds ends_of(const optics::Instrument& instrument, Train train) {
    const auto& constants = instrument.constants;
    if (train == Train::imaging) {
        return {constants.imaging_first, constants.imaging_count, constants.specimen_index,
                constants.detector_distance};
    }
    return {constants.illumination_first, constants.illumination_count, 1.0, instrument.front_vertex_height};
}

std::string status_name(std::uint32_t status) {
    using namespace physics::f64;
    switch (status) {
    case PATH_ALIVE:
        return "ok";
    case PATH_VIGNETTED:
        return "vignetted";
    case PATH_TOTAL_REFLECTION:
        return "tir";
    default:
        return "missed";
    }
}

TracedRay traced(glm::dvec3 position, glm::dvec3 direction, double path_length, std::uint32_t status, int surface) {
    TracedRay result;
    result.surface = surface;
    result.status = status_name(status);
    if (status != physics::f64::PATH_ALIVE) {
        const double nan = std::numeric_limits<double>::quiet_NaN();
        result.x = result.y = result.l = result.m = result.n = result.path_length = nan;
        return result;
    }
    result.x = position.x;
    result.y = position.y;
    result.l = direction.x;
    result.m = direction.y;
    result.n = direction.z;
    result.path_length = path_length;
    return result;
}

// The given rays in the frame of the first vertex, directions scaled by the index.
std::vector<physics::f64::Ray> entering(const optics::Instrument& instrument, std::span<const RayInput> inputs) {
    std::vector<physics::f64::Ray> rays;
    rays.reserve(inputs.size());
    for (const RayInput& input : inputs) {
        physics::f64::Ray ray{};
        ray.position = {input.x, input.y, input.z - instrument.first_order.working_distance};
        ray.direction = glm::normalize(glm::dvec3(input.l, input.m, input.n)) * instrument.constants.specimen_index;
        rays.push_back(ray);
    }
    return rays;
}

} // namespace

std::vector<TracedRay> trace_rays_on_host(const optics::Instrument& instrument, std::span<const RayInput> rays,
                                          bool apertures) {
    return trace_train_on_host(instrument, Train::imaging, entering(instrument, rays), apertures);
}

std::vector<TracedRay> trace_rays_on_device(const optics::Instrument& instrument, std::span<const RayInput> rays,
                                            bool apertures, const std::string& device) {
    return trace_train_on_device(instrument, Train::imaging, entering(instrument, rays), apertures, device);
}

std::vector<TracedRay> trace_train_on_host(const optics::Instrument& instrument, Train train,
                                           std::span<const physics::f64::Ray> rays, bool apertures) {
    using namespace physics::f64;
    const Light light = light_of_spectral(instrument.constants, 0.0);
    const TrainEnds ends = ends_of(instrument, train);
    std::vector<TracedRay> result;
    result.reserve(rays.size());
    for (const Ray& ray : rays) {
        const TrainResult passed =
            trace_train(instrument.scene(), ends.first_surface, ends.surfaces, ray, ends.index, apertures, light);
        const Ray arrived = fly_to_plane(passed.ray, ends.plane, passed.index);
        result.push_back(
            traced(arrived.position, arrived.direction, arrived.path_length, passed.status, passed.surface));
    }
    return result;
}

std::vector<TracedRay> trace_train_on_device(const optics::Instrument& instrument, Train train,
                                             std::span<const physics::f64::Ray> rays, bool apertures,
                                             const std::string& device_selector, std::uint32_t form) {
    if (rays.empty()) {
        return {};
    }
    const vulkan::Device device(vulkan::DeviceOptions{device_selector});
    const auto surfaces = surface_block(instrument);
    std::vector<physics::f32::Ray> entering_rays;
    entering_rays.reserve(rays.size());
    for (const auto& ray : rays) {
        entering_rays.push_back({glm::vec3(ray.position), glm::vec3(ray.direction), 0.0f});
    }
    kernels::Parameters parameters{};
    parameters.instrument = to_float(instrument.constants);

    vulkan::Buffer surface_buffer(device, surfaces.size() * sizeof(surfaces[0]));
    vulkan::Buffer parameter_buffer(device, sizeof(kernels::Parameters), vulkan::Buffer::Memory::host);
    const vulkan::Buffer spectrum_buffer(device, spectrum_block(instrument).size() * sizeof(physics::f32::SpectralBin));
    vulkan::Buffer ray_buffer(device, entering_rays.size() * sizeof(entering_rays[0]));
    vulkan::Buffer traced_buffer(device, rays.size() * sizeof(kernels::TracedRay));
    surface_buffer.write_values(std::span<const physics::f32::Surface>(surfaces));
    parameter_buffer.write_values(std::span<const kernels::Parameters>(&parameters, 1));
    ray_buffer.write_values(std::span<const physics::f32::Ray>(entering_rays));

    using enum vulkan::BindingKind;
    // Given rays are monochromatic and lose no light, so these features alone are compiled in.
    const std::array<vulkan::SpecializationConstant, 1> constants = {
        {{kernels::CONSTANT_FEATURES,
          instrument.features & (physics::f32::FEATURE_PLACEMENT | physics::f32::FEATURE_IDEAL_LENS)}}};
    const vulkan::Kernel kernel(device, "trace_rays", ::trace_rays,
                                {{kernels::BINDING_SURFACES, uniform_buffer},
                                 {kernels::BINDING_PARAMETERS, uniform_buffer},
                                 {kernels::BINDING_SPECTRUM, uniform_buffer},
                                 {kernels::BINDING_GIVEN, storage_buffer},
                                 {kernels::BINDING_FOUND, storage_buffer}},
                                sizeof(kernels::TrainPassage), constants);
    const std::array<vulkan::Binding, 5> bindings = {{{kernels::BINDING_SURFACES, &surface_buffer},
                                                      {kernels::BINDING_PARAMETERS, &parameter_buffer},
                                                      {kernels::BINDING_SPECTRUM, &spectrum_buffer},
                                                      {kernels::BINDING_GIVEN, &ray_buffer},
                                                      {kernels::BINDING_FOUND, &traced_buffer}}};
    const TrainEnds ends = ends_of(instrument, train);
    const kernels::TrainPassage push{.count = static_cast<std::uint32_t>(rays.size()),
                                     .apertures = apertures ? 1u : 0u,
                                     .form = form,
                                     .first_surface = ends.first_surface,
                                     .surfaces = ends.surfaces,
                                     .index = static_cast<float>(ends.index),
                                     .plane = static_cast<float>(ends.plane)};
    vulkan::Commands commands(device);
    commands.dispatch(kernel, bindings, push, (push.count + 63) / 64);
    commands.barrier();
    commands.submit_and_wait();

    std::vector<TracedRay> result;
    result.reserve(rays.size());
    for (const auto& ray : traced_buffer.read_values<kernels::TracedRay>(rays.size())) {
        result.push_back(traced(ray.position, ray.direction, ray.path_length, ray.status, ray.surface));
    }
    return result;
}

} // namespace vkfv::trace
