#include "trace/scene_waves.hpp"

#include "trace/wave_image.hpp"
#include "trace/wave_memory.hpp"

#include <cstdint>
#include <utility>

namespace vkfv::trace {

SceneWaves::SceneWaves(const vulkan::Device& device, optics::PupilFilter filter, ImageSize pixels)
    : filter_(std::move(filter)), pixels_(pixels),
      light_(device, WaveImage(filter_, pixels).numbers() * sizeof(std::uint64_t), vulkan::Buffer::Memory::device,
             wave_memory_remedy) {
    if (!vulkan::is_software(device.report())) {
        on_device_.emplace(device, filter_, pixels, light_);
    }
    noise_ = std::async(std::launch::async, [its_filter = filter_] { return its_filter.noise(); });
}

void SceneWaves::clear(vulkan::Commands& commands) const {
    commands.fill_zero(light_);
    commands.barrier();
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
    const WaveImage image(filter_, pixels_);
    return image.apply(light_.read_values<std::uint64_t>(image.numbers()));
}

} // namespace vkfv::trace
