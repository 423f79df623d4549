#include "trace/scene_waves.hpp"

namespace vkfv::trace {

SceneWaves::SceneWaves(const DeviceScene& scene) : scene_(scene) {
    if (!scene.software()) {
        on_device_.emplace(*scene.device, scene.filter.value(), scene.instrument.detector_pixels(),
                           scene.cell_light.value());
    }
}

void SceneWaves::hand_over(ExposureWork& work, const vulkan::Buffer& for_host, std::size_t to_byte) const {
    if (on_device_) {
        vulkan::Commands& commands = work.open();
        on_device_->record(commands, for_host, to_byte);
        work.submit();
    }
}

Grid<double> SceneWaves::light(const vulkan::Buffer& for_host, std::size_t from_byte) const {
    if (on_device_) {
        return on_device_->image(for_host, from_byte);
    }
    const WaveImage image(scene_.filter.value(), scene_.instrument.detector_pixels());
    return image.apply(scene_.cell_light.value().read_values<std::uint64_t>(image.numbers()));
}

} // namespace vkfv::trace
