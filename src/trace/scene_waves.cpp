#include "trace/scene_waves.hpp"

namespace vkfv::trace {

SceneWaves::SceneWaves(const DeviceScene& scene) : scene_(scene) {
    if (!scene.software()) {
        on_device_.emplace(*scene.device, scene.filter.value(), scene.instrument.constants.detector_pixels,
                           scene.cell_light.value());
    }
}

SceneWaves::Light SceneWaves::light() const {
    if (on_device_) {
        vulkan::Commands commands(*scene_.device, 2);
        commands.timestamp();
        on_device_->record(commands);
        commands.timestamp();
        commands.submit_and_wait();
        return {.pixels = on_device_->image(), .device_seconds = commands.seconds()[1]};
    }
    const WaveImage image(scene_.filter.value(), scene_.instrument.constants.detector_pixels);
    return {.pixels = image.apply(scene_.cell_light.value().read_values<std::uint64_t>(image.numbers()))};
}

} // namespace vkfv::trace
